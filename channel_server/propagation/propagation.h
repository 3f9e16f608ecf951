// SPDX-License-Identifier: BSD-3-Clause
// Interface of the propagation models: how sound travels from one point to another. The packet medium and the
// link tables ask it; models of the water implement it.
//
// Every result holds for the instant of departure, `at`. That instant selects the environment and the known
// bathymetry, both of which may change during a run. An implementation may cache what it has computed. Its
// results depend on the arguments and on what was known for that instant, never on the order of the calls.
//
// Levels are in dB re 1 uPa over the transmitter's band. Angles are measured from the horizontal, positive
// down, along the direction of travel of the sound: the launch angle at the transmitter, the arrival angle at
// the receiver.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/measured_channel.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/link/energy_flux.h"
#include "acoustics/link/least_loss.h"
#include "acoustics/link/link_budget.h"
#include "acoustics/link/link_kernel.h"
#include "acoustics/modem/modem.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/environment.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/link_chart.h"
#include "channel_server/propagation/seabed_profile.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/for_each.h"
#include "core/frames.h"
#include "core/lru_cache.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {

class PathExchange;

// Finite level that represents silence: 300 dB below 1 uPa, far below the thermal noise of any band (-15 dB
// re 1 uPa^2/Hz at 1 kHz).
inline constexpr Decibels kSilence{-300};
// Returns 10 log10(`power`), dB: the level of a power, or a ratio in decibels. The result is at least
// kSilence.
inline Decibels level_of(double power) {
  return power > 0 ? std::max(to_decibels(PowerRatio{power}), kSilence) : kSilence;
}

// Paths weaker than the strongest one by more than this do not announce a packet. A receiver finds the
// preamble by correlation and takes the first peak above a threshold relative to the greatest as its start. A
// preamble compressed to one peak has sidelobes of up to -13 dB itself (a linear sweep without shading); 20
// dB stays clear of these.
inline constexpr Decibels kSignificantBelowStrongest{20};

// One end of a link.
struct LinkEnd {
  VehicleId id = 0;                         // 0: a position without a vehicle
  Vec3 position_ned_m = Vec3::Zero();       // world NED, m
  Vec3 velocity_ned_mps = Vec3::Zero();     // world NED, over ground, m/s
  const acoustics::Modem* modem = nullptr;  // never null in a call; must outlive the end
  Decibels above_ambient = {};              // receivers only: noise above that of the environment
};

using acoustics::Arrival;

// A link in one direction.
struct EndPair {
  LinkEnd from, to;
};

enum class PathState {
  kOpen,       // there is at least one path
  kShadow,     // no ray arrives: refraction bends all of them away from the receiver
  kBlocked,    // no ray arrives, and the terrain cuts the straight line between the ends
  kTooWeak,    // rays arrive, but losses at their bounces leave them below the limit of the search
  kTooSteep,   // rays arrive, but only at launch angles steeper than the limit of the search
  kNoTerrain,  // the terrain ends or has no data on the way, and its last depth is not held
};

enum class PropagationUsed {
  kStraight,               // one straight path
  kRays,                   // rays in the water above the known bottom
  kStraightWithoutBottom,  // rays were requested, but the bottom is unknown: one straight path
  kStraightNotSearched,    // link tables only: rays were requested, but no search is scheduled yet: one
                           // straight path
  kRaysBeyondTerrain,      // kRays, but over the last known depth where the terrain ends or has no data
};
inline bool is_along_rays(PropagationUsed used) {
  return used == PropagationUsed::kRays || used == PropagationUsed::kRaysBeyondTerrain;
}

// The knowledge about echoes off the bottom on a link.
enum class Multipath {
  kUnlikely,
  kLikely,   // an echo reaches the receiver above its cut-off
  kUnknown,  // the terrain is not known
};

// Sound that one link delivers. In the budget, `delay_s` is the delay of the strongest path in the receiver's
// guard window, and `received_level` is the mean power of all paths together (acoustics/fading/link_fading.h;
// without fading, the sum of their powers); the other fields follow from these. Without a path, the delay is
// that of the straight line, both levels are kSilence or a floor that the implementation states, and nothing
// is receivable.
struct Reception {
  acoustics::LinkBudget budget;
  PathState state = PathState::kOpen;
  PropagationUsed used = PropagationUsed::kStraight;
  acoustics::RaySolver solver = acoustics::RaySolver::kImages;  // of the paths; valid along rays
  double delay_spread_s = 0;                                    // from the first significant path to the last
  // Level of the diffuse paths, a part of the received level; kSilence without any.
  Decibels diffuse_level = kSilence;
  std::vector<Arrival> paths;  // sorted by delay; empty unless the state is kOpen
  // Age of the paths: time since the search of which they are the result was up to date for this link. Older
  // paths are extrapolated to the present geometry. Above 0 only in link tables with a limited number of
  // searches a tick.
  SimDuration paths_age = {};
  // Measured channel whose taps are the paths and whose fading they have; null: they fade by the model.
  std::shared_ptr<const acoustics::MeasuredChannel> measured = {};
  // Echoes beside a straight path over a known bottom; kUnknown otherwise, also along rays, among which the
  // echoes are.
  Multipath bottom_echo = Multipath::kUnknown;
  double share_under_water = 1;  // of the time, for which the waves cover both ends (surface_ends.h)
};

