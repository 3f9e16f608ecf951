#include "channel_server/channel_server_messages.h"

#include <algorithm>

#include "acoustics/modem/modem_profile.h"
#include "bus/message_checks.h"
#include "core/check.h"

namespace halocline::channel_server {
namespace {

Vec3 to_vec3(const double (&values)[3]) { return {values[0], values[1], values[2]}; }

std::vector<double> as_vector(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

acoustics::BeamPattern beam_in(const modem_config_t& message) {
  std::vector<acoustics::BeamRow> rows;
  for (std::size_t i = 0; i < message.beam_elevation_rad.size(); ++i) {
    rows.push_back({message.beam_elevation_rad[i], message.beam_loss_db[i]});
  }
  return rows.empty() ? acoustics::BeamPattern() : acoustics::BeamPattern(std::move(rows));
}

// The modem whose way of framing packets the message names.
acoustics::Modem framed_modem(const modem_config_t& message) {
  require(message.modem_profile >= 0 &&
              static_cast<std::size_t>(message.modem_profile) < acoustics::kModemProfiles.size(),
          "modem_profile is no value of its enumeration");
  require(message.error_model >= 0 &&
              static_cast<std::size_t>(message.error_model) < acoustics::kErrorModels.size(),
          "error_model is no value of its enumeration");
  return profile_modem(static_cast<acoustics::ModemProfile>(message.modem_profile), message.psk_rate);
}

LinkEndRequest to_asked_end(const link_end_t& message) {
  LinkEndRequest end{message.vehicle_name, to_vec3(message.position_ned_m)};
  if (message.modem_choice == link_end_t::MODEM_SCENARIO) return end;
  if (message.modem_choice != link_end_t::MODEM_GIVEN) {
    end.problem = "modem_choice is no value of its enumeration";
    return end;
  }
  end.problem = bus::problem_in(message.modem);
  if (!end.problem.empty()) return end;
  try {
    end.modem = to_modem(message.modem);
  } catch (const InvalidArgument& error) {
    end.problem = error.what();
  }
  return end;
}

link_answer_t to_message(const LinkAnswer& answer) {
  link_answer_t message{};
  message.answer_status = static_cast<std::int8_t>(answer.status);
  message.problem = answer.problem;
  if (answer.status != LinkAnswer::Status::kAnswered) return message;
  message.link = to_message(answer.row);
  message.getss_received_strength_db = message.link.received_level_db;
  message.getpd_propagation_delay_s = message.link.delay_s;
  message.getbw_capacity_kbps = message.link.capacity_bps / 1000;
  message.getml_multipath = message.link.multipath;
  return message;
}

acoustics::SoundSpeedProfile profile_in(const environment_change_t& m, const acoustics::Environment& before) {
  require(!m.layer_depth_m.empty(), "a profile needs at least one layer");
  std::vector<acoustics::WaterRow> water;
  std::vector<acoustics::SpeedRow> speeds;
  for (std::size_t i = 0; i < m.layer_depth_m.size(); ++i) {
    water.push_back({m.layer_depth_m[i], m.layer_temperature_degc[i], m.layer_salinity_psu[i]});
    speeds.push_back({m.layer_depth_m[i], m.layer_sound_speed_mps[i]});
  }
  using Profile = acoustics::SoundSpeedProfile;
  if (m.profile_set == environment_change_t::PROFILE_SPEED) {
    return Profile::from_speeds(std::move(speeds), {m.layer_temperature_degc[0], m.layer_salinity_psu[0]});
  }
  return Profile::from_water(std::move(water), before.profile.model(), before.latitude_rad);
}

// What OUTCOME and RECEIVE tell alike.
template <class Message>
Message of_packet_end(const PacketEnd& end, SimTime at) {
  const SendRequest& request = end.packet->request;
  Message message{};
  message.utime = at.to_utime();
  message.send_session = request.session;
  message.packet_sequence = request.packet_sequence;
  message.source_id = request.source_id;
  message.destination_id = request.destination_id;
  message.receiver_id = end.receiver_id;
  message.packet_kind = static_cast<std::int8_t>(request.kind);
  message.departure_utime = end.packet->departure.to_utime();
  message.travel_time_s = end.travel_time_s;
  message.received_level_db = end.budget.received_level.value;
  message.snr_db = end.budget.snr.value;
  message.strongest_path_doppler_factor = end.doppler_factor;
  message.sinr_db = end.judgement.sinr.value;
  return message;
}

packet_name_t to_message(const PacketName& name) {
  packet_name_t message{};
  message.source_id = name.source_id;
  message.packet_kind = static_cast<std::int8_t>(name.kind);
  message.send_session = name.session;
  message.packet_sequence = name.packet_sequence;
  return message;
}

void tell_judgement(const Judgement& judgement, packet_outcome_t& message) {
  message.interference_level_db = judgement.interference.value;
  message.acquisition_probability = judgement.acquisition_probability;
  message.success_probability = judgement.success_probability;
  message.acquisition_draw = judgement.acquisition_draw;
  message.success_draw = judgement.success_draw;
  message.num_colliders = static_cast<std::int32_t>(judgement.colliders.size());
  for (const PacketName& name : judgement.colliders) message.colliders.push_back(to_message(name));
}

constexpr double kFormulaStepM = 100, kFormulaDepthM = 5000;
constexpr std::size_t kMaxLayers = 2000;  // environment_t

std::vector<double> depths_to_tell(const acoustics::SoundSpeedProfile& profile) {
  const std::vector<double> rows = profile.row_depths_m();
  const std::size_t stride = rows.size() / kMaxLayers + 1;
  std::vector<double> depths;
  for (std::size_t i = 0; i < rows.size(); i += stride) depths.push_back(rows[i]);
  if (!depths.empty()) return depths;
  for (double depth = 0; depth <= kFormulaDepthM; depth += kFormulaStepM) depths.push_back(depth);
  return depths;
}

std::string joined(std::initializer_list<std::int64_t> numbers) {
  std::string text;
  for (const std::int64_t number : numbers) text += (text.empty() ? "" : " ") + std::to_string(number);
  return text;
}

}  // namespace

StampedState to_state(const vehicle_state_t& message) {
  return {SimTime::from_utime(message.utime), to_vec3(message.position_ned_m),
          to_vec3(message.velocity_ned_mps)};
}

VehicleModem to_modem(const modem_config_t& message) {
  VehicleModem modem;
  modem.modem = framed_modem(message);
  modem.modem.source_level = {message.source_level_db};
  modem.modem.min_receivable_level = {message.cutoff_level_db};
  modem.modem.centre_frequency_hz = message.center_frequency_hz;
  modem.modem.bandwidth_hz = message.bandwidth_hz;
  modem.modem.directivity_index = {message.directivity_index_db};
  modem.modem.bit_rate_bps = message.bit_rate_bps;
  modem.modem.packet_overhead = SimDuration::from_seconds(message.packet_overhead_s);
  modem.modem.preamble = SimDuration::from_seconds(message.preamble_s);
  modem.modem.guard_time = SimDuration::from_seconds(message.guard_time_s);
  modem.modem.doppler_tolerance = message.doppler_tolerance;
  modem.modem.error_model = static_cast<acoustics::ErrorModel>(message.error_model);
  modem.modem.beam = beam_in(message);
  modem.max_payload_bytes = message.max_payload_bytes;
  modem.when_busy = static_cast<WhenBusy>(message.when_busy);
  validate(modem.modem);
  validate_profile(modem.modem);
  return modem;
}

modem_config_t to_message(const VehicleModem& modem, SimTime from) {
  modem_config_t message{};
  message.utime = from.to_utime();
  message.source_level_db = modem.modem.source_level.value;
  message.cutoff_level_db = modem.modem.min_receivable_level.value;
  message.center_frequency_hz = modem.modem.centre_frequency_hz;
  message.bandwidth_hz = modem.modem.bandwidth_hz;
  message.directivity_index_db = modem.modem.directivity_index.value;
  message.bit_rate_bps = modem.modem.bit_rate_bps;
  message.packet_overhead_s = modem.modem.packet_overhead.seconds();
  message.max_payload_bytes = modem.max_payload_bytes;
  message.modem_profile = static_cast<std::int8_t>(modem.modem.profile);
  message.psk_rate = modem.modem.psk_rate;
  message.preamble_s = modem.modem.preamble.seconds();
  message.guard_time_s = modem.modem.guard_time.seconds();
  message.doppler_tolerance = modem.modem.doppler_tolerance;
  message.error_model = static_cast<std::int8_t>(modem.modem.error_model);
  message.when_busy = static_cast<std::int8_t>(modem.when_busy);
  message.num_beam_rows = static_cast<std::int32_t>(modem.modem.beam.rows().size());
  for (const acoustics::BeamRow& row : modem.modem.beam.rows()) {
    message.beam_elevation_rad.push_back(row.elevation_rad);
    message.beam_loss_db.push_back(row.loss_db);
  }
  return message;
}

SendRequest to_request(std::string_view vehicle, const modem_send_t& message) {
  SendRequest request;
  request.vehicle = vehicle;
  request.source_id = message.source_id;
  request.destination_id = message.destination_id;
  request.session = message.session;
  request.packet_sequence = message.packet_sequence;
  request.start = SimTime::from_utime(message.utime);
  request.payload = message.payload;
  request.kind = static_cast<PacketKind>(message.packet_kind);
  request.stamped = message.stamped != 0;
  return request;
}

ping_answer_t to_message(const PingAnswer& answer, SimTime at) {
  ping_answer_t message{};
  message.utime = at.to_utime();
  message.answering_vehicle = answer.request.vehicle;
  message.answering_id = answer.request.source_id;
  message.ping_source_id = answer.request.destination_id;
  message.ping_session = answer.request.session;
  message.ping_sequence = answer.request.packet_sequence;
  message.answer_start_ns = answer.request.start.nanoseconds();
  message.ping_departure_ns = answer.ping_departure.nanoseconds();
  message.ping_duration_ns = answer.ping_duration.nanoseconds();
  return message;
}

PingAnswer to_answer(const ping_answer_t& message) {
  PingAnswer answer;
  answer.request.vehicle = message.answering_vehicle;
  answer.request.source_id = message.answering_id;
  answer.request.destination_id = message.ping_source_id;
  answer.request.session = message.ping_session;
  answer.request.packet_sequence = message.ping_sequence;
  answer.request.start = SimTime::from_nanoseconds(message.answer_start_ns);
  answer.request.kind = PacketKind::kPingReply;
  answer.request.stamped = false;
  answer.ping_departure = SimTime::from_nanoseconds(message.ping_departure_ns);
  answer.ping_duration = SimDuration::from_nanoseconds(message.ping_duration_ns);
  return answer;
}

modem_receipt_t to_message(const Receipt& receipt, SimTime answered_at) {
  modem_receipt_t message{};
  message.utime = answered_at.to_utime();
  message.send_session = receipt.session;
  message.packet_sequence = receipt.packet_sequence;
  message.receipt_result = static_cast<std::int8_t>(receipt.result);
  message.start_utime = receipt.start.to_utime();
  message.duration_s = receipt.duration.seconds();
  return message;
}

packet_outcome_t to_outcome(const PacketEnd& end, SimTime at) {
  auto message = of_packet_end<packet_outcome_t>(end, at);
  message.outcome = static_cast<std::int8_t>(end.fate);
  message.duration_s = end.packet->timing.duration.seconds();
  message.range_m = end.budget.range_m;
  message.transmission_loss_db = end.budget.transmission_loss.value;
  message.noise_level_db = end.budget.noise_level.value;
  message.cutoff_level_db = end.cutoff.value;
  message.propagation_used = static_cast<std::int8_t>(end.propagation);
  message.num_paths = static_cast<std::int32_t>(end.path_count);
  message.delay_spread_s = end.delay_spread_s;
  message.arrival_azimuth_rad = end.arrival_azimuth_rad;
  message.arrival_elevation_rad = end.arrival_elevation_rad;
  tell_judgement(end.judgement, message);
  return message;
}

modem_receive_t to_receive(const PacketEnd& end, SimTime at) {
  const SendRequest& request = end.packet->request;
  auto message = of_packet_end<modem_receive_t>(end, at);
  message.stamped = request.stamped ? 1 : 0;
  if (!request.stamped) message.departure_utime = 0, message.travel_time_s = 0;
  message.two_way_travel_time_s = end.two_way_travel_time_s;
  message.payload_size = static_cast<std::int32_t>(request.payload.size());
  message.payload = request.payload;
  return message;
}

// A sender that keeps no session may number anew: the instant tells its packets apart.
std::string identity_of(const modem_receipt_t& m) {
  return joined({m.send_session, m.packet_sequence, m.send_session == 0 ? m.start_utime : 0});
}

std::string identity_of(const modem_receive_t& m) {
  return joined(
      {m.source_id, m.send_session, m.packet_sequence, m.packet_kind, m.send_session == 0 ? m.utime : 0});
}

std::string identity_of(const packet_outcome_t& m) {
  return joined({m.source_id, m.send_session, m.packet_sequence, m.packet_kind, m.receiver_id,
                 m.send_session == 0 ? m.departure_utime : 0});
}

std::string identity_of(const ping_answer_t& m) {
  return joined({m.answering_id, m.ping_source_id, m.ping_session, m.ping_sequence, m.answer_start_ns});
}

link_t to_message(const LinkRow& row) {
  link_t message{};
  message.transmitter_id = row.transmitter_id;
  message.receiver_id = row.receiver_id;
  message.range_m = row.budget.range_m;
  message.delay_s = row.budget.delay_s;
  message.transmission_loss_db = row.budget.transmission_loss.value;
  message.received_level_db = row.budget.received_level.value;
  message.noise_level_db = row.budget.noise_level.value;
  message.snr_db = row.budget.snr.value;
  message.capacity_bps = row.budget.capacity_bps;
  message.receivable = row.budget.receivable ? 1 : 0;
  message.multipath = static_cast<std::int8_t>(row.multipath);
  message.transmitter_age_s = row.transmitter_age.seconds();
  message.receiver_age_s = row.receiver_age.seconds();
  message.path_state = static_cast<std::int8_t>(row.state);
  message.propagation_used = static_cast<std::int8_t>(row.used);
  message.num_paths = row.path_count;
  message.delay_spread_s = row.delay_spread_s;
  message.first_path_doppler_factor = row.doppler_factor;
  return message;
}

link_table_t to_message(const LinkTable& table, SimTime at) {
  link_table_t message{};
  message.utime = at.to_utime();
  message.vehicle_id = table.vehicle_id;
  message.num_peers = static_cast<std::int32_t>(table.rows.size());
  for (const LinkRow& row : table.rows) message.peers.push_back(to_message(row));
  return message;
}

LinkQuestion to_question(const link_query_t& message) {
  LinkQuestion question{message.client_name, message.request_id, {}, {}};
  for (const link_end_t& end : message.transmitters) question.transmitters.push_back(to_asked_end(end));
  for (const link_end_t& end : message.receivers) question.receivers.push_back(to_asked_end(end));
  return question;
}

link_reply_t to_message(const LinkReply& reply) {
  link_reply_t message{};
  message.utime = reply.at.to_utime();
  message.request_id = reply.request_id;
  message.reply_status = reply.refusal.empty() ? link_reply_t::OK : link_reply_t::REFUSED;
  message.refusal = reply.refusal;
  message.num_answers = static_cast<std::int32_t>(reply.answers.size());
  for (const LinkAnswer& answer : reply.answers) message.answers.push_back(to_message(answer));
  return message;
}

ray_query_t to_message(const RayBatch& batch, std::string_view client, SimTime asked_at) {
  ray_query_t message{};
  message.utime = asked_at.to_utime();
  message.client_name = client;
  message.request_id = batch.request_id;
  message.query_mode = batch.kind == RayKind::kDepths ? ray_query_t::DEPTH : ray_query_t::OCCLUDED;
  message.num_rays = static_cast<std::int32_t>(batch.rays.size());
  for (const TerrainRay& ray : batch.rays) {
    message.offset_m.push_back(as_vector(ray.origin_ned_m));
    message.direction.push_back(as_vector(ray.direction));
    message.max_range_m.push_back(ray.max_range_m);
  }
  return message;
}

std::vector<RayAnswer> to_answers(const ray_reply_t& message) {
  std::vector<RayAnswer> answers;
  for (std::size_t i = 0; i < message.ray_status.size(); ++i) {
    answers.push_back({static_cast<RayAnswer::Kind>(message.ray_status[i]), message.result_m[i]});
  }
  return answers;
}

environment_t to_message(const acoustics::Environment& environment, const WaterDescription& description,
                         SimTime from, const std::string& terrain_version) {
  environment_t message{};
  message.utime = from.to_utime();
  for (const double depth_m : depths_to_tell(environment.profile)) {
    const acoustics::WaterSample water = environment.profile.water(depth_m);
    message.layer_depth_m.push_back(depth_m);
    message.layer_sound_speed_mps.push_back(environment.profile.sound_speed_mps(depth_m));
    message.layer_temperature_degc.push_back(water.temperature_degc);
    message.layer_salinity_psu.push_back(water.salinity_psu);
  }
  message.num_layers = static_cast<std::int32_t>(message.layer_depth_m.size());
  message.wind_speed_mps = environment.noise.wind_mps;
  message.shipping_activity = environment.noise.shipping;
  message.acidity_ph = environment.ph;
  message.sea_surface_z_m = environment.sea_surface_z_m;
  message.spreading_exponent = environment.spreading_exponent;
  message.sound_speed_model = to_name(environment.profile.model());
  message.absorption_model = to_name(environment.absorption_model);
  message.propagation_model = description.propagation;
  if (description.surface) message.surface_model = to_name(*description.surface);
  if (description.bottom) {
    message.bottom_density_ratio = description.bottom->density_ratio;
    message.bottom_sound_speed_ratio = description.bottom->sound_speed_ratio;
    message.bottom_sound_speed_mps = description.bottom->sound_speed_mps;
    message.bottom_loss_parameter = description.bottom->loss_parameter;
  }
  message.terrain_version = terrain_version;
  return message;
}

EnvironmentChange to_change(const environment_change_t& message, const acoustics::Environment& before) {
  EnvironmentChange change;
  if (message.sets_wind != 0) change.wind_mps = message.wind_speed_mps;
  if (message.sets_shipping != 0) change.shipping = message.shipping_activity;
  if (message.sets_sea_surface != 0) change.sea_surface_z_m = message.sea_surface_z_m;
  if (message.profile_set != environment_change_t::PROFILE_UNCHANGED) {
    change.profile = profile_in(message, before);
  }
  return change;
}

}  // namespace halocline::channel_server
