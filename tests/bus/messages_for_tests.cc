#include "tests/bus/messages_for_tests.h"

#include <algorithm>
#include <numeric>

namespace halocline::bus::testing {
namespace {

// Small numbers that differ from field to field, so that an exchange of two shows.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : next_(seed * 7u % 50u) {}
  int whole() { return static_cast<int>(++next_ % 90u) + 1; }
  double real() { return whole() + 0.25; }
  std::vector<double> reals(int count) {
    std::vector<double> values(static_cast<std::size_t>(count));
    std::generate(values.begin(), values.end(), [this] { return real(); });
    return values;
  }
  std::vector<std::vector<double>> points(int count) {
    std::vector<std::vector<double>> values(static_cast<std::size_t>(count));
    std::generate(values.begin(), values.end(), [this] { return reals(3); });
    return values;
  }

 private:
  unsigned next_;
};

// Of whatever has them: the head of a message, then who sent which packet to whom.
template <class Message>
Message with_head(Numbers& n) {
  Message m{};
  m.utime = n.whole();
  if constexpr (requires { m.session; }) m.session = n.whole();
  if constexpr (requires { m.sequence; }) m.sequence = n.whole();
  if constexpr (requires { m.request_id; }) m.request_id = n.whole();
  if constexpr (requires { m.send_session; }) m.send_session = n.whole();
  if constexpr (requires { m.packet_sequence; }) m.packet_sequence = n.whole();
  if constexpr (requires { m.source_id; }) m.source_id = n.whole();
  if constexpr (requires { m.destination_id; }) m.destination_id = n.whole();
  if constexpr (requires { m.receiver_id; }) m.receiver_id = n.whole();
  return m;
}

int size_of_arrays(unsigned seed) { return static_cast<int>(seed * 5u % 23u); }

std::vector<std::uint8_t> payload_of(int size) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{1});
  return bytes;
}

}  // namespace

template <>
sim_clock_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<sim_clock_t>(n);
  m.clock_rate = n.real();
  m.clock_step_us = n.whole();
  m.lockstep = 1;
  return m;
}

template <>
vehicle_state_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<vehicle_state_t>(n);
  m.vehicle_id = n.whole();
  for (double& x : m.position_ned_m) x = n.real();
  const double quaternion[4] = {0.5, -0.5, 0.5, -0.5};
  std::copy(quaternion, quaternion + 4, m.orientation_wxyz);
  for (double& v : m.velocity_ned_mps) v = n.real();
  for (double& w : m.angular_velocity_body_radps) w = n.real();
  return m;
}

template <>
vehicle_command_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<vehicle_command_t>(n);
  m.propeller_rpm = n.real();
  m.rudder_rad = 0.25;
  m.stern_plane_rad = -0.25;
  for (double& rpm : m.thruster_rpm) rpm = n.real();
  return m;
}

template <>
vehicle_sensors_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<vehicle_sensors_t>(n);
  m.depth_fresh = m.attitude_fresh = 1;
  m.depth_m = n.real();
  m.altitude_status = vehicle_sensors_t::ALTITUDE_MEASURED;
  m.altitude_m = n.real();
  m.water_speed_mps = n.real();
  m.heading_rad = -3;
  m.pitch_rad = 0.5;
  m.roll_rad = -0.5;
  for (double& w : m.angular_rate_body_radps) w = n.real();
  m.shaft_rpm = n.real();
  m.rudder_angle_rad = 0.125;
  m.stern_angle_rad = -0.125;
  for (double& rpm : m.thruster_rpm) rpm = n.real();
  m.safe_state = 0;
  m.on_seabed = 1;
  return m;
}

template <>
vehicle_dvl_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<vehicle_dvl_t>(n);
  m.beam_status[1] = vehicle_dvl_t::BEAM_NO_BOTTOM;
  for (double& r : m.beam_range_m) r = n.real();
  for (double& v : m.beam_speed_mps) v = n.real();
  m.ground_velocity_valid = 1;
  for (double& v : m.ground_velocity_body_mps) v = n.real();
  m.velocity_deviation_mps = n.real();
  return m;
}

template <>
vehicle_gps_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<vehicle_gps_t>(n);
  m.fix_north_m = n.real();
  m.fix_east_m = n.real();
  m.fix_deviation_m = n.real();
  return m;
}

template <>
vehicle_sonar_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<vehicle_sonar_t>(n);
  m.fan_tilt_rad = 0.25;
  m.greatest_range_m = n.real();
  m.num_fan_rays = std::max(1, size_of_arrays(seed));
  for (int i = 0; i < m.num_fan_rays; ++i) {
    m.fan_azimuth_rad.push_back(0.01 * i);
    m.echo_status.push_back(vehicle_sonar_t::ECHO);
    m.echo_range_m.push_back(n.real());
  }
  return m;
}

