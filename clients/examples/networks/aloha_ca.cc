// SPDX-License-Identifier: BSD-3-Clause
// ALOHA with collision avoidance (Chirdchoo, Soh and Chua 2007): a vehicle knows how long sound takes between
// all vehicles, and learns of each packet that it overhears who sent it and for whom. It so knows when sound
// is wherever it is to be received, and sends nothing that would meet it there.
//
// A packet from i to j whose last bit arrives here at e left i at e - t_i - L, with t_i the travel time to
// here and L its duration; it sounds at k from then + t_ik on, for L. A frame to d of duration P is not sent
// at t where
//   i = d: d transmits while the frame would arrive, [t + t_d, t + t_d + P)
//   any:   the packet sounds at d then, or the frame would sound at j (not 0) while j receives the packet
// It is tried again after a random wait, `tries` times in all. What is sent so late that its header is not
// received yet collides all the same: the protocol gains where sound takes long against headers, and from
// vehicles on the way of others' sound. Without a header of its own (header_bits of [modem]) a packet is
// known at its last bit.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "clients/examples/networks/mac.h"
#include "clients/examples/networks/network_packet.h"
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
  // Longer than sound takes through any network.
  static constexpr SimDuration kKept = SimDuration::from_milliseconds(100'000);
  struct Overheard {
    std::int32_t source, destination;
    SimTime departure;
    SimDuration duration;
  };

  // Whether a frame of ours that leaves at `now` and what was overheard sound at `place` together.
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
  std::vector<Overheard> overheard_;  // the latest of each vehicle
  int tries_ = 0;                     // of the first frame
};

}  // namespace

std::unique_ptr<Mac> make_aloha_ca(MacPort port, const NetworkRules& rules, std::int32_t own_id,
                                   TravelTimes travel) {
  return std::make_unique<AlohaCa>(std::move(port), rules, own_id, std::move(travel));
}

}  // namespace halocline::networks
