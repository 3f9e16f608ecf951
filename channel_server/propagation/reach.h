// SPDX-License-Identifier: BSD-3-Clause
// Reach of a sender: the range beyond which its sound affects nobody. Links beyond it are dropped before
// anything of them is looked up, searched or computed.
//
// Two levels count for each receiving modem. Sound has no effect where it is certainly below both.
//
// - Interference level: the sound's power within any band is `below_noise` (30 dB) below the noise there.
//   Such interference takes 0.004 dB off a signal-to-noise ratio, and 0.04 dB where large-scale fading raises
//   it by three standard deviations of 3 dB. The level is
//       least noise density over the sender's band * its bandwidth - directivity index - below_noise
// - Detection level, for a receiver of the same family with a common band: the greater of its cut-off level
//   and the level at which the preamble is acquired once in `acquired_once_in` (100 000) packets over all
//   fading (acoustics/fading/fading_bounds.h). A packet without a preamble is always acquired: then the
//   cut-off level alone counts. A packet that is not acquired is neither received nor tracked.
//
// The reach is the range at which
//
//   source level + both beams at their best - least loss
//
// falls below the lower of the two levels (acoustics/link/least_loss.h), the greatest such range of all
// modems in use, the sender's own included. Where links at that range are flux-only
// (Propagation::flux_only_links), the least loss is that of their incoherent energy flux.
//
// The noise is the least of the environments known to hold within kLongestFlight after the departure. The
// modems are those carried at the departure or announced to be carried within that time. Left out: changes of
// environment and modems that are announced after the departure.
//
// The reception range, within which links have rows in link tables, is shorter: beyond it at most one packet
// in a thousand is received. There, source level + both beams at their best - least loss exceeds the noise at
// the instant (the least over the band) by less than the least signal-to-noise ratio that the sender's
// packets need (links/link_predictor.h). The cut-off level is ignored here: table rows state it.
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
  bool by_level = true;           // false: every sender reaches every receiver
  Decibels below_noise{30};       // 0..200
  double acquired_once_in = 1e5;  // packets, 10..1e5: a rarer acquisition has no effect
  acoustics::FadingModel fading = {};
  // Standard deviation of the noise. For what disturbs, the noise counts as quieter by one deviation of noise
  // and slow fading together: beyond it, what is left out at 30 dB below the noise adds 0.1 dB in one hour of
  // a hundred.
  double noise_spread_db = 0;
  double table_range_m = 0;  // upper bound of the reception range; 0: by level alone
};

// Sound that departed earlier is no longer under way: it has travelled 180 km.
inline constexpr SimDuration kLongestFlight = SimDuration::from_milliseconds(120'000);

// True when a receiver `range_m` away at the departure of sound is still further than `reach_m` away when the
// sound arrives. `speed_mps` is its speed over ground at the departure; it may speed up by 5 m/s (our
// choice), and sound travels at 1400 m/s at least on average.
bool stays_beyond(double reach_m, double range_m, double speed_mps);

// Computes reaches and reception ranges; caches them by water and modems. Not thread-safe.
class ReachModel {
 public:
  // `propagation` must use these waters and outlive the model.
  ReachModel(std::shared_ptr<const EnvironmentTimeline> waters, const Propagation& propagation,
             const ReachRule& rule);

  // Returns the reach of sound that leaves `sender` at `at`, m, 0..kMaxBoundedRange; `vehicles` are all
  // vehicles where they are at that time. kMaxBoundedRange, which includes everybody, when reaches are
  // not limited by level and where the propagation states no bound.
  double reach_m(SimTime at, const acoustics::Modem& sender, const VehicleRegistry& registry,
                 const std::vector<PlacedVehicle>& vehicles);
  // True when sound of this power may disturb where the noise over the same band has that power.
  bool disturbs(double power, double noise) const {
    return !rule_.by_level || power >= noise * to_power_ratio(-rule_.below_noise).value;
  }
  // Mean signal-to-noise ratio, dB, below which no packet of a modem is received.
  using LeastRatio = std::function<double(const acoustics::Modem&)>;
  // Returns the reception range of each vehicle, in their order, m; range as reach_m().
  std::vector<double> reception_ranges_m(SimTime at, const VehicleRegistry& registry,
                                         const std::vector<PlacedVehicle>& vehicles,
                                         const LeastRatio& least_sinr_db);

 private:
  // Modems in use and the greatest depth of their vehicles.
  struct Crowd {
    std::vector<const acoustics::Modem*> modems;  // without duplicates
    double deepest_m = 0;
  };
  using ModemKey = std::tuple<std::array<double, 7>, std::vector<double>, std::string>;
  // Water; level that is compared; greatest depth; sender; receiver.
  using Key = std::tuple<EnvironmentTimeline::WaterId, double, double, ModemKey, ModemKey>;

  static ModemKey key_of(const acoustics::Modem& modem);
  Crowd crowd_of(SimTime at, const VehicleRegistry& registry,
                 const std::vector<PlacedVehicle>& vehicles) const;
  double reach_m(SimTime at, const acoustics::Modem& sender, const Crowd& crowd);
  double reception_range_m(SimTime at, const acoustics::Modem& sender, const Crowd& crowd,
                           double least_sinr_db);
  // Returns the range beyond which levels are below `least`.
  double range_m(SimTime at, const acoustics::Modem& sender, const acoustics::Modem& receiver, Decibels least,
                 double deepest_m);

  std::shared_ptr<const EnvironmentTimeline> waters_;
  const Propagation& propagation_;
  ReachRule rule_;
  LruCache<Key, double> ranges_;
  LruCache<ModemKey, double> unnoticed_;  // signal-to-noise ratios, dB
};

}  // namespace halocline::channel_server
