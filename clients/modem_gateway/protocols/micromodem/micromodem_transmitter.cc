#include "clients/modem_gateway/protocols/micromodem/micromodem_transmitter.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "core/names.h"

namespace halocline::modem_gateway {
namespace {

// Between a cycle packet and its data.
constexpr SimDuration kGap = SimDuration::from_milliseconds(50);
// How long the kind of a packet is known, for its answer.
constexpr SimDuration kRemembered = SimDuration::from_milliseconds(60'000);

MicromodemPacket type_of(MicromodemTransmitter::Kind kind, int rate) {
  switch (kind) {
    case MicromodemTransmitter::Kind::kData:
      return rate == 0 ? MicromodemPacket::kFsk : MicromodemPacket::kPsk;
    case MicromodemTransmitter::Kind::kFlexible:
      return MicromodemPacket::kFlexible;
    default:
      return rate == 0 ? MicromodemPacket::kFskMini : MicromodemPacket::kPskMini;
  }
}

}  // namespace

clients::SendOptions mini_packet(MicromodemKind kind) {
  return {.kind = modem_send_t::MINI_PACKET, .rate_number = 0, .header_number = static_cast<int>(kind)};
}

void MicromodemTransmitter::begin(const MicromodemCycle& cycle, std::int32_t to, bool has_cycle_packet) {
  cycle_ = Cycle{cycle, to, has_cycle_packet, {}, {}, false, false, {}};
  ask_for_data();
}

void MicromodemTransmitter::ask_for_data() {
  const MicromodemCycle& wanted = cycle_->wanted;
  cycle_->asked = core_.now();
  core_.say_all(fmt::format("CADRQ,{},{},{},{},{},{}", core_.clock().hhmmss(core_.reading()), wanted.source,
                            wanted.destination, wanted.wants_ack,
                            micromodem_rate(static_cast<int>(wanted.rate)).frame_bytes,
                            cycle_->frame_bytes.size() + 1));
}

bool MicromodemTransmitter::wants_data(std::size_t bytes) const {
  return cycle_ && !cycle_->is_complete &&
         bytes <=
             static_cast<std::size_t>(micromodem_rate(static_cast<int>(cycle_->wanted.rate)).frame_bytes);
}

void MicromodemTransmitter::take_data(const std::vector<std::uint8_t>& bytes, bool wants_ack) {
  if (bytes.empty()) return complete();
  cycle_->payload.insert(cycle_->payload.end(), bytes.begin(), bytes.end());
  cycle_->frame_bytes.push_back(static_cast<std::int32_t>(bytes.size()));
  cycle_->wants_ack = cycle_->wants_ack || wants_ack;
  if (static_cast<std::int64_t>(cycle_->frame_bytes.size()) < cycle_->wanted.frames) return ask_for_data();
  complete();
}

// All data is there: transmits, or where the host had none is done.
void MicromodemTransmitter::complete() {
  cycle_->is_complete = true;
  if (cycle_->frame_bytes.empty()) return cycle_.reset();
  if (!cycle_->has_cycle_packet) return send_data(core_.start_of_transmission());
  MicromodemCycle announced = cycle_->wanted;
  announced.frames = static_cast<std::int64_t>(cycle_->frame_bytes.size());
  send({Kind::kCycle, cycle_->to, announced.destination, cycle_packet(announced, false)},
       mini_packet(MicromodemKind::kCycle));
}

void MicromodemTransmitter::send_data(SimTime start) {
  const Cycle cycle = *std::exchange(cycle_, std::nullopt);
  send_at(start, {Kind::kData, cycle.to, cycle.wanted.destination, cycle.payload},
          {.wants_ack = cycle.wants_ack && cycle.to != kBroadcastId,
           .rate_number = static_cast<std::int32_t>(cycle.wanted.rate),
           .frame_bytes = cycle.frame_bytes});
}

void MicromodemTransmitter::send(Transmission transmission, clients::SendOptions options) {
  send_at(core_.start_of_transmission(), std::move(transmission), std::move(options));
}

void MicromodemTransmitter::send_at(SimTime start, Transmission transmission, clients::SendOptions options) {
  OnItsWay sent;
  sent.report.rate = options.rate_number.value_or(0);
  sent.report.source = core_.own_address();
  sent.report.destination = static_cast<std::int32_t>(transmission.destination);
  sent.report.wants_ack = options.wants_ack;
  sent.report.frames_expected = sent.report.frames_sent =
      std::max<int>(1, static_cast<int>(options.frame_bytes.size()));
  sent.report.type = type_of(transmission.packet, sent.report.rate);
  sent.report.bytes = static_cast<int>(transmission.payload.size());
  const std::int64_t sequence =
      core_.port().send(start, transmission.to, transmission.payload, std::move(options));
  sent.transmission = std::move(transmission);
  sent.forgotten = start + kRemembered;
  sent_[sequence] = std::move(sent);
}

bool MicromodemTransmitter::is_new_ping(std::int64_t packet_sequence) const {
  const auto found = sent_.find(packet_sequence);
  return found != sent_.end() && found->second.transmission.packet == Kind::kNewPing;
}

void MicromodemTransmitter::on_receipt(const modem_receipt_t& receipt) {
  const auto found = sent_.find(receipt.packet_sequence);
  if (found == sent_.end()) return;
  OnItsWay& sent = found->second;
  sent.has_receipt = true;
  sent.is_accepted = receipt.receipt_result == modem_receipt_t::ACCEPTED ||
                     receipt.receipt_result == modem_receipt_t::QUEUED;
  sent.begins = sent.is_accepted ? SimTime::from_utime(receipt.start_utime) : core_.now();
  sent.ends = sent.begins + SimDuration::from_seconds(receipt.duration_s);
  if (!sent.is_accepted) {
    sent.report.mode = TransmissionReport::Mode::kInhibited;
    sent.report.frames_sent = 0;
    core_.port().note("send-refused", "result=" + std::to_string(receipt.receipt_result));
  }
  const bool announces = sent.transmission.packet == Kind::kCycle && cycle_ && cycle_->is_complete;
  if (announces && sent.is_accepted) send_data(sent.ends + kGap);
  if (announces && !sent.is_accepted) cycle_.reset();
}

SimTime MicromodemTransmitter::data_due() const {
  if (!cycle_ || cycle_->is_complete) return SimTime::never();
  const std::int64_t timeout_s = std::clamp<std::int64_t>(core_.settings().number("DTO"), 1, 3600);
  return cycle_->asked + SimDuration::from_milliseconds(1000) * timeout_s;
}

SimTime MicromodemTransmitter::next() const {
  SimTime next = data_due();
  for (const auto& [sequence, sent] : sent_) next = std::min({next, sent.begins, sent.ends, sent.forgotten});
  return next;
}

void MicromodemTransmitter::step() {
  if (core_.now() >= data_due()) {
    core_.say_all(fmt::format("CAERR,{},DATA_TIMEOUT,{}", core_.clock().hhmmss(core_.reading()),
                              cycle_->frame_bytes.size() + 1));
    cycle_.reset();
  }
  for (auto it = sent_.begin(); it != sent_.end();) {
    if (advance(it->second)) {
      ++it;
      continue;
    }
    // A cycle packet that had no receipt: nothing came of the cycle.
    const bool is_unanswered = it->second.transmission.packet == Kind::kCycle && !it->second.has_receipt;
    if (is_unanswered && cycle_ && cycle_->is_complete) cycle_.reset();
    it = sent_.erase(it);
  }
}

// Writes what has happened to it by now; false when it may be forgotten.
bool MicromodemTransmitter::advance(OnItsWay& sent) {
  const SimTime now = core_.now();
  if (now >= sent.begins) {
    sent.report.at = core_.port().clock_at(std::exchange(sent.begins, SimTime::never()));
    if (sent.is_accepted) core_.say_all(fmt::format("CATXP,{}", sent.report.bytes));
  }
  if (now >= sent.ends) {
    sent.ends = SimTime::never();
    if (sent.is_accepted) core_.say_all(fmt::format("CATXF,{}", sent.report.bytes));
    if (core_.reports_transmissions()) core_.say_all(caxst(core_.state(), sent.report));
  }
  return now < sent.forgotten;
}

}  // namespace halocline::modem_gateway
