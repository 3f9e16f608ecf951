#include "channel_server/packet_messages.h"

#include <cstdint>
#include <initializer_list>

namespace halocline::channel_server {
namespace {

// What OUTCOME and RECEIVE have in common.
template <class Message>
Message common_fields(const PacketOutcome& outcome, SimTime at) {
  const SendRequest& request = outcome.packet->request;
  Message message{};
  message.utime = at.to_utime();
  message.send_session = request.session;
  message.packet_sequence = request.packet_sequence;
  message.source_id = request.source_id;
  message.destination_id = request.destination_id;
  message.receiver_id = outcome.receiver_id;
  message.packet_kind = static_cast<std::int8_t>(request.kind);
  message.departure_utime = outcome.packet->departure.to_utime();
  message.travel_time_s = outcome.travel_time_s;
  message.received_level_db = outcome.budget.received_level.value;
  message.snr_db = outcome.budget.snr.value;
  message.strongest_path_doppler_factor = outcome.doppler_factor;
  message.sinr_db = outcome.statistics.sinr.value;
  return message;
}

packet_name_t to_message(const PacketName& name) {
  packet_name_t message{};
  message.source_id = name.source_id;
  message.packet_kind = static_cast<std::int8_t>(name.kind);
  message.send_session = name.session;
  message.packet_sequence = name.packet_sequence;
  message.is_noise = name.is_noise ? 1 : 0;
  return message;
}

void set_statistics(const DecisionStatistics& statistics, packet_outcome_t& message) {
  message.interference_level_db = statistics.interference.value;
  message.acquisition_probability = statistics.acquisition_probability;
  message.success_probability = statistics.success_probability;
  message.acquisition_draw = statistics.acquisition_draw;
  message.success_draw = statistics.success_draw;
  message.num_colliders = static_cast<std::int32_t>(statistics.colliders.size());
  for (const PacketName& name : statistics.colliders) message.colliders.push_back(to_message(name));
}

std::string joined(std::initializer_list<std::int64_t> numbers) {
  std::string text;
  for (const std::int64_t number : numbers) text += (text.empty() ? "" : " ") + std::to_string(number);
  return text;
}

}  // namespace

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

packet_outcome_t to_outcome(const PacketOutcome& outcome, SimTime at) {
  auto message = common_fields<packet_outcome_t>(outcome, at);
  message.outcome = static_cast<std::int8_t>(outcome.kind);
  message.num_receivers = static_cast<std::int32_t>(outcome.receivers);
  message.duration_s = outcome.packet->timing.duration.seconds();
  message.range_m = outcome.budget.range_m;
  message.transmission_loss_db = outcome.budget.transmission_loss.value;
  message.noise_level_db = outcome.budget.noise_level.value;
  message.cutoff_level_db = outcome.cutoff.value;
  message.propagation_used = static_cast<std::int8_t>(outcome.propagation);
  message.num_paths = static_cast<std::int32_t>(outcome.path_count);
  message.delay_spread_s = outcome.delay_spread_s;
  message.arrival_azimuth_rad = outcome.arrival_azimuth_rad;
  message.arrival_elevation_rad = outcome.arrival_elevation_rad;
  set_statistics(outcome.statistics, message);
  message.transmit_energy_j = outcome.packet->energy_j;
  message.receive_energy_j = outcome.receive_energy_j;
  message.payload_bytes = static_cast<std::int32_t>(outcome.packet->request.payload.size());
  return message;
}

modem_energy_t to_message(const EnergyUse& use, SimTime at) {
  modem_energy_t message{};
  message.utime = at.to_utime();
  message.energy_cause = use.is_transmission ? modem_energy_t::TRANSMIT : modem_energy_t::RECEIVE;
  message.energy_j = use.energy_j;
  message.packet = to_message(use.packet);
  return message;
}

modem_receive_t to_receive(const PacketOutcome& outcome, SimTime at) {
  const SendRequest& request = outcome.packet->request;
  auto message = common_fields<modem_receive_t>(outcome, at);
  message.stamped = request.stamped ? 1 : 0;
  message.departure_utime = request.stamped ? outcome.departure_stamp.to_utime() : 0;
  message.travel_time_s = request.stamped ? outcome.measured_travel_time_s : 0;
  message.two_way_travel_time_s = outcome.two_way_travel_time_s;
  message.payload_size = static_cast<std::int32_t>(request.payload.size());
  message.payload = request.payload;
  return message;
}

// A sender that keeps no session may number anew: the instant distinguishes its packets.
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

std::string identity_of(const modem_energy_t& m) {
  return joined({m.energy_cause, m.packet.source_id, m.packet.send_session, m.packet.packet_sequence,
                 m.packet.packet_kind, m.packet.send_session == 0 ? m.utime : 0});
}

std::string identity_of(const ping_answer_t& m) {
  return joined({m.answering_id, m.ping_source_id, m.ping_session, m.ping_sequence, m.answer_start_ns});
}

}  // namespace halocline::channel_server
