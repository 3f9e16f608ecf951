#include "bus/message_checks.h"

#include <array>

#include "bus/message_checker.h"
#include "core/names.h"

namespace halocline::bus {
namespace {

Checker check_modem(const modem_config_t& m) {
  Checker checker;
  checker.utime(m.utime)
      .within("source_level_db", m.source_level_db, 0, kHighestLevelDb)
      .within("center_frequency_hz", m.center_frequency_hz, 1, kHighestFrequencyHz)
      .within("bandwidth_hz", m.bandwidth_hz, 1e-3, kHighestFrequencyHz)
      .holds(m.bandwidth_hz < 2 * m.center_frequency_hz, "bandwidth_hz", "reaches below 0 Hz")
      .within("directivity_index_db", m.directivity_index_db, -100, 100)
      .within("cutoff_level_db", m.cutoff_level_db, -kHighestLevelDb, kHighestLevelDb)
      .within("bit_rate_bps", m.bit_rate_bps, 1e-3, 1e9)
      .within("packet_overhead_s", m.packet_overhead_s, 0, 3600)
      .within("max_payload_bytes", m.max_payload_bytes, 0, kLongestPayload)
      .one_of("modem_profile", m.modem_profile, modem_config_t::PROFILE_GENERIC,
              modem_config_t::PROFILE_MICROMODEM_PSK)
      .within("psk_rate", m.psk_rate, 0, 6)
      .within("preamble_s", m.preamble_s, 0, 3600)
      .within("guard_time_s", m.guard_time_s, 0, 3600)
      .within("doppler_tolerance", m.doppler_tolerance, 0, 1)
      .one_of("error_model", m.error_model, modem_config_t::ERRORS_NONE,
              modem_config_t::ERRORS_BPSK_HAMMING14)
      .one_of("when_busy", m.when_busy, modem_config_t::REFUSE, modem_config_t::QUEUE)
      .within("num_beam_rows", m.num_beam_rows, 0, kMaxBeamRows)
      .all_within("beam_elevation_rad", m.beam_elevation_rad, -kPi / 2, kPi / 2)
      .all_within("beam_loss_db", m.beam_loss_db, -60, 200);
  for (std::size_t i = 1; i < m.beam_elevation_rad.size(); ++i) {
    checker.holds(m.beam_elevation_rad[i] > m.beam_elevation_rad[i - 1], "beam_elevation_rad",
                  "does not rise");
  }
  return checker;
}

Checker check_link(const link_t& m) {
  return Checker()
      .id_or_all("transmitter_id", m.transmitter_id)
      .id_or_all("receiver_id", m.receiver_id)
      .within("range_m", m.range_m, 0, 4 * kFarthestM)
      .within("delay_s", m.delay_s, 0, 1e6)
      .finite("transmission_loss_db", m.transmission_loss_db)
      .finite("received_level_db", m.received_level_db)
      .finite("noise_level_db", m.noise_level_db)
      .finite("snr_db", m.snr_db)
      .within("capacity_bps", m.capacity_bps, 0, 1e12)
      .one_of("multipath", m.multipath, link_t::MULTIPATH_UNLIKELY, link_t::MULTIPATH_UNKNOWN)
      .finite("transmitter_age_s", m.transmitter_age_s)
      .finite("receiver_age_s", m.receiver_age_s)
      .one_of("path_state", m.path_state, link_t::PATH_OPEN, link_t::PATH_BLOCKED)
      .one_of("propagation_used", m.propagation_used, link_t::USED_STRAIGHT,
              link_t::USED_STRAIGHT_WITHOUT_BOTTOM)
      .within("num_paths", m.num_paths, 0, 1e6)
      .within("delay_spread_s", m.delay_spread_s, 0, 1e6)
      .within("doppler_factor", m.doppler_factor, 0, 10);
}

}  // namespace

std::string problem_in(const sim_clock_t& m) {
  return Checker()
      .utime(m.utime)
      .within("clock_rate", m.clock_rate, 0, 1e6)
      .within("clock_step_us", static_cast<double>(m.clock_step_us), 1, 3.6e9)
      .result();
}

std::string problem_in(const environment_t& m) {
  Checker checker;
  checker.utime(m.utime)
      .within("num_layers", m.num_layers, 1, kMaxLayers)
      .all_within("layer_depth_m", m.layer_depth_m, 0, 12000)
      .all_within("layer_sound_speed_mps", m.layer_sound_speed_mps, 1000, 2500)
      .all_within("layer_temperature_degc", m.layer_temperature_degc, -10, 60)
      .all_within("layer_salinity_psu", m.layer_salinity_psu, 0, 400)
      .within("wind_speed_mps", m.wind_speed_mps, 0, 100)
      .within("shipping_activity", m.shipping_activity, 0, 1)
      .within("acidity_ph", m.acidity_ph, 0, 14)
      .within("sea_surface_z_m", m.sea_surface_z_m, -1000, 1000)
      .within("spreading_exponent", m.spreading_exponent, 0, 3)
      .within("bottom_density_ratio", m.bottom_density_ratio, 0, 10)
      .within("bottom_sound_speed_ratio", m.bottom_sound_speed_ratio, 0, 5)
      .within("bottom_sound_speed_mps", m.bottom_sound_speed_mps, 0, 7000)
      .within("bottom_loss_parameter", m.bottom_loss_parameter, 0, 1);
  for (std::size_t i = 1; i < m.layer_depth_m.size(); ++i) {
    checker.holds(m.layer_depth_m[i] > m.layer_depth_m[i - 1], "layer_depth_m", "does not ascend");
  }
  return checker.result();
}

std::string problem_in(const environment_change_t& m) {
  const bool sets_profile = m.profile_set != environment_change_t::PROFILE_UNCHANGED;
  Checker checker;
  checker.utime(m.utime)
      .holds(m.session != 0, "session", "is 0, which is the scenario's")
      .one_of("profile_set", m.profile_set, environment_change_t::PROFILE_UNCHANGED,
              environment_change_t::PROFILE_SPEED)
      .within("wind_speed_mps", m.wind_speed_mps, 0, 100)
      .within("shipping_activity", m.shipping_activity, 0, 1)
      .within("sea_surface_z_m", m.sea_surface_z_m, -1000, 1000)
      .within("num_layers", m.num_layers, sets_profile ? 1 : 0, kMaxLayers)
      .all_within("layer_depth_m", m.layer_depth_m, 0, 12000)
      .all_finite("layer_sound_speed_mps", m.layer_sound_speed_mps)
      .all_within("layer_temperature_degc", m.layer_temperature_degc, -10, 60)
      .all_within("layer_salinity_psu", m.layer_salinity_psu, 0, 400);
  for (std::size_t i = 1; i < m.layer_depth_m.size(); ++i) {
    checker.holds(m.layer_depth_m[i] > m.layer_depth_m[i - 1], "layer_depth_m", "does not ascend");
  }
  return checker.result();
}

std::string problem_in(const modem_config_t& m) { return check_modem(m).result(); }

std::string problem_in(const modem_send_t& m) {
  return Checker()
      .utime(m.utime)
      .id("source_id", m.source_id)
      .id_or_all("destination_id", m.destination_id)
      .one_of("packet_kind", m.packet_kind, modem_send_t::DATA, modem_send_t::PING)
      .holds(m.packet_kind != modem_send_t::PING || m.destination_id != kBroadcastId, "destination_id",
             "is 0 for all; a PING goes to one vehicle")
      .within("payload_size", m.payload_size, 0, kLongestPayload)
      .result();
}

std::string problem_in(const modem_receipt_t& m) {
  return Checker()
      .utime(m.utime)
      .one_of("receipt_result", m.receipt_result, modem_receipt_t::ACCEPTED,
              modem_receipt_t::REFUSED_QUEUE_FULL)
      .utime(m.start_utime, "start_utime")
      .within("duration_s", m.duration_s, 0, 1e7)
      .result();
}

std::string problem_in(const modem_receive_t& m) {
  return Checker()
      .utime(m.utime)
      .id("source_id", m.source_id)
      .id_or_all("destination_id", m.destination_id)
      .id("receiver_id", m.receiver_id)
      .one_of("packet_kind", m.packet_kind, modem_receive_t::DATA, modem_receive_t::PING_REPLY)
      .utime(m.departure_utime, "departure_utime")
      .within("travel_time_s", m.travel_time_s, 0, 1e6)
      .within("two_way_travel_time_s", m.two_way_travel_time_s, 0, 2e6)
      .finite("received_level_db", m.received_level_db)
      .finite("snr_db", m.snr_db)
      .within("doppler_factor", m.doppler_factor, 0, kMaxDopplerFactor)
      .finite("sinr_db", m.sinr_db)
      .within("payload_size", m.payload_size, 0, kLongestPayload)
      .result();
}

std::string problem_in(const packet_name_t& m) {
  return Checker()
      .id("source_id", m.source_id)
      .one_of("packet_kind", m.packet_kind, modem_receive_t::DATA, modem_receive_t::PING_REPLY)
      .result();
}

std::string problem_in(const packet_outcome_t& m) {
  Checker checker;
  checker.utime(m.utime)
      .id("source_id", m.source_id)
      .id_or_all("destination_id", m.destination_id)
      .id("receiver_id", m.receiver_id)
      .one_of("packet_kind", m.packet_kind, modem_receive_t::DATA, modem_receive_t::PING_REPLY)
      .one_of("packet_fate", m.packet_fate, packet_outcome_t::RECEIVED, packet_outcome_t::NOT_ACQUIRED)
      .utime(m.departure_utime, "departure_utime")
      .within("travel_time_s", m.travel_time_s, 0, 1e6)
      .within("duration_s", m.duration_s, 0, 1e7)
      .within("range_m", m.range_m, 0, 4 * kFarthestM)
      .all_finite("levels", std::array{m.transmission_loss_db, m.received_level_db, m.noise_level_db,
                                       m.snr_db, m.cutoff_level_db, m.interference_level_db, m.sinr_db})
      .one_of("propagation_used", m.propagation_used, packet_outcome_t::STRAIGHT,
              packet_outcome_t::STRAIGHT_WITHOUT_BOTTOM)
      .within("num_paths", m.num_paths, 0, 1e6)
      .within("delay_spread_s", m.delay_spread_s, 0, 1e6)
      .within("doppler_factor", m.doppler_factor, 0, kMaxDopplerFactor)
      .all_within(
          "probabilities and draws",
          std::array{m.acquisition_probability, m.success_probability, m.acquisition_draw, m.success_draw}, 0,
          1)
      .within("arrival_azimuth_rad", m.arrival_azimuth_rad, -2 * kPi, 2 * kPi)
      .within("arrival_elevation_rad", m.arrival_elevation_rad, -kPi, kPi)
      .within("num_colliders", m.num_colliders, 0, kMaxColliders);
  for (const packet_name_t& name : m.colliders) {
    checker.holds(problem_in(name).empty(), "colliders", problem_in(name));
  }
  return checker.result();
}

std::string problem_in(const ping_answer_t& m) {
  return Checker()
      .utime(m.utime)
      .name("answering_vehicle", m.answering_vehicle)
      .id("answering_id", m.answering_id)
      .id("asking_id", m.asking_id)
      .utime(m.answer_start_ns / 1000, "answer_start_ns")
      .utime(m.ping_departure_ns / 1000, "ping_departure_ns")
      .within("ping_duration_ns", static_cast<double>(m.ping_duration_ns), 0, 1e16)
      .result();
}

std::string problem_in(const position_estimate_t& m) {
  return Checker()
      .utime(m.utime)
      .id("vehicle_id", m.vehicle_id)
      .one_of("estimate_status", m.estimate_status, position_estimate_t::NONE, position_estimate_t::UNIQUE)
      .all_within("position_ned_m", m.position_ned_m, -kFarthestM, kFarthestM)
      .all_finite("covariance_ned_m2", m.covariance_ned_m2)
      .all_within("current_ned_mps", m.current_ned_mps, -kFastestMps, kFastestMps)
      .within("likelihood", m.likelihood, 0, 1)
      .all_within("error_ned_m", m.error_ned_m, -2 * kFarthestM, 2 * kFarthestM)
      .result();
}

std::string problem_in(const link_t& m) { return check_link(m).result(); }

std::string problem_in(const link_table_t& m) {
  Checker checker;
  checker.utime(m.utime).id("vehicle_id", m.vehicle_id);
  for (const link_t& peer : m.peers) checker.holds(problem_in(peer).empty(), "peers", problem_in(peer));
  return checker.result();
}

std::string problem_in(const link_query_t& m) {
  return Checker().utime(m.utime).name("client_name", m.client_name).result();
}

std::string problem_in(const link_reply_t& m) {
  Checker checker;
  checker.utime(m.utime).one_of("reply_status", m.reply_status, link_reply_t::OK, link_reply_t::REFUSED);
  for (const link_answer_t& a : m.answers) {
    checker.one_of("answer_status", a.answer_status, link_answer_t::ANSWERED, link_answer_t::BAD_INPUT);
    checker.holds(problem_in(a.link).empty(), "link", problem_in(a.link));
    checker.all_finite(
        "get*", std::array{a.getss_received_strength_db, a.getpd_propagation_delay_s, a.getbw_capacity_kbps});
    checker.one_of("getml_multipath", a.getml_multipath, link_t::MULTIPATH_UNLIKELY,
                   link_t::MULTIPATH_UNKNOWN);
  }
  return checker.result();
}

std::string problem_in(const ray_query_t& m) {
  return Checker()
      .utime(m.utime)
      .name("client_name", m.client_name)
      .all_within("base_origin_ned_m", m.base_origin_ned_m, -kFarthestM, kFarthestM)
      .result();
}

std::string problem_in(const ray_reply_t& m) {
  Checker checker;
  checker.utime(m.utime)
      .one_of("reply_status", m.reply_status, ray_reply_t::OK, ray_reply_t::REFUSED_BAD_QUERY)
      .all_finite("result_m", m.result_m)
      .all_finite("sample_distance_m", m.sample_distance_m)
      .all_finite("sample_seabed_z_m", m.sample_seabed_z_m);
  for (const std::int8_t status : m.ray_status) {
    checker.one_of("ray_status", status, ray_reply_t::HIT, ray_reply_t::BAD_INPUT);
  }
  return checker.result();
}

std::string problem_in(const node_status_t& m) {
  return Checker().utime(m.utime).name("node_name", m.node_name).result();
}

std::string problem_in(const flow_heartbeat_t& m) {
  return Checker()
      .utime(m.utime)
      .utime(m.age_us, "age_us")
      .within("num_flows", m.num_flows, 0, kMaxFlows)
      .result();
}

std::string problem_in(const repair_request_t& m) {
  return Checker()
      .utime(m.utime)
      .name("client_name", m.client_name)
      .within("num_missing", m.num_missing, 1, kMaxMissing)
      .result();
}

}  // namespace halocline::bus
