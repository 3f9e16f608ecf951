// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/networks/mac.h"

#include "core/elementary.h"
#include "core/names.h"

namespace halocline::networks {

void Mac::offer(MacFrame frame, SimTime now) {
  if (queue_.size() == kMaxWaiting) return port_.drop(now, frame);
  queue_.push_back(std::move(frame));
  if (queue_.size() == 1) due_ = first_try(now);
}

void Mac::on_packet(const modem_receive_t& packet, std::int32_t own_id) {
  if (packet.destination_id == own_id || packet.destination_id == kBroadcastId)
    port_.deliver(SimTime::from_utime(packet.utime), {packet.destination_id, packet.payload});
}

void Mac::on_event(const modem_event_t& event) {
  switch (event.modem_event) {
    case modem_event_t::CARRIER_BEGAN:
    case modem_event_t::CARRIER_ENDED:
      carrier_ = event.modem_event == modem_event_t::CARRIER_BEGAN;
      break;
    case modem_event_t::TRANSMISSION_ENDED:
      transmits_ = false;
      due_ = first_try(SimTime::from_utime(event.utime));
      break;
    default:
      break;
  }
}

void Mac::on_refused(SimTime now) {
  transmits_ = false;
  due_ = first_try(now);
}

void Mac::on_clock_set(SimTime /*now*/, SimDuration by) { due_ = moved(due_, by); }

SimTime Mac::next() const { return queue_.empty() || transmits_ ? SimTime::never() : due_; }

void Mac::step(SimTime now) {
  if (next() <= now) attempt(now);
}

void Mac::transmit(MacFrame frame, SimTime now) {
  transmits_ = true;
  port_.transmit(now, frame);
}

void Mac::transmit_first(SimTime now) {
  MacFrame frame = std::move(queue_.front());
  queue_.pop_front();
  transmit(std::move(frame), now);
}

void Mac::drop_first(SimTime now) {
  port_.drop(now, queue_.front());
  queue_.pop_front();
  due_ = first_try(now);
}

// Draws from the exponential distribution by its inverse: -mean log(u), u uniform in (0, 1).
SimDuration Mac::random_wait(SimDuration mean) const {
  return SimDuration::from_seconds(-mean.seconds() * elementary::log(port_.draw()));
}

}  // namespace halocline::networks
