// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/send_queue.h"

#include <utility>

namespace halocline::modem_gateway {
namespace {

// Pause before a packet that a busy modem refused is sent again, and the time for which that is repeated.
constexpr SimDuration kBusyWait = SimDuration::from_milliseconds(100);
constexpr SimDuration kMaxBusy = SimDuration::from_milliseconds(30'000);
// Most packets whose numbers are kept because answers may still arrive.
constexpr std::size_t kMaxNumbers = 256;

// Rounds up to whole microseconds, the resolution of time on the bus: a packet must not start before it was
// asked for.
SimTime whole_microsecond_from(SimTime time) {
  return SimTime::from_utime((time + SimDuration::from_nanoseconds(499)).to_utime());
}

}  // namespace

std::int64_t SendQueue::add(Packet packet, const bus::Now& now) {
  packets_.push_back({next_number_, std::move(packet)});
  if (packets_.size() == 1) {
    due_ = now.sim;
    if (now.sim_known) transmit(now);
  }
  return next_number_++;
}

void SendQueue::transmit(const bus::Now& now) {
  const Numbered& first = packets_.front();
  const Packet& packet = first.packet;
  due_ = ends_ = SimTime::never();
  sequence_ = modem_.send(now.steady, whole_microsecond_from(std::max(packet.start(), now.sim)),
                          packet.destination, packet.payload, packet.options);
  numbers_[*sequence_] = first.number;
  if (numbers_.size() > kMaxNumbers) numbers_.erase(numbers_.begin());
}

std::optional<modem_receipt_t> SendQueue::take(const modem_receipt_t& receipt, const bus::Now& now) {
  if (receipt.packet_sequence != sequence_) return std::nullopt;
  sequence_.reset();
  Numbered& first = packets_.front();
  if (receipt.receipt_result == modem_receipt_t::REFUSED_BUSY && now.sim < first.expires) {
    first.expires = std::min(first.expires, now.sim + kMaxBusy);
    due_ = now.sim + kBusyWait;
    return std::nullopt;
  }
  modem_receipt_t numbered = receipt;
  numbered.packet_sequence = first.number;
  if (is_accepted(receipt))
    ends_ = SimTime::from_utime(receipt.start_utime) + SimDuration::from_seconds(receipt.duration_s);
  else
    remove_first(now.sim);
  return numbered;
}

std::int64_t SendQueue::number_of(std::int64_t packet_sequence) const {
  const auto found = numbers_.find(packet_sequence);
  return found == numbers_.end() ? kForgotten : found->second;
}

void SendQueue::remove_first(SimTime now) {
  packets_.pop_front();
  sequence_.reset();
  ends_ = SimTime::never();
  due_ = packets_.empty() ? SimTime::never() : now;
}

// Returns true when the modem library has stopped repeating its SEND without having received an answer.
bool SendQueue::has_expired() const {
  return sequence_ && !modem_.is_pending(*sequence_) && !modem_.receipt_of(*sequence_);
}

std::optional<modem_receipt_t> SendQueue::step(const bus::Now& now) {
  std::optional<modem_receipt_t> refusal;
  if (has_expired()) {
    refusal.emplace();
    refusal->utime = now.sim.to_utime();
    refusal->send_session = modem_.address().session;
    refusal->packet_sequence = packets_.front().number;
    refusal->receipt_result = modem_receipt_t::REFUSED_NO_MODEM;
    remove_first(now.sim);
  }
  if (!now.sim_known) return refusal;
  if (now.sim >= ends_) remove_first(now.sim);
  if (now.sim >= due_) transmit(now);
  return refusal;
}

void SendQueue::clear() {
  packets_.clear();
  numbers_.clear();
  sequence_.reset();
  due_ = ends_ = SimTime::never();
}

}  // namespace halocline::modem_gateway
