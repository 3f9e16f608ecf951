// SPDX-License-Identifier: BSD-3-Clause
// ALOHA with collision avoidance (Chirdchoo, Soh and Chua 2007): a vehicle knows the travel times of sound
// between all vehicles, and learns the source and destination of each packet that it overhears. So it knows
// when that packet arrives at any place, and transmits nothing that would overlap it at a receiver.
//
// A packet from i to j of duration L whose last bit arrives here at e left i at
//
//   t_0 = e - t_i - L        (t_i: travel time from i to here)
//
// and arrives at k during [t_0 + t_ik, t_0 + t_ik + L), with the travel time t_ik. A frame of duration P to d
// is not transmitted at t when one of these holds, with t_d and t_j the travel times from here:
//
//   i = d: d transmits while the frame would arrive, [t + t_d, t + t_d + P)
//   any i: the packet arrives at d in that interval,
//          or the frame would arrive at j (j not 0) while j receives the packet
//
// It is tried again after a random wait, `tries` times in all. A packet whose header has not been received
// yet cannot be avoided: the protocol is useful where travel times exceed headers, and for vehicles between
// the others. When packets have no header of their own (header_bits of [modem]), a packet is known only at
// its last bit.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "clients/onboard/networks/mac.h"
#include "clients/onboard/networks/network_packet.h"
#include "core/names.h"
#include "core/sim_time.h"

namespace halocline::networks {
namespace {

class AlohaCa : public Mac {
 public:
  AlohaCa(MacPort port, const NetworkRules& rules, std::int32_t own_id, TravelTimes travel)
      : Mac(std::move(port), rules), own_id_(own_id), travel_(std::move(travel)) {}

  void on_event(const modem_event_t& event) override {
    Mac::on_event(event);
    if (event.source_id == 0) return;
    const SimTime now = SimTime::from_utime(event.utime);
    const auto duration = SimDuration::from_seconds(event.packet_duration_s);
    const SimTime departure =
        SimTime::from_utime(event.packet_end_utime) - travel_(event.source_id, own_id_) - duration;
    std::erase_if(overheard_, [&](const Overheard& o) {
      return o.source == event.source_id || o.departure + o.duration + kKept < now;
    });
    overheard_.push_back({event.source_id, event.destination_id, departure, duration});
  }

  void on_clock_set(SimTime now, SimDuration by) override {
    Mac::on_clock_set(now, by);
    for (Overheard& o : overheard_) o.departure = moved(o.departure, by);
  }

 protected:
  void attempt(SimTime now) override {
    if (!would_collide(now, queue_.front().destination)) {
      tries_ = 0;
      return transmit_first(now);
    }
    due_ = now + random_wait(rules_.backoff);
    if (++tries_ < rules_.tries) return;
    tries_ = 0;
    drop_first(now);
  }

 private:
  // Time for which an overheard packet is kept; longer than sound takes across any network.
  static constexpr SimDuration kKept = SimDuration::from_milliseconds(100'000);
  struct Overheard {
    std::int32_t source, destination;
    SimTime departure;
    SimDuration duration;
  };

  // Returns true when a frame of this vehicle that leaves at `now` overlaps an overheard packet at `place`.
  bool meets_at(std::int32_t place, const Overheard& o, SimTime now) const {
    const SimTime ours = now + travel_(own_id_, place);
    const SimTime theirs = o.departure + travel_(o.source, place);
    return ours < theirs + o.duration && theirs < ours + rules_.packet;
  }

  bool would_collide(SimTime now, std::int32_t destination) const {
    return std::any_of(overheard_.begin(), overheard_.end(), [&](const Overheard& o) {
      const bool is_received = o.destination != kBroadcastId && o.destination != own_id_;
      return (destination != kBroadcastId && meets_at(destination, o, now)) ||
             (is_received && meets_at(o.destination, o, now));
    });
  }

  std::int32_t own_id_;
  TravelTimes travel_;
  std::vector<Overheard> overheard_;  // latest packet of each vehicle
  int tries_ = 0;                     // attempts of the first frame
};

}  // namespace

std::unique_ptr<Mac> make_aloha_ca(MacPort port, const NetworkRules& rules, std::int32_t own_id,
                                   TravelTimes travel) {
  return std::make_unique<AlohaCa>(std::move(port), rules, own_id, std::move(travel));
}

}  // namespace halocline::networks
