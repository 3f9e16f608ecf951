// SPDX-License-Identifier: BSD-3-Clause
// DACAP, the distance-aware collision avoidance protocol (Peleato and Stojanovic 2007): MACA whose sender
// waits between the receiver's clear to send (CTS) and its data, and abandons the exchange when packets of
// others threaten it.
//
// A sender that overhears an RTS or a CTS of others before it sends its data tries again later. A receiver
// that hears one after its CTS transmits a warning, which makes its sender do the same. The wait is long
// enough for that, and no longer than the distance requires. With U the travel time to the receiver, half the
// time from the end of the RTS to the arrival of the CTS:
//
//   t_1  = (t_min - min(D, t_data, 2 T - t_min)) / 2
//   wait = max(t_min - 2 U,       2 D)    where U < t_1
//          max(2 (U + D) - t_min, 2 D)    elsewhere
//
//   t_min   `shortest_handshake` of all pairs
//   T       `longest_travel`, to the furthest vehicle that receives the sender
//   t_data  `packet`
//   D       `tolerance`: the travel time by which an interferer must be further from a receiver
//           than its sender, so as not to disturb it
//
// Without capture, no data collide when D >= T + half of the durations of RTS, CTS and warning: the warning
// about an RTS that crossed the CTS then arrives before the data are sent, and every vehicle that has sent no
// RTS by then has heard the CTS. The variant with acknowledgements is not implemented.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>

#include "clients/onboard/networks/mac.h"
#include "clients/onboard/networks/maca.h"
#include "clients/onboard/networks/network_packet.h"
#include "core/sim_time.h"

namespace halocline::networks {
namespace {

constexpr std::uint8_t kWarning = 0xA3;

class Dacap : public Maca {
 public:
  using Maca::Maca;

  void on_event(const modem_event_t& event) override {
    Maca::on_event(event);
    if (event.modem_event == modem_event_t::TRANSMISSION_ENDED) sent_ = SimTime::from_utime(event.utime);
  }

  void on_packet(const modem_receive_t& packet, std::int32_t own_id) override {
    Maca::on_packet(packet, own_id);
    const bool is_warning = !packet.payload.empty() && packet.payload.front() == kWarning;
    if (is_warning && packet.destination_id == own_id && packet.source_id == partner_ &&
        state_ == State::kHasClearToSend)
      give_way(SimTime::from_utime(packet.utime));
  }

  void on_clock_set(SimTime now, SimDuration by) override {
    Maca::on_clock_set(now, by);
    sent_ = moved(sent_, by);
  }

 protected:
  void on_clear_to_send(const modem_receive_t& packet) override {
    const double travel_s = (SimTime::from_utime(packet.arrival_utime) - sent_).seconds() / 2;
    await(State::kHasClearToSend, SimTime::from_utime(packet.utime) + wait_for(travel_s));
  }

  void on_threat(SimTime at) override {
    if (state_ == State::kAwaitsClearToSend || state_ == State::kHasClearToSend) give_way(at);
    if (state_ == State::kAwaitsData && !answer_) answer_ = MacFrame{partner_, {kWarning}};
  }

 private:
  SimDuration wait_for(double travel_s) const {
    const double shortest_s = rules_.shortest_handshake.seconds(), tolerance_s = rules_.tolerance.seconds();
    const double t1_s = (shortest_s - std::min({tolerance_s, rules_.packet.seconds(),
                                                2 * rules_.longest_travel.seconds() - shortest_s})) /
                        2;
    const double wait_s =
        travel_s < t1_s ? shortest_s - 2 * travel_s : 2 * (travel_s + tolerance_s) - shortest_s;
    return SimDuration::from_seconds(std::max(wait_s, 2 * tolerance_s));
  }

  void give_way(SimTime now) {
    become_idle(now);
    try_again(now);
  }

  SimTime sent_;  // end of the latest own transmission
};

}  // namespace

std::unique_ptr<Mac> make_dacap(MacPort port, const NetworkRules& rules) {
  return std::make_unique<Dacap>(std::move(port), rules);
}

}  // namespace halocline::networks