template <>
vehicle_usbl_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<vehicle_usbl_t>(n);
  m.peer_id = n.whole();
  m.packet_kind = modem_receive_t::PING_REPLY;
  m.peer_bearing_rad = -0.5;
  m.peer_elevation_rad = 0.25;
  m.angle_deviation_rad = 0.125;
  m.travel_time_known = 1;
  m.one_way_travel_time_s = n.real();
  return m;
}

template <>
vehicle_fault_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<vehicle_fault_t>(n);
  m.fault_kind = vehicle_fault_t::LEAK;
  m.stuck_angle_given = 1;
  m.stuck_angle_rad = -0.25;
  m.leak_rate_kg_s = n.real();
  m.leak_volume_m3 = n.real();
  m.dead_sensor = vehicle_fault_t::DVL;
  return m;
}

template <>
current_change_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<current_change_t>(n);
  for (double& v : m.uniform_ned_mps) v = 0.05 * n.real();
  m.num_depths = size_of_arrays(seed);
  for (int i = 0; i < m.num_depths; ++i) {
    m.depth_m.push_back(10.0 * i);
    m.north_mps.push_back(0.05 * n.real());
    m.east_mps.push_back(-0.05 * n.real());
  }
  m.tide_amplitude_mps = 0.05 * n.real();
  m.tide_period_s = n.real();
  m.tide_phase_rad = 0.5;
  m.tide_toward_rad = -0.5;
  m.random_deviation_mps = 0.05 * n.real();
  m.random_time_s = n.real();
  return m;
}

template <>
environment_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<environment_t>(n);
  m.num_layers = std::max(1, size_of_arrays(seed));
  m.layer_salinity_psu = n.reals(m.num_layers);
  for (int i = 0; i < m.num_layers; ++i) {
    m.layer_depth_m.push_back(10.0 * i);
    m.layer_sound_speed_mps.push_back(1500 - i);
    m.layer_temperature_degc.push_back(20 - 0.5 * i);
  }
  m.wind_speed_mps = n.real();
  m.shipping_activity = 0.5;
  m.acidity_ph = 8;
  m.sea_surface_z_m = -1;
  m.spreading_exponent = 1.5;
  m.sound_speed_model = "mackenzie";
  m.absorption_model = "francois-garrison";
  m.bottom_density_ratio = 1.8;
  m.bottom_sound_speed_ratio = 1.1;
  m.bottom_sound_speed_mps = 0;
  m.bottom_loss_parameter = 0.01;
  m.surface_model = "apl-bubbles";
  m.propagation_model = "rays";
  m.terrain_version = std::string(static_cast<std::size_t>(size_of_arrays(seed)), 'v');
  return m;
}

template <>
environment_change_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<environment_change_t>(n);
  m.session = 5;
  m.sets_wind = m.sets_shipping = m.sets_sea_surface = 1;
  m.num_layers = size_of_arrays(seed);
  m.profile_set =
      m.num_layers > 0 ? environment_change_t::PROFILE_WATER : environment_change_t::PROFILE_UNCHANGED;
  m.layer_salinity_psu = n.reals(m.num_layers);
  for (int i = 0; i < m.num_layers; ++i) {
    m.layer_depth_m.push_back(10.0 * i);
    m.layer_sound_speed_mps.push_back(1500 - i);
    m.layer_temperature_degc.push_back(20 - 0.5 * i);
  }
  m.wind_speed_mps = n.real();
  m.shipping_activity = 0.5;
  m.sea_surface_z_m = -1;
  return m;
}

template <>
modem_config_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<modem_config_t>(n);
  m.source_level_db = 185;
  m.center_frequency_hz = 25'000;
  m.bandwidth_hz = 5'000;
  m.directivity_index_db = n.real();
  m.cutoff_level_db = n.real();
  m.bit_rate_bps = n.real();
  m.packet_overhead_s = n.real();
  m.max_payload_bytes = n.whole();
  m.modem_profile = modem_config_t::PROFILE_MICROMODEM_PSK;
  m.psk_rate = 5;
  m.preamble_s = n.real();
  m.guard_time_s = n.real();
  m.doppler_tolerance = 0.125;
  m.error_model = modem_config_t::ERRORS_BPSK_HAMMING14;
  m.when_busy = modem_config_t::QUEUE;
  m.num_beam_rows = size_of_arrays(seed);
  m.beam_loss_db = n.reals(m.num_beam_rows);
  for (int i = 0; i < m.num_beam_rows; ++i) m.beam_elevation_rad.push_back(-1 + 0.0625 * i);
  return m;
}

