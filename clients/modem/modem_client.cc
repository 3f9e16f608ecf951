// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem/modem_client.h"

#include <algorithm>
#include <bit>

#include "bus/messages/message_checks.h"
#include "core/check.h"
#include "core/names.h"

namespace halocline::clients {

bool is_whole(const modem_receive_t& packet) {
  return packet.num_frames == 0 ||
         std::popcount(static_cast<std::uint64_t>(packet.frames_good)) == packet.num_frames;
}

ModemClient::ModemClient(bus::Bus& bus, ModemAddress address, ResendPolicy policy, bus::Wakeup wakeup)
    : bus_(bus), address_(std::move(address)), policy_(policy) {
  require(is_valid_name(address_.vehicle),
          "vehicle name '" + address_.vehicle + "'; allowed is a name of " + std::string(kNameRule));
  require(address_.vehicle_id >= 1, "a vehicle's id is a whole number from 1");
  require(policy_.interval > SimDuration(), "the interval between repetitions must be above 0");
  bus_.subscribe<modem_receipt_t>(
      bus::channels::kReceipt.of(address_.vehicle),
      [this](const modem_receipt_t& receipt) { take_receipt(receipt); }, wakeup);
  bus_.subscribe<modem_receive_t>(
      bus::channels::kReceive.of(address_.vehicle),
      [this](const modem_receive_t& packet) { take_packet(packet); }, wakeup);
}

void ModemClient::on_event(EventHandler handler) {
  bus_.subscribe<modem_event_t>(bus::channels::kModemEvent.of(address_.vehicle), std::move(handler));
}

void ModemClient::listen(SimTime from, const ListenOptions& options) {
  require(options.carrier_threshold_db >= 0 && options.carrier_threshold_db <= 100,
          "the threshold of the carrier is 0 to 100 dB above the noise");
  ++changes_;
  modem_listen_t message{};
  message.utime = from.to_utime();
  message.session = address_.session;
  message.sequence = next_listen_++;
  message.asleep = options.asleep ? 1 : 0;
  message.wake_utime = options.wakes.to_utime();
  message.promiscuous = options.promiscuous ? 1 : 0;
  message.events = options.events ? 1 : 0;
  message.carrier_threshold_db = options.carrier_threshold_db;
  bus_.publish(bus::channels::kListen.of(address_.vehicle), message);
}

modem_send_t ModemClient::message_of(std::int32_t destination, std::span<const std::uint8_t> payload,
                                     SendOptions options) const {
  modem_send_t message{};
  message.session = address_.session;
  message.packet_sequence = next_sequence_;
  message.source_id = address_.vehicle_id;
  message.destination_id = destination;
  message.packet_kind = options.kind;
  message.stamped = options.stamped ? 1 : 0;
  message.wants_ack = options.wants_ack ? 1 : 0;
  message.sets_rate = options.rate_number ? 1 : 0;
  message.rate_number = options.rate_number.value_or(0);
  message.sets_source_level = options.source_level_db ? 1 : 0;
  message.source_level_db = options.source_level_db.value_or(0);
  message.header_number = options.header_number;
  message.frame_bytes = std::move(options.frame_bytes);
  message.num_frames = static_cast<std::int32_t>(message.frame_bytes.size());
  message.payload_size = static_cast<std::int32_t>(payload.size());
  message.payload.assign(payload.begin(), payload.end());
  return message;
}

std::string ModemClient::problem_with(std::int32_t destination, std::span<const std::uint8_t> payload,
                                      const SendOptions& options) const {
  return bus::problem_in(message_of(destination, payload, options));
}

std::int64_t ModemClient::send(SimTime steady, SimTime start, std::int32_t destination,
                               std::span<const std::uint8_t> payload, SendOptions options) {
  modem_send_t message = message_of(destination, payload, std::move(options));
  message.utime = start.to_utime();
  const std::string problem = bus::problem_in(message);
  require(problem.empty(), "no packet of this modem: " + problem);
  ++next_sequence_;
  ++changes_;
  // Stored before it is published: on memq the receipt may be dispatched before publish() returns.
  pending_[message.packet_sequence] = {message, steady + policy_.interval, steady + policy_.expire_after};
  ++counters_.sent;
  bus_.publish(bus::channels::kSend.of(address_.vehicle), message);
  return message.packet_sequence;
}

std::optional<modem_receipt_t> ModemClient::receipt_of(std::int64_t packet_sequence) const {
  const auto found = receipts_.find(packet_sequence);
  return found == receipts_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<modem_receive_t> ModemClient::take_received() {
  if (waiting_.empty()) return std::nullopt;
  ++changes_;
  modem_receive_t packet = std::move(waiting_.front());
  waiting_.pop_front();
  return packet;
}

std::optional<modem_receive_t> ModemClient::take_answer(std::int64_t packet_sequence, std::int8_t kind) {
  const auto found = std::find_if(waiting_.begin(), waiting_.end(), [&](const modem_receive_t& packet) {
    return packet.packet_kind == kind && packet.send_session == address_.session &&
           packet.packet_sequence == packet_sequence;
  });
  if (found == waiting_.end()) return std::nullopt;
  ++changes_;
  modem_receive_t answer = std::move(*found);
  waiting_.erase(found);
  return answer;
}

std::optional<double> ModemClient::take_ping_reply(std::int64_t packet_sequence) {
  const auto reply = take_answer(packet_sequence, modem_receive_t::PING_REPLY);
  return reply ? std::optional(reply->two_way_travel_time_s) : std::nullopt;
}

std::optional<std::uint32_t> ModemClient::take_ack(std::int64_t packet_sequence) {
  const auto ack = take_answer(packet_sequence, modem_receive_t::ACK);
  if (!ack) return std::nullopt;
  std::uint32_t frames_good = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(ack->payload.size(), 4); ++i)
    frames_good |= static_cast<std::uint32_t>(ack->payload[i]) << 8 * i;
  return frames_good;
}

void ModemClient::resend(SimTime steady) {
  for (auto it = pending_.begin(); it != pending_.end();) {
    Pending& pending = it->second;
    if (steady >= pending.last_try) {
      ++changes_;
      ++counters_.unanswered;
      it = pending_.erase(it);
      continue;
    }
    if (steady >= pending.next_try) {
      pending.next_try = steady + policy_.interval;
      ++changes_;
      ++counters_.resent;
      bus_.publish(bus::channels::kSend.of(address_.vehicle), pending.message);
    }
    ++it;
  }
}

SimTime ModemClient::next_resend() const {
  SimTime next = SimTime::never();
  for (const auto& [sequence, pending] : pending_)
    next = std::min({next, pending.next_try, pending.last_try});
  return next;
}

void ModemClient::archive(Archive& a) {
  a(next_sequence_, next_listen_, counters_, pending_, receipts_, waiting_, known_);
  if (!a.is_loading()) return;
  for (auto& [sequence, pending] : pending_) {
    pending.next_try = SimTime();
    pending.last_try = SimTime() + policy_.expire_after;
  }
}

void ModemClient::take_receipt(const modem_receipt_t& receipt) {
  // A receipt for a packet that is not pending answers an earlier session, or a repetition.
  if (receipt.send_session != address_.session || pending_.erase(receipt.packet_sequence) == 0) return;
  ++changes_;
  const bool accepted = receipt.receipt_result == modem_receipt_t::ACCEPTED ||
                        receipt.receipt_result == modem_receipt_t::QUEUED;
  ++(accepted ? counters_.accepted : counters_.refused);
  receipts_[receipt.packet_sequence] = receipt;
  if (receipts_.size() > kMaxReceipts) receipts_.erase(receipts_.begin());
  if (receipt_handler_) receipt_handler_(receipt);
}

void ModemClient::take_packet(const modem_receive_t& packet) {
  ++changes_;
  if (!is_new({packet.send_session, packet.source_id, packet.packet_kind, packet.packet_sequence})) {
    ++counters_.duplicates;
    return;
  }
  ++counters_.received;
  if (packet.packet_kind == modem_receive_t::ACK && packet.destination_id == address_.vehicle_id)
    ++counters_.acknowledged;  // does not count overheard ones
  if (receive_handler_) return receive_handler_(packet);
  waiting_.push_back(packet);
  if (waiting_.size() > kMaxWaiting) {
    waiting_.pop_front();
    ++counters_.discarded;
  }
}

bool ModemClient::is_new(const PacketName& packet) {
  if (std::find(known_.rbegin(), known_.rend(), packet) != known_.rend()) return false;
  known_.push_back(packet);
  if (known_.size() > kMaxRemembered) known_.pop_front();
  return true;
}

}  // namespace halocline::clients