// Bound on flux-only links, for which only the incoherent energy flux is computed: all links whose level lies
// `below_noise` below the noise over the transmitter's band, less the receiver's directivity.
struct FluxOnlyLinks {
  acoustics::LeastFluxLoss loss;
  Decibels below_noise;
};

// Returns the index of the first path within kSignificantBelowStrongest of the strongest. `paths` are by
// rising delay and not empty.
std::size_t first_significant(const std::vector<Arrival>& paths);
// Returns the delay from the first significant path to the last significant one, s; 0 for one path or none.
// `paths` are by rising delay.
double delay_spread_s(const std::vector<Arrival>& paths);
// Returns the level of the sum of the powers; kSilence without a path.
Decibels total_level(const std::vector<Arrival>& paths);
// Returns the number of paths that are not diffuse.
std::size_t number_of_paths(const std::vector<Arrival>& paths);
// Returns the level of the diffuse paths; kSilence without any.
Decibels diffuse_level(const std::vector<Arrival>& paths);

class Propagation {
 public:
  virtual ~Propagation() = default;

  // Throws InvalidArgument when a modem is out of range.
  virtual Reception reception(SimTime at, const LinkEnd& from, const LinkEnd& to) = 0;
  // Returns reception() for callers such as packets that do not read capacity and bottom echo: they may be 0
  // and kUnknown.
  virtual Reception reception_without_capacity(SimTime at, const LinkEnd& from, const LinkEnd& to) {
    return reception(at, from, to);
  }
  // Returns reception_without_capacity() of each link of one packet that is ready, and an empty element for
  // each other link. The work is distributed by `for_each`.
  virtual std::vector<std::optional<Reception>> packet_receptions(SimTime at,
                                                                  const std::vector<EndPair>& links,
                                                                  const ForEach& for_each);
  // True when begin_tick() must be called once for each tick before receptions(), with all links between all
  // vehicles, also those that nobody requests: an implementation with a limited number of searches a tick
  // schedules them there.
  virtual bool plans_ticks() const { return false; }
  virtual void begin_tick(SimTime /*at*/, const std::vector<EndPair>& /*all*/) {}
  // Lets this server and others exchange the results of their searches through `exchange` from now on;
  // returns false when the model has no searches. `exchange` must outlive the propagation. With an exchange,
  // prepare_tables() must be called with the links of a tick before receptions() may be, and without delay
  // when it awaits nothing: it searches for what other servers wait for. The exchange changes no result.
  virtual bool share_searches(PathExchange& /*exchange*/) { return false; }
  virtual void prepare_tables(SimTime /*at*/, const std::vector<EndPair>& /*links*/,
                              const ForEach& /*for_each*/) {}
  // Returns the receptions of many links that depart at one instant; the work is distributed by `for_each`.
  // Each equals reception() of that link, or nearly so where an implementation lets neighbouring links share
  // a search. The results do not depend on the distribution.
  virtual std::vector<Reception> receptions(SimTime at, const std::vector<EndPair>& links,
                                            const ForEach& for_each);
  // True when everything that reception() (or receptions()) needs is known. What is missing is requested here
  // and later becomes known or turns out to be unavailable; call again then.
  virtual bool is_ready(SimTime /*at*/, const LinkEnd& /*from*/, const LinkEnd& /*to*/) { return true; }
  // See is_ready(); here for reception_without_capacity().
  virtual bool is_ready_for_packet(SimTime at, const LinkEnd& from, const LinkEnd& to) {
    return is_ready(at, from, to);
  }
  virtual bool are_ready(SimTime /*at*/, const std::vector<EndPair>& /*links*/) { return true; }
  // True when paths depend on the bottom along the link. Then reception() uses the known seabed and
  // reception_over() the given one, from one end to the other (null: unknown). reception_over() must not be
  // called otherwise.
  virtual bool uses_bottom() const { return false; }
  // Returns how far a place lies inside the seabed, m; 0 or less in the water and where the seabed is
  // unknown.
  virtual double depth_inside_seabed_m(const Vec3& /*place_ned_m*/) const { return 0; }
  virtual Reception reception_over(SimTime at, const LinkEnd& from, const LinkEnd& to,
                                   const std::shared_ptr<const SeabedProfile>& seabed);
  // Returns the link in full detail, with the paths that reception() computes; here along the straight line.
  virtual LinkChart chart(SimTime at, const LinkEnd& from, const LinkEnd& to);
  // Returns a lower bound of the loss of every link at a frequency between ends no deeper than
  // `deepest_end_m` (acoustics/link/least_loss.h); empty: levels have no bound by range.
  virtual std::optional<acoustics::LeastLoss> least_loss(SimTime /*at*/, double /*frequency_hz*/,
                                                         double /*deepest_end_m*/) const {
    return std::nullopt;
  }
  // Returns the bound on flux-only links; empty where they are computed like all others, or where the
  // depth of the water is unknown.
  virtual std::optional<FluxOnlyLinks> flux_only_links(SimTime /*at*/, double /*frequency_hz*/,
                                                       double /*deepest_end_m*/) const {
    return std::nullopt;
  }
  // Returns the environment at `at`; the reference is valid until the next change of it.
  virtual const acoustics::Environment& environment(SimTime at) const = 0;
};

}  // namespace halocline::channel_server