template <>
modem_send_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<modem_send_t>(n);
  m.packet_kind = modem_send_t::PING;
  m.stamped = 1;
  m.payload_size = size_of_arrays(seed);
  m.payload = payload_of(m.payload_size);
  return m;
}

template <>
modem_receipt_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<modem_receipt_t>(n);
  m.receipt_result = modem_receipt_t::REFUSED_QUEUE_FULL;
  m.start_utime = n.whole();
  m.duration_s = n.real();
  return m;
}

template <>
modem_receive_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<modem_receive_t>(n);
  m.packet_kind = modem_receive_t::PING_REPLY;
  m.stamped = 1;
  m.departure_utime = n.whole();
  m.travel_time_s = n.real();
  m.two_way_travel_time_s = n.real();
  m.received_level_db = n.real();
  m.snr_db = n.real();
  m.doppler_factor = 1.0625;
  m.sinr_db = n.real();
  m.payload_size = size_of_arrays(seed);
  m.payload = payload_of(m.payload_size);
  return m;
}

template <>
packet_name_t valid_message(unsigned seed) {
  Numbers n(seed);
  packet_name_t m;
  m.source_id = n.whole();
  m.packet_kind = modem_receive_t::PING;
  m.send_session = n.whole();
  m.packet_sequence = n.whole();
  return m;
}

template <>
packet_outcome_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<packet_outcome_t>(n);
  m.packet_kind = modem_receive_t::PING_REPLY;
  m.packet_fate = packet_outcome_t::NOT_ACQUIRED;
  m.departure_utime = n.whole();
  m.travel_time_s = n.real();
  m.duration_s = n.real();
  m.range_m = n.real();
  m.transmission_loss_db = n.real();
  m.received_level_db = n.real();
  m.noise_level_db = n.real();
  m.snr_db = n.real();
  m.cutoff_level_db = n.real();
  m.propagation_used = packet_outcome_t::STRAIGHT_WITHOUT_BOTTOM;
  m.num_paths = n.whole();
  m.delay_spread_s = n.real();
  m.doppler_factor = 0.9375;
  m.interference_level_db = n.real();
  m.sinr_db = n.real();
  m.acquisition_probability = 0.5;
  m.success_probability = 0.25;
  m.acquisition_draw = 0.75;
  m.success_draw = 0.125;
  m.arrival_azimuth_rad = -3;
  m.arrival_elevation_rad = 0.5;
  m.num_colliders = std::min(16, size_of_arrays(seed));
  for (int i = 0; i < m.num_colliders; ++i) {
    m.colliders.push_back(valid_message<packet_name_t>(seed + static_cast<unsigned>(i)));
  }
  return m;
}

template <>
position_estimate_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<position_estimate_t>(n);
  m.vehicle_id = n.whole();
  m.estimate_status = position_estimate_t::AMBIGUOUS;
  for (double& x : m.position_ned_m) x = n.real();
  for (double& x : m.covariance_ned_m2) x = n.real();
  for (double& x : m.current_ned_mps) x = n.real();
  m.likelihood = 0.75;
  m.ranges_used = n.whole();
  m.ranges_refused = n.whole();
  m.truth_known = 1;
  for (double& x : m.error_ned_m) x = n.real();
  return m;
}

template <>
link_t valid_message(unsigned seed) {
  Numbers n(seed);
  link_t m;
  m.transmitter_id = n.whole();
  m.receiver_id = n.whole();
  m.range_m = n.real();
  m.delay_s = n.real();
  m.transmission_loss_db = n.real();
  m.received_level_db = n.real();
  m.noise_level_db = n.real();
  m.snr_db = -n.real();
  m.capacity_bps = n.real();
  m.receivable = 1;
  m.multipath = link_t::MULTIPATH_UNKNOWN;
  m.transmitter_age_s = n.real();
  m.receiver_age_s = n.real();
  m.path_state = link_t::PATH_SHADOW;
  m.propagation_used = link_t::USED_RAYS;
  m.num_paths = 7;
  m.delay_spread_s = n.real();
  m.doppler_factor = 1.001;
  return m;
}

template <>
link_table_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<link_table_t>(n);
  m.vehicle_id = n.whole();
  m.num_peers = size_of_arrays(seed);
  for (int i = 0; i < m.num_peers; ++i)
    m.peers.push_back(valid_message<link_t>(seed + static_cast<unsigned>(i)));
  return m;
}

template <>
link_end_t valid_message(unsigned seed) {
  Numbers n(seed);
  link_end_t m;
  m.vehicle_name = std::string(seed % 5u, 'a');
  for (double& x : m.position_ned_m) x = n.real();
  m.modem_choice = link_end_t::MODEM_GIVEN;
  m.modem = valid_message<modem_config_t>(seed);
  return m;
}

