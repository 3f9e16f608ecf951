#include "clients/modem_gateway/protocols/micromodem/micromodem_lbl.h"

#include <algorithm>

namespace halocline::modem_gateway {
namespace {

// Of the modem that answers a ping (docs/packets.md).
constexpr SimDuration kTurnaround = SimDuration::from_milliseconds(100);

}  // namespace

void MicromodemLbl::start(const Asked& asked, SimDuration timeout) {
  asked_ = asked;
  times_ = {};
  timeout_ = timeout;
  const bool asks =
      std::any_of(asked.begin(), asked.end(), [](const auto& vehicle) { return vehicle.has_value(); });
  if (asks) return ask_from(0);
  // Nobody answers: done after the time-out.
  place_ = kTransponders - 1;
  sequence_ = kNotSent;
  until_ = port_.now() + timeout;
}

void MicromodemLbl::ask_from(std::size_t place) {
  for (place_ = place; place_ < kTransponders; ++place_) {
    if (!asked_[place_]) continue;
    sequence_ = port_.send(port_.now(), *asked_[place_], {}, {.kind = modem_send_t::PING, .rate_number = 0});
    until_ = port_.now() + kReceiptWithin;
    return;
  }
  done_(times_);
}

bool MicromodemLbl::takes(const modem_receipt_t& receipt) {
  if (!is_busy() || receipt.packet_sequence != sequence_) return false;
  const bool accepted = receipt.receipt_result == modem_receipt_t::ACCEPTED ||
                        receipt.receipt_result == modem_receipt_t::QUEUED;
  const SimDuration duration = SimDuration::from_seconds(receipt.duration_s);
  // The answer takes as long as the ping.
  until_ = accepted ? SimTime::from_utime(receipt.start_utime) + duration + duration + kTurnaround + timeout_
                    : port_.now();
  return true;
}

bool MicromodemLbl::takes(const modem_receive_t& packet) {
  if (!is_busy() || packet.packet_sequence != sequence_ || packet.packet_kind != modem_receive_t::PING_REPLY)
    return false;
  times_[place_] = packet.two_way_travel_time_s / 2;
  ask_from(place_ + 1);
  return true;
}

void MicromodemLbl::step() {
  if (is_busy() && port_.now() >= until_) ask_from(place_ + 1);
}

}  // namespace halocline::modem_gateway
