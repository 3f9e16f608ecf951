// SPDX-License-Identifier: BSD-3-Clause
// How far a sender reaches: the range beyond which its sound matters to nobody. What is further apart is left
// out before anything of its link is surveyed, searched or computed.
//
// Of each receiver's modem, two levels count. The sound is of no consequence where it is surely below both:
// - what disturbs: its power within any band is `below_noise` (30 dB) below the noise there; so much takes
//   0.004 dB off a ratio, and 0.04 dB where large-scale fading raises it by three standard deviations of 3
//   dB:
//     least noise density over the sender's band * its bandwidth - directivity index - below_noise
// - what a receiver of the same family and with a common band notices: the greater of its cut-off level, and
//   the level at which the preamble is acquired once in `acquired_once_in` (100 000) packets over all fading
//   (acoustics/fading/fading_bounds.h). A packet without a preamble is always acquired: then the cut-off
//   alone counts. One that is not acquired is neither received nor followed.
// The sender's reach is the range at which source level + both beams at their best - least loss
// (acoustics/link/least_loss.h) falls below the lower of them; of all modems in use (its own is among them)
// the greatest. Where links are so weak there that only their energy is computed (Propagation::weak_links),
// the least loss is that of their energy.
//
// Noise: the least of the waters known to hold within kLongestFlight from then on. Modems: those carried
// then, or announced to be carried within that time. Left out: changes of water and modems that are announced
// after the departure.
//
// The range of reception, within which links have rows in tables, is less: beyond it nobody receives a packet
// in a thousand. There source level + both beams at their best - least loss is less above the noise of the
// instant, the least over the band, than the least ratio that the sender's packets need
// (links/link_predictor.h). The cut-off does not count: a row shows it.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "acoustics/fading/path_fading.h"
#include "acoustics/modem/modem.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/lru_cache.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {

struct ReachRule {
  bool by_level = true;           // false: everybody reaches everybody
  Decibels below_noise{30};       // 0..200
  double acquired_once_in = 1e5;  // packets, 10..1e5: what is acquired less often is not noticed
  acoustics::FadingModel fading = {};
  double noise_spread_db = 0;  // standard deviation of the noise; three of them count as quieter
  double table_range_m = 0;    // the range of reception is no more than that; 0: by level alone
};

// Sound that left before is not under way any more: it has gone 180 km.
inline constexpr SimDuration kLongestFlight = SimDuration::from_milliseconds(120'000);

// The level below which `receiver` does not notice sound of `sender`, nor is disturbed by it;
// `noise_density`, uPa^2/Hz, is the least over the sender's band. dB re 1 uPa over that band.
Decibels least_level_that_matters(const ReachRule& rule, const acoustics::Modem& sender,
                                  const acoustics::Modem& receiver, PowerRatio noise_density);

// Whether a receiver `range_m` away when sound departs, at that speed over ground, is still further than
// `reach_m` away when the sound comes there: it may speed up by 5 m/s (our choice), and sound is no slower
// than 1400 m/s on average.
bool stays_beyond(double reach_m, double range_m, double speed_mps);

// Not thread-safe.
class ReachModel {
 public:
  // `propagation` of these waters; it must outlive the model.
  ReachModel(std::shared_ptr<const EnvironmentTimeline> waters, const Propagation& propagation,
             const ReachRule& rule);

  // Of sound that leaves `sender` at `at`, with `vehicles` about, placed then; m, 0..kGreatestBoundedRange.
  // That greatest range, which contains everybody, without a rule and where the propagation states no bound.
  double reach_m(SimTime at, const acoustics::Modem& sender, const VehicleRegistry& registry,
                 const std::vector<PlacedVehicle>& vehicles);
  // Whether sound of this power where the noise has that one, over the same band, may disturb.
  bool disturbs(double power, double noise) const {
    return !rule_.by_level || power >= noise * to_power_ratio(-rule_.below_noise).value;
  }
  // The mean ratio, dB, below which no packet of this modem is received.
  using LeastRatio = std::function<double(const acoustics::Modem&)>;
  // The ranges of reception of each of them, in their order; m, as reach_m().
  std::vector<double> reception_ranges_m(SimTime at, const VehicleRegistry& registry,
                                         const std::vector<PlacedVehicle>& vehicles,
                                         const LeastRatio& least_sinr_db);

 private:
  // The modems in use and how deep they are.
  struct Crowd {
    std::vector<const acoustics::Modem*> modems;  // all different
    double deepest_m = 0;
  };
  using ModemKey = std::tuple<std::array<double, 7>, std::vector<double>, std::string>;
  // The water; what the level is compared with; how deep; sender and receiver.
  using Key = std::tuple<EnvironmentTimeline::WaterId, double, double, ModemKey, ModemKey>;

  static ModemKey key_of(const acoustics::Modem& modem);
  Crowd crowd_of(SimTime at, const VehicleRegistry& registry,
                 const std::vector<PlacedVehicle>& vehicles) const;
  double reach_m(SimTime at, const acoustics::Modem& sender, const Crowd& crowd);
  double reception_range_m(SimTime at, const acoustics::Modem& sender, const Crowd& crowd,
                           double least_sinr_db);
  // Beyond it levels are below `least`.
  double range_m(SimTime at, const acoustics::Modem& sender, const acoustics::Modem& receiver, Decibels least,
                 double deepest_m);

  std::shared_ptr<const EnvironmentTimeline> waters_;
  const Propagation& propagation_;
  ReachRule rule_;
  LruCache<Key, double> ranges_;
  LruCache<ModemKey, double> unnoticed_;  // ratios, dB
};

}  // namespace halocline::channel_server
