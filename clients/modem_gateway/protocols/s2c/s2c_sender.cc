// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/s2c/s2c_sender.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "clients/modem_gateway/protocols/fields.h"
#include "clients/modem_gateway/protocols/s2c/s2c_messages.h"
#include "core/names.h"

namespace halocline::modem_gateway {
namespace {

// Time after which a burst that found the modem busy is tried again.
constexpr SimDuration kBusyWait = SimDuration::from_milliseconds(200);
// Delay of a piggy-back message: the channel's turnaround and an acknowledgement of one byte
// (docs/packets.md; models/modems/s2c-im.toml), with a margin.
constexpr SimDuration kAfterAck = SimDuration::from_milliseconds(100 + 173 + 27);
constexpr std::size_t kMaxInstant = 64;
// Longer than the longest packet: a burst of 1024 bytes takes 1.4 s.
constexpr SimDuration kLongestPacket = SimDuration::from_milliseconds(5000);

const char* name_of(S2cMessage::Type type) {
  switch (type) {
    case S2cMessage::Type::kSynchronous:
      return "IMS";
    case S2cMessage::Type::kPiggyBack:
      return "PBM";
    case S2cMessage::Type::kBurst:
      return "BURST";
    default:
      return "IM";
  }
}

std::string lower_name_of(S2cMessage::Type type) {
  std::string name = name_of(type);
  for (char& letter : name) letter = static_cast<char>(letter - 'A' + 'a');
  return name;
}

S2cMessage::Type type_of(const std::string& command) {
  if (command == "*SENDIMS") return S2cMessage::Type::kSynchronous;
  if (command == "*SENDPBM") return S2cMessage::Type::kPiggyBack;
  return command == "*SEND" ? S2cMessage::Type::kBurst : S2cMessage::Type::kInstant;
}

// Reads the last field: the flag of an instant message, the time of a synchronous one. Returns "" or an
// error.
std::string take_last_field(const S2cCore& core, const S2cCommand& command, S2cMessage& message) {
  const std::string& last = command.fields.back();
  switch (message.type) {
    case S2cMessage::Type::kInstant:
      if (last != "ack" && last != "noack" && last != "force") return "ERROR WRONG FORMAT";
      message.wants_ack = last == "ack" && !core.is_broadcast(message.address);
      if (last == "force") message.payload.kind = S2cKind::kForced;
      return "";
    case S2cMessage::Type::kSynchronous: {
      message.payload.kind = S2cKind::kSynchronous;
      if (last.empty()) return "";
      const auto at = integer_in(last, 0, UINT32_MAX);
      if (at) message.at_us = static_cast<std::uint32_t>(*at);
      return at ? "" : "ERROR WRONG FORMAT";
    }
    case S2cMessage::Type::kPiggyBack:
      message.payload.kind = S2cKind::kPiggyBack;
      return "";
    case S2cMessage::Type::kBurst:
      break;
  }
  return "";
}

}  // namespace

// The fields are [pP,]length,destination and then the flag of an instant message or the time of a synchronous
// one.
std::string S2cSender::take(const S2cCommand& command) {
  S2cMessage message;
  message.type = type_of(command.name);
  std::size_t at = 0;
  if (command.fields[0].starts_with('p')) {
    const auto protocol = integer_in(std::string_view(command.fields[at++]).substr(1), 0, 7);
    if (!protocol) return "ERROR PROTOCOL ID";
    message.payload.protocol = static_cast<int>(*protocol);
  }
  const auto address = integer_in(command.fields[at + 1], 1, 255);
  const bool is_reachable = address && *address != core_.own_address() &&
                            (*address <= core_.setting("!AM") || core_.is_broadcast(*address));
  if (!is_reachable) return "ERROR WRONG DESTINATION ADDRESS";
  message.address = static_cast<std::int32_t>(*address);
  message.payload.bytes = as_bytes(command.data);
  message.wants_ack = message.type == S2cMessage::Type::kBurst && !core_.is_broadcast(message.address);
  const std::string problem = take_last_field(core_, command, message);
  return problem.empty() ? take(std::move(message)) : problem;
}

std::string S2cSender::take(S2cMessage message) {
  if (message.type == S2cMessage::Type::kBurst) {
    if (bursts_.size() >= kMaxBursts) return "ERROR BUFFER FULL";
    bursts_.push_back(std::move(message));
    if (!burst_) burst_due_ = std::min(burst_due_, core_.now());
    return "OK";
  }
  if (message.payload.bytes.size() > kMaxInstant) return "ERROR WRONG FORMAT";
  if (message.type == S2cMessage::Type::kPiggyBack) {
    if (waiting_piggy_back_) return "BUSY DELIVERING MESSAGE";
    waiting_piggy_back_ = std::move(message);
    return "OK";
  }
  if (instant_) return "BUSY DELIVERING MESSAGE";
  const SimTime start = message.at_us ? core_.time_of(*message.at_us) : core_.now();
  if (start > core_.now() + kMaxAhead) return "ERROR OUT OF RANGE";
  begin(instant_, std::move(message), start);
  return "OK";
}

void S2cSender::clear() {
  bursts_.clear();
  waiting_piggy_back_.reset();
  instant_.reset();
  burst_.reset();
  piggy_back_.reset();
  burst_due_ = SimTime::never();
}

void S2cSender::begin(std::optional<OnItsWay>& place, S2cMessage message, SimTime start) {
  const bool is_burst = message.type == S2cMessage::Type::kBurst;
  place = OnItsWay{std::move(message), kNotSent, core_.setting(is_burst ? "!RC" : "!RI"), start};
  OnItsWay& sent = *place;
  if (sent.message.wants_ack) sent.message.payload.number = next_number(is_burst, sent.message.address);
  if (start >= core_.now() &&
      (!is_receiving() || is_burst || sent.message.payload.kind == S2cKind::kForced || start > core_.now()))
    return transmit(sent);
  // A failure is reported by step(), so that it follows the answer to the command.
  sent.until = core_.now();
}

int S2cSender::next_number(bool is_burst, std::int32_t address) {
  int& number = numbers_[{is_burst, address}];
  number = number % 7 + 1;
  return number;
}

void S2cSender::transmit(OnItsWay& sent) {
  const S2cMessage& message = sent.message;
  const bool is_burst = message.type == S2cMessage::Type::kBurst;
  const std::int32_t to = core_.vehicle_of(message.address);
  sent.sequence = core_.port().send(sent.start, to, message.payload.bytes,
                                    {.wants_ack = message.wants_ack && to != kBroadcastId,
                                     .rate_number = is_burst ? kS2cBurstRate : kS2cImRate,
                                     .header_number = message.payload.header_number()});
  sent.ends = SimTime::never();
  sent.until = sent.sequence == kNotSent ? core_.now() : SimTime::never();
}

std::optional<S2cSender::OnItsWay>* S2cSender::place_of(std::int64_t sequence) {
  for (auto* place : {&instant_, &burst_, &piggy_back_}) {
    if (*place && (*place)->sequence == sequence) return place;
  }
  return nullptr;
}

void S2cSender::on_receipt(const modem_receipt_t& receipt) {
  auto* place = place_of(receipt.packet_sequence);
  if (place == nullptr) return;
  if (is_accepted(receipt)) return on_sent(**place, receipt);
  core_.port().note("send-refused", "result=" + std::to_string(receipt.receipt_result));
  cancel(*place);
}

void S2cSender::on_sent(OnItsWay& sent, const modem_receipt_t& receipt) {
  const auto duration_us = std::llround(receipt.duration_s * 1e6);
  sent.start = SimTime::from_utime(receipt.start_utime);
  sent.ends = sent.start + SimDuration::from_seconds(receipt.duration_s);
  sent.until = SimTime::never();
  core_.tell_more(fmt::format("SENDSTART,{},{},{},{}", sent.message.address, lower_name_of(sent.message.type),
                              duration_us,
                              std::max<std::int64_t>(0, receipt.start_utime - core_.now().to_utime())));
}

// Reports that a message was not sent.
void S2cSender::cancel(std::optional<OnItsWay>& place) {
  const S2cMessage& message = place->message;
  if (message.type == S2cMessage::Type::kBurst) return finish(place, false);
  const bool is_late = message.type == S2cMessage::Type::kSynchronous && place->start < core_.now();
  core_.tell(
      fmt::format("{}{},{}", is_late ? "EXPIRED" : "CANCELED", name_of(message.type), message.address));
  place.reset();
}

void S2cSender::on_ack(const modem_receive_t& ack) {
  auto* place = place_of(ack.packet_sequence);
  const bool is_good = !ack.payload.empty() && (ack.payload[0] & 1) != 0;
  if (place == nullptr || !is_good) return;
  note_propagation(ack.two_way_travel_time_s / 2);
  // RECVSRV contains the time at which the acknowledgement was decoded and the time at which its message
  // left.
  const S2cQuality q = quality_of(core_, ack);
  const std::uint32_t arrival_us = S2cCore::clock_us(SimTime::from_utime(ack.arrival_utime));
  core_.tell_more(fmt::format("RECVSRV,{},{},ack,{},{},{},{}", core_.address_of(ack.source_id),
                              core_.own_address(), arrival_us + static_cast<std::uint32_t>(q.duration_us),
                              S2cCore::clock_us(core_.port().clock_at((*place)->start)), q.rssi,
                              q.integrity));
  finish(*place, true);
}

void S2cSender::note_propagation(double one_way_s) { propagation_us_ = std::llround(one_way_s * 1e6); }

void S2cSender::on_event(const modem_event_t& event) {
  if (event.modem_event == modem_event_t::PACKET_DETECTED) receiving_until_ = core_.now() + kLongestPacket;
  if (event.modem_event == modem_event_t::PACKET_ENDED) receiving_until_ = core_.now();
}

void S2cSender::on_acknowledged(const modem_receive_t& packet) {
  const bool has_one = waiting_piggy_back_ && !piggy_back_ &&
                       core_.vehicle_of(waiting_piggy_back_->address) == packet.source_id;
  if (!has_one) return;
  begin(piggy_back_, *std::exchange(waiting_piggy_back_, std::nullopt), core_.now() + kAfterAck);
}

// `delivered`: the message was acknowledged, or was sent and wants no acknowledgement.
void S2cSender::finish(std::optional<OnItsWay>& place, bool delivered) {
  const S2cMessage message = std::exchange(place, std::nullopt)->message;
  if (message.type == S2cMessage::Type::kBurst) {
    core_.tell(fmt::format("{},{},{}", delivered ? "DELIVERED" : "FAILED", ++bursts_done_, message.address));
    burst_due_ = bursts_.empty() ? SimTime::never() : core_.now();
  } else if (message.wants_ack) {
    core_.tell(
        fmt::format("{}{},{}", delivered ? "DELIVERED" : "FAILED", name_of(message.type), message.address));
  }
}

void S2cSender::next_burst() {
  burst_due_ = SimTime::never();
  if (burst_ || bursts_.empty()) return;
  if (is_receiving() || instant_) {
    burst_due_ = core_.now() + kBusyWait;
    return;
  }
  S2cMessage message = std::move(bursts_.front());
  bursts_.pop_front();
  begin(burst_, std::move(message), core_.now());
}

SimTime S2cSender::next() const {
  SimTime next = burst_due_;
  for (const auto* place : {&instant_, &burst_, &piggy_back_}) {
    if (*place) next = std::min({next, (*place)->ends, (*place)->until});
  }
  return next;
}

void S2cSender::step() {
  for (auto* place : {&instant_, &burst_, &piggy_back_}) {
    if (*place) step(*place);
  }
  if (core_.now() >= burst_due_) next_burst();
}

void S2cSender::step(std::optional<OnItsWay>& place) {
  OnItsWay& sent = *place;
  const SimTime now = core_.now();
  const S2cMessage& message = sent.message;
  if (now >= sent.ends) {
    core_.tell_more(
        fmt::format("SENDEND,{},{},{},{}", message.address, lower_name_of(message.type),
                    S2cCore::clock_us(core_.port().clock_at(sent.start)),
                    std::llround((std::exchange(sent.ends, SimTime::never()) - sent.start).seconds() * 1e6)));
    if (!message.wants_ack) return finish(place, true);
    sent.until = now + SimDuration::from_milliseconds(core_.setting("!RT"));
  }
  if (now < sent.until) return;
  if (sent.sequence == kNotSent) return cancel(place);  // too late, or prevented by a reception
  if (sent.tries_left-- <= 0 || !message.wants_ack) return finish(place, false);
  sent.start = now;
  transmit(sent);
}

}  // namespace halocline::modem_gateway
