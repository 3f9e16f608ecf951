// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/micromodem/micromodem_transmitter.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "core/names.h"

namespace halocline::modem_gateway {
namespace {

// Most frames that wait for a cycle, as many as the largest packet holds, and their largest size in bytes.
constexpr std::size_t kMaxFrames = 8, kLargestFrame = 256;
// Time after its end for which a packet's kind is remembered, so that answers can be matched to it.
constexpr SimDuration kRemembered = SimDuration::from_milliseconds(60'000);

MicromodemPacket type_of(MicromodemTransmitter::Kind kind, int rate) {
  switch (kind) {
    case MicromodemTransmitter::Kind::kData:
      return rate == 0 ? MicromodemPacket::kFsk : MicromodemPacket::kPsk;
    case MicromodemTransmitter::Kind::kFlexible:
    case MicromodemTransmitter::Kind::kFramed:
    case MicromodemTransmitter::Kind::kFramedMini:
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
  cycle_ = Cycle{.wanted = cycle, .to = to};
  if (!has_cycle_packet) return ask_for_data();
  const std::int64_t sequence =
      transmit({Kind::kCycle, to, cycle.destination, cycle_packet(cycle, std::nullopt)},
               mini_packet(MicromodemKind::kCycle));
  cycle_->announcement = sequence;
  if (sequence == kNotSent) cycle_.reset();
}

std::size_t MicromodemTransmitter::frame_size() const {
  return static_cast<std::size_t>(micromodem_rate(static_cast<int>(cycle_->wanted.rate)).frame_bytes);
}

void MicromodemTransmitter::ask_for_data() {
  while (!waiting_.empty()) {
    Frame frame = std::move(waiting_.front());
    waiting_.pop_front();
    if (frame.bytes.size() <= frame_size()) return take_data(std::move(frame.bytes), frame.wants_ack);
    core_.say_all(fmt::format("CAERR,{},DATA,{},frame too large for the cycle",
                              core_.clock().hhmmss(core_.reading()), frame.bytes.size()));
  }
  const MicromodemCycle& wanted = cycle_->wanted;
  cycle_->asked = core_.now();
  core_.say_all(fmt::format("CADRQ,{},{},{},{},{},{}", core_.clock().hhmmss(core_.reading()), wanted.source,
                            wanted.destination, wanted.wants_ack, frame_size(),
                            cycle_->frame_bytes.size() + 1));
}

bool MicromodemTransmitter::can_take(std::size_t bytes) const {
  if (cycle_ && !cycle_->announcement) return bytes <= frame_size();
  return bytes <= kLargestFrame && waiting_.size() < kMaxFrames;
}

void MicromodemTransmitter::take_data(std::vector<std::uint8_t> bytes, bool wants_ack) {
  if (!cycle_ || cycle_->announcement) {
    if (!bytes.empty()) waiting_.push_back({std::move(bytes), wants_ack});
    return;
  }
  if (bytes.empty()) return complete();
  cycle_->payload.insert(cycle_->payload.end(), bytes.begin(), bytes.end());
  cycle_->frame_bytes.push_back(static_cast<std::int32_t>(bytes.size()));
  cycle_->wants_ack = cycle_->wants_ack || wants_ack;
  if (static_cast<std::int64_t>(cycle_->frame_bytes.size()) < cycle_->wanted.frames) return ask_for_data();
  complete();
}

// Ends the gathering of data and transmits it, unless the host had none.
void MicromodemTransmitter::complete() {
  const Cycle cycle = *std::exchange(cycle_, std::nullopt);
  if (cycle.frame_bytes.empty()) return;
  transmit({Kind::kData, cycle.to, cycle.wanted.destination, cycle.payload},
           {.wants_ack = cycle.wants_ack && cycle.to != kBroadcastId,
            .rate_number = static_cast<std::int32_t>(cycle.wanted.rate),
            .frame_bytes = cycle.frame_bytes});
}

void MicromodemTransmitter::send(Transmission transmission, clients::SendOptions options) {
  transmit(std::move(transmission), std::move(options));
}

// Returns kNotSent when the modem cannot accept the packet, which is reported to the host.
std::int64_t MicromodemTransmitter::transmit(Transmission transmission, clients::SendOptions options) {
  OnItsWay sent;
  sent.report.rate = options.rate_number.value_or(0);
  sent.report.source = core_.own_address();
  sent.report.destination = static_cast<std::int32_t>(transmission.destination);
  sent.report.wants_ack = options.wants_ack;
  sent.report.frames_expected = sent.report.frames_sent =
      std::max<int>(1, static_cast<int>(options.frame_bytes.size()));
  sent.report.type = type_of(transmission.packet, sent.report.rate);
  sent.report.bytes = static_cast<int>(transmission.payload.size());
  const std::int64_t sequence = core_.port().send([&core = core_] { return core.start_of_transmission(); },
                                                  transmission.to, transmission.payload, std::move(options));
  if (sequence == kNotSent) {
    report_not_sent(sent.report);
    return sequence;
  }
  sent.transmission = std::move(transmission);
  sent_[sequence] = std::move(sent);
  return sequence;
}

std::optional<MicromodemTransmitter::Kind> MicromodemTransmitter::sent_as(
    std::int64_t packet_sequence) const {
  const auto found = sent_.find(packet_sequence);
  return found == sent_.end() ? std::nullopt : std::optional(found->second.transmission.packet);
}

// Asks the host for the data once the cycle packet has ended. If it could not be sent, the cycle is dropped.
void MicromodemTransmitter::end_announcement(std::int64_t sequence, bool was_sent) {
  if (!cycle_ || cycle_->announcement != sequence) return;
  if (!was_sent) return cycle_.reset();
  cycle_->announcement.reset();
  ask_for_data();
}

// Reports with CAXST that nothing was sent, or with an error to a host that receives no CAXST.
void MicromodemTransmitter::report_not_sent(TransmissionReport report) const {
  report.mode = TransmissionReport::Mode::kInhibited;
  report.frames_sent = 0;
  report.at = core_.reading();
  core_.say_all(core_.reports_transmissions()
                    ? caxst(core_.state(), report)
                    : fmt::format("CAERR,{},XMIT,{},not sent", core_.clock().hhmmss(core_.reading()),
                                  static_cast<int>(report.mode)));
}

void MicromodemTransmitter::on_receipt(const modem_receipt_t& receipt) {
  const auto found = sent_.find(receipt.packet_sequence);
  if (found == sent_.end()) return;
  OnItsWay& sent = found->second;
  if (!is_accepted(receipt)) {
    core_.port().note("send-refused", "result=" + std::to_string(receipt.receipt_result));
    report_not_sent(sent.report);
    end_announcement(found->first, false);
    sent_.erase(found);
    return;
  }
  sent.begins = SimTime::from_utime(receipt.start_utime);
  sent.ends = sent.begins + SimDuration::from_seconds(receipt.duration_s);
  sent.forgotten = sent.ends + kRemembered;
}

SimTime MicromodemTransmitter::data_due() const {
  if (!cycle_ || cycle_->asked == SimTime::never()) return SimTime::never();
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
  for (auto it = sent_.begin(); it != sent_.end();)
    it = advance(it->first, it->second) ? ++it : sent_.erase(it);
}

// Reports to hosts what has happened to the packet by now. Returns false when it may be forgotten.
bool MicromodemTransmitter::advance(std::int64_t sequence, OnItsWay& sent) {
  const SimTime now = core_.now();
  if (now >= sent.begins) {
    sent.report.at = core_.port().clock_at(std::exchange(sent.begins, SimTime::never()));
    core_.say_all(fmt::format("CATXP,{}", sent.report.bytes));
  }
  if (now >= sent.ends) {
    sent.ends = SimTime::never();
    core_.say_all(fmt::format("CATXF,{}", sent.report.bytes));
    if (core_.reports_transmissions()) core_.say_all(caxst(core_.state(), sent.report));
    end_announcement(sequence, true);
  }
  return now < sent.forgotten;
}

}  // namespace halocline::modem_gateway
