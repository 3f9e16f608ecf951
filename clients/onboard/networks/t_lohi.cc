// SPDX-License-Identifier: BSD-3-Clause
// T-Lohi, conservative and unsynchronised (Syed, Ye and Heidemann 2008): vehicles contend for the channel
// with tones. A vehicle that hears no other tone in a contention round sends its data.
//
// A round begins with the vehicle's own tone, a short packet, and lasts R = `contention`, at least the tone
// and twice the greatest travel time T. Other tones are heard as carrier. A vehicle that heard n of them in
// its round waits a random number of 0 to n rounds before it contends again. A vehicle that hears a tone
// while it does not contend is out of the frame: it waits until data have been received (the modem must be
// promiscuous), or for kFrameRounds without another tone.
//
// There is one winner. Let X hear nothing in the round that its tone begins at time 0, and let Y send a tone
// at s >= 0, with the travel time d <= T between them. If s < d, X hears that tone at s + d < 2 T, within its
// round. If s >= d, Y has heard X's tone and is silent for R from then on, when X's data arrive. So no data
// collide when all vehicles hear each other. The utilisation is greatest with a single vehicle:
//
//   t_data / (t_data + R + kGap)
//
// Tones that overlap are one carrier: a carrier of duration c counts as c / t_tone tones, rounded up. So n is
// never more than the number of tones, and less where tones coincide, as in a receiver that counts detected
// tones. Fewer rounds to choose from cause repeated contentions, but no lost data. A vehicle that has sent
// data waits for kGap, so that others contend first. Broadcast frames are sent like others.
#include <algorithm>
#include <cmath>
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

constexpr std::uint8_t kData = 0xB0, kTone = 0xB1;
constexpr std::size_t kToneBytes = 4;
constexpr int kFrameRounds = 8;
// Longer than a modem takes to notice that a carrier begins or ends (docs/packets.md).
constexpr SimDuration kGap = SimDuration::from_milliseconds(20);

class TLohi : public Mac {
 public:
  using Mac::Mac;

  void on_packet(const modem_receive_t& packet, std::int32_t own_id) override {
    if (packet.payload.empty() || packet.payload.front() != kData) return;
    const SimTime at = SimTime::from_utime(packet.utime);
    out_until_ = silent_until_ = due_ = at;
    if (packet.destination_id == own_id || packet.destination_id == kBroadcastId)
      port_.deliver(at, {packet.destination_id, {packet.payload.begin() + 1, packet.payload.end()}});
  }

  void on_refused(SimTime now) override {
    contends_ = false;
    Mac::on_refused(now);
  }

  void on_event(const modem_event_t& event) override {
    const SimTime at = SimTime::from_utime(event.utime);
    if (event.modem_event == modem_event_t::CARRIER_BEGAN) {
      carrier_began_ = at;
      silent_until_ = at + rules_.contention + kGap;
      if (!contends_) out_until_ = at + rules_.contention * kFrameRounds;
    } else if (event.modem_event == modem_event_t::CARRIER_ENDED) {
      count_carrier(at);
    } else if (event.modem_event == modem_event_t::TRANSMISSION_BEGAN) {
      sent_ = at;
    } else if (event.modem_event == modem_event_t::TRANSMISSION_ENDED && contends_) {
      tone_ = at - sent_;
    }
    Mac::on_event(event);
  }

  void on_clock_set(SimTime now, SimDuration by) override {
    Mac::on_clock_set(now, by);
    for (SimTime* time : {&round_end_, &carrier_began_, &sent_, &silent_until_, &out_until_})
      *time = moved(*time, by);
  }

  SimTime next() const override {
    if (transmits_) return SimTime::never();
    if (contends_) return round_end_;
    if (queue_.empty() || carrier_) return SimTime::never();
    return std::max({due_, silent_until_, out_until_});
  }

  void step(SimTime now) override {
    if (next() > now) return;
    if (!contends_) return begin_round(now);
    if (carrier_) count_carrier(now);
    contends_ = false;
    if (others_ == 0) {
      queue_.front() = marked(kData, queue_.front());
      return transmit_first(now);
    }
    const auto rounds = static_cast<std::int64_t>(port_.draw() * static_cast<double>(others_ + 1));
    due_ = std::max(now, silent_until_) + rules_.contention * rounds;
    out_until_ = now;
  }

 protected:
  SimTime first_try(SimTime now) const override { return now + kGap; }

 private:
  void begin_round(SimTime now) {
    contends_ = true;
    others_ = 0;
    round_end_ = now + rules_.contention;
    transmit({kBroadcastId, std::vector<std::uint8_t>(kToneBytes, kTone)}, now);
  }

  void count_carrier(SimTime until) {
    if (!contends_) return;
    const double tones = (until - carrier_began_).seconds() / tone_.seconds();
    others_ += std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(tones)));
  }

  bool contends_ = false;  // a contention round of this vehicle is in progress
  std::int64_t others_ = 0;
  SimTime round_end_, carrier_began_, sent_;
  // Until then, the round of another vehicle may be in progress.
  SimTime silent_until_ = SimTime::at_once();
  SimTime out_until_ = SimTime::at_once();  // end of being out of the frame
  SimDuration tone_ = SimDuration::from_milliseconds(1);
};

}  // namespace

std::unique_ptr<Mac> make_t_lohi(MacPort port, const NetworkRules& rules) {
  return std::make_unique<TLohi>(std::move(port), rules);
}

}  // namespace halocline::networks
