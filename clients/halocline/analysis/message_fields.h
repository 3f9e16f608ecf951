// The fields of every message type by name, in the order of the type: what a table of messages is made from.
//
// visit_fields(visitor, message) calls visitor(name, value) for each. A test compares the names with lcmtypes/.
#pragma once

#include "bus/messages.h"

namespace halocline::clients {

template <class Visitor>
void visit_fields(Visitor& v, const current_change_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("sequence", m.sequence);
  v("uniform_ned_mps", m.uniform_ned_mps);
  v("num_depths", m.num_depths);
  v("depth_m", m.depth_m);
  v("north_mps", m.north_mps);
  v("east_mps", m.east_mps);
  v("tide_amplitude_mps", m.tide_amplitude_mps);
  v("tide_period_s", m.tide_period_s);
  v("tide_phase_rad", m.tide_phase_rad);
  v("tide_toward_rad", m.tide_toward_rad);
  v("random_deviation_mps", m.random_deviation_mps);
  v("random_time_s", m.random_time_s);
}

template <class Visitor>
void visit_fields(Visitor& v, const environment_change_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("sequence", m.sequence);
  v("sets_wind", m.sets_wind);
  v("sets_shipping", m.sets_shipping);
  v("sets_sea_surface", m.sets_sea_surface);
  v("profile_set", m.profile_set);
  v("wind_speed_mps", m.wind_speed_mps);
  v("shipping_activity", m.shipping_activity);
  v("sea_surface_z_m", m.sea_surface_z_m);
  v("num_layers", m.num_layers);
  v("layer_depth_m", m.layer_depth_m);
  v("layer_sound_speed_mps", m.layer_sound_speed_mps);
  v("layer_temperature_degc", m.layer_temperature_degc);
  v("layer_salinity_psu", m.layer_salinity_psu);
}

template <class Visitor>
void visit_fields(Visitor& v, const environment_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("sequence", m.sequence);
  v("num_layers", m.num_layers);
  v("layer_depth_m", m.layer_depth_m);
  v("layer_sound_speed_mps", m.layer_sound_speed_mps);
  v("layer_temperature_degc", m.layer_temperature_degc);
  v("layer_salinity_psu", m.layer_salinity_psu);
  v("wind_speed_mps", m.wind_speed_mps);
  v("shipping_activity", m.shipping_activity);
  v("acidity_ph", m.acidity_ph);
  v("sea_surface_z_m", m.sea_surface_z_m);
  v("spreading_exponent", m.spreading_exponent);
  v("sound_speed_model", m.sound_speed_model);
  v("absorption_model", m.absorption_model);
  v("bottom_density_ratio", m.bottom_density_ratio);
  v("bottom_sound_speed_ratio", m.bottom_sound_speed_ratio);
  v("bottom_sound_speed_mps", m.bottom_sound_speed_mps);
  v("bottom_loss_parameter", m.bottom_loss_parameter);
  v("surface_model", m.surface_model);
  v("propagation_model", m.propagation_model);
  v("terrain_version", m.terrain_version);
}

template <class Visitor>
void visit_fields(Visitor& v, const link_answer_t& m) {
  v("answer_status", m.answer_status);
  v("problem", m.problem);
  v("link", m.link);
  v("getss_received_strength_db", m.getss_received_strength_db);
  v("getpd_propagation_delay_s", m.getpd_propagation_delay_s);
  v("getbw_capacity_kbps", m.getbw_capacity_kbps);
  v("getml_multipath", m.getml_multipath);
}

template <class Visitor>
void visit_fields(Visitor& v, const link_end_t& m) {
  v("vehicle_name", m.vehicle_name);
  v("position_ned_m", m.position_ned_m);
  v("modem_choice", m.modem_choice);
  v("modem", m.modem);
}

template <class Visitor>
void visit_fields(Visitor& v, const link_query_t& m) {
  v("utime", m.utime);
  v("client_name", m.client_name);
  v("request_id", m.request_id);
  v("num_links", m.num_links);
  v("transmitters", m.transmitters);
  v("receivers", m.receivers);
}

template <class Visitor>
void visit_fields(Visitor& v, const link_reply_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("request_id", m.request_id);
  v("reply_status", m.reply_status);
  v("refusal", m.refusal);
  v("num_answers", m.num_answers);
  v("answers", m.answers);
}

template <class Visitor>
void visit_fields(Visitor& v, const link_t& m) {
  v("transmitter_id", m.transmitter_id);
  v("receiver_id", m.receiver_id);
  v("range_m", m.range_m);
  v("delay_s", m.delay_s);
  v("transmission_loss_db", m.transmission_loss_db);
  v("received_level_db", m.received_level_db);
  v("noise_level_db", m.noise_level_db);
  v("snr_db", m.snr_db);
  v("capacity_bps", m.capacity_bps);
  v("receivable", m.receivable);
  v("multipath", m.multipath);
  v("transmitter_age_s", m.transmitter_age_s);
  v("receiver_age_s", m.receiver_age_s);
  v("path_state", m.path_state);
  v("propagation_used", m.propagation_used);
  v("num_paths", m.num_paths);
  v("delay_spread_s", m.delay_spread_s);
  v("doppler_factor", m.doppler_factor);
}

template <class Visitor>
void visit_fields(Visitor& v, const link_table_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("sequence", m.sequence);
  v("vehicle_id", m.vehicle_id);
  v("num_peers", m.num_peers);
  v("peers", m.peers);
}

template <class Visitor>
void visit_fields(Visitor& v, const modem_config_t& m) {
  v("utime", m.utime);
  v("source_level_db", m.source_level_db);
  v("center_frequency_hz", m.center_frequency_hz);
  v("bandwidth_hz", m.bandwidth_hz);
  v("directivity_index_db", m.directivity_index_db);
  v("cutoff_level_db", m.cutoff_level_db);
  v("bit_rate_bps", m.bit_rate_bps);
  v("packet_overhead_s", m.packet_overhead_s);
  v("max_payload_bytes", m.max_payload_bytes);
  v("modem_profile", m.modem_profile);
  v("psk_rate", m.psk_rate);
  v("preamble_s", m.preamble_s);
  v("guard_time_s", m.guard_time_s);
  v("doppler_tolerance", m.doppler_tolerance);
  v("error_model", m.error_model);
  v("when_busy", m.when_busy);
  v("num_beam_rows", m.num_beam_rows);
  v("beam_elevation_rad", m.beam_elevation_rad);
  v("beam_loss_db", m.beam_loss_db);
}

template <class Visitor>
void visit_fields(Visitor& v, const modem_receipt_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("sequence", m.sequence);
  v("send_session", m.send_session);
  v("packet_sequence", m.packet_sequence);
  v("receipt_result", m.receipt_result);
  v("start_utime", m.start_utime);
  v("duration_s", m.duration_s);
}

template <class Visitor>
void visit_fields(Visitor& v, const modem_receive_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("sequence", m.sequence);
  v("send_session", m.send_session);
  v("packet_sequence", m.packet_sequence);
  v("source_id", m.source_id);
  v("destination_id", m.destination_id);
  v("receiver_id", m.receiver_id);
  v("packet_kind", m.packet_kind);
  v("stamped", m.stamped);
  v("departure_utime", m.departure_utime);
  v("travel_time_s", m.travel_time_s);
  v("two_way_travel_time_s", m.two_way_travel_time_s);
  v("received_level_db", m.received_level_db);
  v("snr_db", m.snr_db);
  v("doppler_factor", m.doppler_factor);
  v("sinr_db", m.sinr_db);
  v("payload_size", m.payload_size);
  v("payload", m.payload);
}

template <class Visitor>
void visit_fields(Visitor& v, const modem_send_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("packet_sequence", m.packet_sequence);
  v("source_id", m.source_id);
  v("destination_id", m.destination_id);
  v("packet_kind", m.packet_kind);
  v("stamped", m.stamped);
  v("payload_size", m.payload_size);
  v("payload", m.payload);
}

template <class Visitor>
void visit_fields(Visitor& v, const node_status_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("sequence", m.sequence);
  v("node_name", m.node_name);
  v("node_version", m.node_version);
  v("messages_received", m.messages_received);
  v("messages_sent", m.messages_sent);
  v("messages_refused", m.messages_refused);
  v("gaps", m.gaps);
  v("repaired", m.repaired);
  v("lost", m.lost);
  v("duplicates", m.duplicates);
  v("late", m.late);
  v("status_text", m.status_text);
}

template <class Visitor>
void visit_fields(Visitor& v, const flow_heartbeat_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("sequence", m.sequence);
  v("age_us", m.age_us);
  v("num_flows", m.num_flows);
  v("flow_channel", m.flow_channel);
  v("flow_session", m.flow_session);
  v("flow_last_sequence", m.flow_last_sequence);
}

template <class Visitor>
void visit_fields(Visitor& v, const ping_answer_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("sequence", m.sequence);
  v("answering_vehicle", m.answering_vehicle);
  v("answering_id", m.answering_id);
  v("asking_id", m.asking_id);
  v("ping_session", m.ping_session);
  v("ping_sequence", m.ping_sequence);
  v("answer_start_ns", m.answer_start_ns);
  v("ping_departure_ns", m.ping_departure_ns);
  v("ping_duration_ns", m.ping_duration_ns);
}

template <class Visitor>
void visit_fields(Visitor& v, const repair_request_t& m) {
  v("utime", m.utime);
  v("client_name", m.client_name);
  v("missing_channel", m.missing_channel);
  v("publisher_session", m.publisher_session);
  v("num_missing", m.num_missing);
  v("missing_sequence", m.missing_sequence);
}

template <class Visitor>
void visit_fields(Visitor& v, const packet_name_t& m) {
  v("source_id", m.source_id);
  v("packet_kind", m.packet_kind);
  v("send_session", m.send_session);
  v("packet_sequence", m.packet_sequence);
}

template <class Visitor>
void visit_fields(Visitor& v, const packet_outcome_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("sequence", m.sequence);
  v("send_session", m.send_session);
  v("packet_sequence", m.packet_sequence);
  v("source_id", m.source_id);
  v("destination_id", m.destination_id);
  v("receiver_id", m.receiver_id);
  v("packet_kind", m.packet_kind);
  v("packet_fate", m.packet_fate);
  v("departure_utime", m.departure_utime);
  v("travel_time_s", m.travel_time_s);
  v("duration_s", m.duration_s);
  v("range_m", m.range_m);
  v("transmission_loss_db", m.transmission_loss_db);
  v("received_level_db", m.received_level_db);
  v("noise_level_db", m.noise_level_db);
  v("snr_db", m.snr_db);
  v("cutoff_level_db", m.cutoff_level_db);
  v("propagation_used", m.propagation_used);
  v("num_paths", m.num_paths);
  v("delay_spread_s", m.delay_spread_s);
  v("doppler_factor", m.doppler_factor);
  v("interference_level_db", m.interference_level_db);
  v("sinr_db", m.sinr_db);
  v("acquisition_probability", m.acquisition_probability);
  v("success_probability", m.success_probability);
  v("acquisition_draw", m.acquisition_draw);
  v("success_draw", m.success_draw);
  v("arrival_azimuth_rad", m.arrival_azimuth_rad);
  v("arrival_elevation_rad", m.arrival_elevation_rad);
  v("num_colliders", m.num_colliders);
  v("colliders", m.colliders);
}

template <class Visitor>
void visit_fields(Visitor& v, const position_estimate_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("sequence", m.sequence);
  v("vehicle_id", m.vehicle_id);
  v("estimate_status", m.estimate_status);
  v("position_ned_m", m.position_ned_m);
  v("covariance_ned_m2", m.covariance_ned_m2);
  v("current_ned_mps", m.current_ned_mps);
  v("likelihood", m.likelihood);
  v("ranges_used", m.ranges_used);
  v("ranges_refused", m.ranges_refused);
  v("truth_known", m.truth_known);
  v("error_ned_m", m.error_ned_m);
}

template <class Visitor>
void visit_fields(Visitor& v, const ray_query_t& m) {
  v("utime", m.utime);
  v("client_name", m.client_name);
  v("request_id", m.request_id);
  v("expected_terrain", m.expected_terrain);
  v("query_mode", m.query_mode);
  v("sample_spacing_m", m.sample_spacing_m);
  v("base_origin_ned_m", m.base_origin_ned_m);
  v("num_rays", m.num_rays);
  v("offset_m", m.offset_m);
  v("direction", m.direction);
  v("greatest_range_m", m.greatest_range_m);
}

template <class Visitor>
void visit_fields(Visitor& v, const ray_reply_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("request_id", m.request_id);
  v("terrain_version", m.terrain_version);
  v("reply_status", m.reply_status);
  v("refusal", m.refusal);
  v("num_rays", m.num_rays);
  v("ray_status", m.ray_status);
  v("result_m", m.result_m);
  v("num_samples", m.num_samples);
  v("sample_distance_m", m.sample_distance_m);
  v("sample_seabed_z_m", m.sample_seabed_z_m);
  v("sample_valid", m.sample_valid);
}

template <class Visitor>
void visit_fields(Visitor& v, const sim_clock_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("sequence", m.sequence);
  v("clock_rate", m.clock_rate);
  v("clock_step_us", m.clock_step_us);
  v("lockstep", m.lockstep);
}

template <class Visitor>
void visit_fields(Visitor& v, const vehicle_command_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("sequence", m.sequence);
  v("propeller_rpm", m.propeller_rpm);
  v("rudder_rad", m.rudder_rad);
  v("stern_plane_rad", m.stern_plane_rad);
  v("thruster_rpm", m.thruster_rpm);
}

template <class Visitor>
void visit_fields(Visitor& v, const vehicle_dvl_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("sequence", m.sequence);
  v("beam_status", m.beam_status);
  v("beam_range_m", m.beam_range_m);
  v("beam_speed_mps", m.beam_speed_mps);
  v("ground_velocity_valid", m.ground_velocity_valid);
  v("ground_velocity_body_mps", m.ground_velocity_body_mps);
  v("velocity_deviation_mps", m.velocity_deviation_mps);
}

template <class Visitor>
void visit_fields(Visitor& v, const vehicle_fault_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("sequence", m.sequence);
  v("fault_kind", m.fault_kind);
  v("fault_mended", m.fault_mended);
  v("stuck_angle_given", m.stuck_angle_given);
  v("stuck_angle_rad", m.stuck_angle_rad);
  v("leak_rate_kg_s", m.leak_rate_kg_s);
  v("leak_volume_m3", m.leak_volume_m3);
  v("dead_sensor", m.dead_sensor);
}

template <class Visitor>
void visit_fields(Visitor& v, const vehicle_gps_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("sequence", m.sequence);
  v("fix_north_m", m.fix_north_m);
  v("fix_east_m", m.fix_east_m);
  v("fix_deviation_m", m.fix_deviation_m);
}

template <class Visitor>
void visit_fields(Visitor& v, const vehicle_sensors_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("sequence", m.sequence);
  v("depth_fresh", m.depth_fresh);
  v("depth_m", m.depth_m);
  v("altitude_status", m.altitude_status);
  v("altitude_m", m.altitude_m);
  v("water_speed_fresh", m.water_speed_fresh);
  v("water_speed_mps", m.water_speed_mps);
  v("attitude_fresh", m.attitude_fresh);
  v("heading_rad", m.heading_rad);
  v("pitch_rad", m.pitch_rad);
  v("roll_rad", m.roll_rad);
  v("angular_rate_fresh", m.angular_rate_fresh);
  v("angular_rate_body_radps", m.angular_rate_body_radps);
  v("shaft_rpm", m.shaft_rpm);
  v("rudder_angle_rad", m.rudder_angle_rad);
  v("stern_angle_rad", m.stern_angle_rad);
  v("thruster_rpm", m.thruster_rpm);
  v("safe_state", m.safe_state);
  v("on_seabed", m.on_seabed);
}

template <class Visitor>
void visit_fields(Visitor& v, const vehicle_sonar_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("sequence", m.sequence);
  v("fan_tilt_rad", m.fan_tilt_rad);
  v("greatest_range_m", m.greatest_range_m);
  v("num_fan_rays", m.num_fan_rays);
  v("fan_azimuth_rad", m.fan_azimuth_rad);
  v("echo_status", m.echo_status);
  v("echo_range_m", m.echo_range_m);
}

template <class Visitor>
void visit_fields(Visitor& v, const vehicle_state_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("sequence", m.sequence);
  v("vehicle_id", m.vehicle_id);
  v("position_ned_m", m.position_ned_m);
  v("orientation_wxyz", m.orientation_wxyz);
  v("velocity_ned_mps", m.velocity_ned_mps);
  v("angular_velocity_body_radps", m.angular_velocity_body_radps);
}

template <class Visitor>
void visit_fields(Visitor& v, const vehicle_usbl_t& m) {
  v("utime", m.utime);
  v("session", m.session);
  v("sequence", m.sequence);
  v("peer_id", m.peer_id);
  v("packet_kind", m.packet_kind);
  v("send_session", m.send_session);
  v("packet_sequence", m.packet_sequence);
  v("peer_bearing_rad", m.peer_bearing_rad);
  v("peer_elevation_rad", m.peer_elevation_rad);
  v("angle_deviation_rad", m.angle_deviation_rad);
  v("travel_time_known", m.travel_time_known);
  v("one_way_travel_time_s", m.one_way_travel_time_s);
}

}  // namespace halocline::clients