template <>
link_query_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<link_query_t>(n);
  m.client_name = "client-1";
  m.num_links = size_of_arrays(seed);
  for (int i = 0; i < m.num_links; ++i) {
    m.transmitters.push_back(valid_message<link_end_t>(seed + static_cast<unsigned>(i)));
    m.receivers.push_back(valid_message<link_end_t>(seed + 1 + static_cast<unsigned>(i)));
  }
  return m;
}

template <>
link_answer_t valid_message(unsigned seed) {
  Numbers n(seed);
  link_answer_t m;
  m.answer_status = link_answer_t::ANSWERED;
  m.problem = std::string(seed % 7u, 'p');
  m.link = valid_message<link_t>(seed);
  m.getss_received_strength_db = n.real();
  m.getpd_propagation_delay_s = n.real();
  m.getbw_capacity_kbps = n.real();
  m.getml_multipath = link_t::MULTIPATH_LIKELY;
  return m;
}

template <>
link_reply_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<link_reply_t>(n);
  m.reply_status = link_reply_t::OK;
  m.refusal = std::string(seed % 3u, 'r');
  m.num_answers = size_of_arrays(seed);
  for (int i = 0; i < m.num_answers; ++i) {
    m.answers.push_back(valid_message<link_answer_t>(seed + static_cast<unsigned>(i)));
  }
  return m;
}

template <>
ray_query_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<ray_query_t>(n);
  m.client_name = "client_2";
  m.expected_terrain = std::string(seed % 4u, 't');
  m.query_mode = ray_query_t::DEPTH;
  m.sample_spacing_m = n.real();
  for (double& x : m.base_origin_ned_m) x = n.real();
  m.num_rays = size_of_arrays(seed);
  m.offset_m = n.points(m.num_rays);
  m.direction = n.points(m.num_rays);
  m.greatest_range_m = n.reals(m.num_rays);
  return m;
}

template <>
ray_reply_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<ray_reply_t>(n);
  m.terrain_version = "etopo5-1234";
  m.reply_status = ray_reply_t::OK;
  m.refusal = std::string(seed % 3u, 'r');
  m.num_rays = size_of_arrays(seed);
  m.ray_status.assign(static_cast<std::size_t>(m.num_rays), ray_reply_t::BELOW_BOTTOM);
  m.result_m = n.reals(m.num_rays);
  m.num_samples = size_of_arrays(seed + 1);
  m.sample_distance_m = n.reals(m.num_samples);
  m.sample_seabed_z_m = n.reals(m.num_samples);
  m.sample_valid.assign(static_cast<std::size_t>(m.num_samples), 1);
  return m;
}

template <>
node_status_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<node_status_t>(n);
  m.node_name = "node-a";
  m.node_version = std::string(seed % 6u, '1');
  m.messages_received = n.whole();
  m.messages_sent = n.whole();
  m.messages_refused = n.whole();
  m.gaps = n.whole();
  m.repaired = n.whole();
  m.lost = n.whole();
  m.duplicates = n.whole();
  m.late = n.whole();
  m.status_text = std::string(static_cast<std::size_t>(size_of_arrays(seed)), 's');
  return m;
}

template <>
flow_heartbeat_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<flow_heartbeat_t>(n);
  m.age_us = n.whole();
  m.num_flows = size_of_arrays(seed);
  const auto count = static_cast<std::size_t>(m.num_flows);
  for (std::size_t i = 0; i < count; ++i) {
    m.flow_channel.push_back("STATE.v" + std::to_string(i));
    m.flow_session.push_back(n.whole());
    m.flow_last_sequence.push_back(n.whole());
  }
  return m;
}

template <>
ping_answer_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<ping_answer_t>(n);
  m.answering_vehicle = "v" + std::string(seed % 3u, 'w');
  m.answering_id = n.whole();
  m.asking_id = n.whole();
  m.ping_session = n.whole();
  m.ping_sequence = n.whole();
  m.answer_start_ns = n.whole();
  m.ping_departure_ns = n.whole();
  m.ping_duration_ns = n.whole();
  return m;
}

template <>
repair_request_t valid_message(unsigned seed) {
  Numbers n(seed);
  auto m = with_head<repair_request_t>(n);
  m.client_name = "client-a";
  m.missing_channel = "STATE." + std::string(seed % 4u, 'v');
  m.publisher_session = n.whole();
  m.num_missing = size_of_arrays(seed) + 1;
  for (int i = 0; i < m.num_missing; ++i) m.missing_sequence.push_back(n.whole());
  return m;
}

}  // namespace halocline::bus::testing
