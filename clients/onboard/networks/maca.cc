// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/networks/maca.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/names.h"

namespace halocline::networks {
namespace {

constexpr std::uint8_t kData = 0xA0, kRequestToSend = 0xA1, kClearToSend = 0xA2;

}  // namespace

void Maca::on_packet(const modem_receive_t& packet, std::int32_t own_id) {
  if (packet.payload.empty()) return;
  const SimTime at = SimTime::from_utime(packet.utime);
  const std::uint8_t kind = packet.payload.front();
  const bool is_ours = packet.destination_id == own_id;
  if (kind == kData && (is_ours || packet.destination_id == kBroadcastId)) {
    if (is_ours && state_ == State::kAwaitsData && packet.source_id == partner_) become_idle(at);
    port_.deliver(at, {packet.destination_id, {packet.payload.begin() + 1, packet.payload.end()}});
  } else if (kind == kRequestToSend && is_ours) {
    on_request(packet);
  } else if (kind == kClearToSend && is_ours) {
    if (state_ == State::kAwaitsClearToSend && packet.source_id == partner_) on_clear_to_send(packet);
  } else if (kind == kRequestToSend || kind == kClearToSend) {
    silent_until_ =
        std::max(silent_until_, at + (kind == kRequestToSend ? rules_.handshake : rules_.exchange));
    on_threat(at);
  }
}

void Maca::on_request(const modem_receive_t& packet) {
  const SimTime at = SimTime::from_utime(packet.utime);
  if (state_ == State::kIdle && at >= silent_until_ && !answer_) {
    partner_ = packet.source_id;
    answer_ = MacFrame{partner_, {kClearToSend}};
    await(State::kAwaitsData, at + rules_.exchange);
  } else if (packet.source_id != partner_) {
    on_threat(at);
  }
}

void Maca::on_clear_to_send(const modem_receive_t& packet) { send_data(SimTime::from_utime(packet.utime)); }

void Maca::on_clock_set(SimTime now, SimDuration by) {
  Mac::on_clock_set(now, by);
  deadline_ = moved(deadline_, by);
  silent_until_ = moved(silent_until_, by);
}

SimTime Maca::next() const {
  if (transmits_) return SimTime::never();
  if (answer_) return SimTime::at_once();
  if (state_ != State::kIdle) return deadline_;
  return queue_.empty() ? SimTime::never() : std::max(due_, silent_until_);
}

void Maca::step(SimTime now) {
  if (next() > now) return;
  if (answer_) {
    transmit(*std::exchange(answer_, std::nullopt), now);
  } else if (state_ == State::kAwaitsClearToSend) {
    become_idle(now);
    try_again(now);
  } else if (state_ == State::kHasClearToSend) {
    send_data(now);
  } else if (state_ == State::kAwaitsData) {
    become_idle(now);
  } else {
    attempt(now);
  }
}

void Maca::attempt(SimTime now) {
  if (carrier_) return try_again(now);
  if (queue_.front().destination == kBroadcastId) return send_data(now);
  partner_ = queue_.front().destination;
  await(State::kAwaitsClearToSend, now + rules_.handshake);
  transmit({partner_, {kRequestToSend}}, now);
}

void Maca::await(State state, SimTime deadline) {
  state_ = state;
  deadline_ = deadline;
}

void Maca::become_idle(SimTime now) {
  state_ = State::kIdle;
  due_ = now;
}

void Maca::send_data(SimTime now) {
  answer_ = marked(kData, queue_.front());
  queue_.pop_front();
  tries_ = 0;
  become_idle(now);
}

void Maca::try_again(SimTime now) {
  due_ = now + random_wait(rules_.backoff);
  if (++tries_ < rules_.tries) return;
  tries_ = 0;
  drop_first(now);
}

std::unique_ptr<Mac> make_maca(MacPort port, const NetworkRules& rules) {
  return std::make_unique<Maca>(std::move(port), rules);
}

}  // namespace halocline::networks
