// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/messages/packet_messages.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "acoustics/reception/disturbing_powers.h"
#include "core/units.h"

namespace halocline::channel_server {
namespace {

// Returns the bytes of payload in the frames of which `frames` has a bit.
std::int32_t bytes_in(const std::vector<std::int32_t>& frame_bytes, std::uint32_t frames) {
  std::int32_t bytes = 0;
  for (std::size_t i = 0; i < frame_bytes.size(); ++i) bytes += (frames >> i & 1u) != 0 ? frame_bytes[i] : 0;
  return bytes;
}

// Returns a message with the fields that OUTCOME and RECEIVE have in common.
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
  message.rate_number = outcome.packet->rate_number;
  message.departure_utime = outcome.packet->departure.to_utime();
  message.travel_time_s = outcome.travel_time_s;
  message.received_level_db = outcome.budget.received_level.value;
  message.snr_db = outcome.budget.snr.value;
  message.strongest_path_doppler_factor = outcome.doppler_factor;
  message.sinr_db = outcome.statistics.sinr.value;
  message.duration_s = outcome.packet->timing.duration.seconds();
  message.noise_level_db = outcome.budget.noise_level.value;
  message.num_frames = static_cast<std::int32_t>(outcome.packet->frame_bytes.size());
  message.frames_good = outcome.kind == OutcomeKind::kReceived ? outcome.statistics.frames_good : 0;
  message.bytes_good = bytes_in(outcome.packet->frame_bytes, static_cast<std::uint32_t>(message.frames_good));
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
  const acoustics::DisturbingPowers& powers = statistics.powers;
  message.noise_db = level_of(powers.noise).value;
  message.late_echo_db = level_of(powers.late_echoes).value;
  message.fast_fading_db = level_of(powers.fast_fading).value;
  message.interference_db = level_of(powers.others).value;
  message.impulse_db = level_of(powers.impulses).value;
  message.loss_reason = static_cast<std::int8_t>(statistics.reason);
  message.acquisition_probability = statistics.acquisition_probability;
  message.success_probability = statistics.success_probability;
  message.acquisition_draw = statistics.acquisition_draw;
  message.success_draw = statistics.success_draw;
  message.num_colliders = static_cast<std::int32_t>(statistics.colliders.size());
  for (const PacketName& name : statistics.colliders) message.colliders.push_back(to_message(name));
}

// Returns the payload with zeros in the frames that were not right.
std::vector<std::uint8_t> readable_payload(const Packet& packet, std::uint32_t frames_good) {
  std::vector<std::uint8_t> payload = packet.request.payload;
  auto frame = payload.begin();
  for (std::size_t i = 0; i < packet.frame_bytes.size(); ++i) {
    const auto end = frame + packet.frame_bytes[i];
    if ((frames_good >> i & 1u) == 0) std::fill(frame, end, std::uint8_t{0});
    frame = end;
  }
  return payload;
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
  request.wants_ack = message.wants_ack != 0;
  if (message.sets_rate != 0) request.rate_number = message.rate_number;
  if (message.sets_source_level != 0) request.source_level = Decibels{message.source_level_db};
  request.header_number = message.header_number;
  request.frame_bytes = message.frame_bytes;
  return request;
}

modem_reply_t to_message(const ModemReply& answer, SimTime at) {
  modem_reply_t message{};
  message.utime = at.to_utime();
  message.answering_vehicle = answer.request.vehicle;
  message.answering_id = answer.request.source_id;
  message.packet_kind = static_cast<std::int8_t>(answer.request.kind);
  message.asking_id = answer.request.destination_id;
  message.send_session = answer.request.session;
  message.packet_sequence = answer.request.packet_sequence;
  message.answer_start_ns = answer.request.start.nanoseconds();
  message.asked_departure_ns = answer.asked_departure.nanoseconds();
  message.asked_duration_ns = answer.asked_duration.nanoseconds();
  message.payload_size = static_cast<std::int32_t>(answer.request.payload.size());
  message.payload = answer.request.payload;
  return message;
}

ModemReply to_answer(const modem_reply_t& message) {
  ModemReply answer;
  answer.request.vehicle = message.answering_vehicle;
  answer.request.source_id = message.answering_id;
  answer.request.destination_id = message.asking_id;
  answer.request.session = message.send_session;
  answer.request.packet_sequence = message.packet_sequence;
  answer.request.start = SimTime::from_nanoseconds(message.answer_start_ns);
  answer.request.kind = static_cast<PacketKind>(message.packet_kind);
  answer.request.payload = message.payload;
  answer.request.stamped = false;
  answer.asked_departure = SimTime::from_nanoseconds(message.asked_departure_ns);
  answer.asked_duration = SimDuration::from_nanoseconds(message.asked_duration_ns);
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
  message.num_frames_good = std::popcount(static_cast<std::uint64_t>(message.frames_good));
  message.range_m = outcome.budget.range_m;
  message.transmission_loss_db = outcome.budget.transmission_loss.value;
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

modem_event_t to_message(const ModemEvent& event, SimTime at) {
  modem_event_t message{};
  message.utime = at.to_utime();
  message.event_ns = at.nanoseconds();
  message.modem_event = static_cast<std::int8_t>(event.kind);
  message.send_session = event.session;
  message.packet_sequence = event.packet_sequence;
  message.level_db = event.level.value;
  message.sinr_db = event.sinr.value;
  message.packet_outcome = static_cast<std::int8_t>(event.outcome);
  message.source_id = event.source_id;
  message.destination_id = event.destination_id;
  message.packet_duration_s = event.packet_duration.seconds();
  message.packet_end_utime = event.packet_end.to_utime();
  message.rate_number = event.rate_number;
  message.arrival_utime = event.measured_arrival.to_utime();
  return message;
}

modem_receive_t to_receive(const PacketOutcome& outcome, SimTime at) {
  const SendRequest& request = outcome.packet->request;
  auto message = common_fields<modem_receive_t>(outcome, at);
  message.header_number = request.header_number;
  message.stamped = request.stamped ? 1 : 0;
  message.departure_utime = request.stamped ? outcome.departure_stamp.to_utime() : 0;
  message.travel_time_s = request.stamped ? outcome.measured_travel_time_s : 0;
  // A vehicle that overhears an answer does not know when the packet that it answers left.
  if (request.destination_id == outcome.receiver_id)
    message.two_way_travel_time_s = outcome.two_way_travel_time_s;
  message.wants_ack = request.wants_ack && request.destination_id == outcome.receiver_id ? 1 : 0;
  message.arrival_utime =
      (outcome.departure_stamp + SimDuration::from_seconds(outcome.measured_travel_time_s)).to_utime();
  const PowerRatio sinr = to_power_ratio(outcome.statistics.sinr);
  message.snr_out_db = to_decibels(bit_energy(outcome.packet->modem, sinr)).value;
  message.mse_db = to_decibels(acoustics::least_mean_square_error(sinr)).value;
  message.frame_bytes = outcome.packet->frame_bytes;
  message.payload_size = static_cast<std::int32_t>(request.payload.size());
  message.payload = readable_payload(*outcome.packet, outcome.statistics.frames_good);
  return message;
}

// A sender without a session may use its sequence numbers again, so the instant distinguishes its packets.
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

std::string identity_of(const modem_event_t& m) { return joined({m.event_ns, m.modem_event}); }

std::string identity_of(const modem_energy_t& m) {
  return joined({m.energy_cause, m.packet.source_id, m.packet.send_session, m.packet.packet_sequence,
                 m.packet.packet_kind, m.packet.send_session == 0 ? m.utime : 0});
}

std::string identity_of(const modem_reply_t& m) {
  return joined(
      {m.answering_id, m.asking_id, m.packet_kind, m.send_session, m.packet_sequence, m.answer_start_ns});
}

}  // namespace halocline::channel_server
