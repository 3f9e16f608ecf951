// SPDX-License-Identifier: BSD-3-Clause
// Propagation of sound from one point to another: the interface between the packet medium and the link tables
// and the models of the water.
//
// Every result holds for an instant `at`, that of departure: it decides which water and which known bottom
// count, both of which may change during a run. An implementation may keep what it has computed; its results
// depend on the arguments and on what was known for that instant, never on the order of the calls.
//
// Decibels are dB re 1 uPa in the transmitter's band. Angles are from the horizontal, positive down, of the
// direction in which the sound travels: a launch angle as it leaves, an arrival angle as it comes in.
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

#include "acoustics/fading/measured_channel.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/fading/sound_path.h"
#include "acoustics/link/least_loss.h"
#include "acoustics/link/link_budget.h"
#include "acoustics/link/link_kernel.h"
#include "acoustics/link/mixed_link.h"
#include "acoustics/link/multipath.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/link_tracks.h"
#include "channel_server/propagation/seabed_profile.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/for_each.h"
#include "core/frames.h"
#include "core/lru_cache.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {

class PathExchange;

// A level that stands for none at all where a number has to be finite: 300 dB below 1 uPa, far below the
// thermal noise of any band (-15 dB re 1 uPa^2/Hz at 1 kHz).
inline constexpr Decibels kSilence{-300};
// The level of a power, or the decibels of a ratio; kSilence at least.
inline Decibels level_of(double power) {
  return power > 0 ? std::max(to_decibels(PowerRatio{power}), kSilence) : kSilence;
}

// Paths more than this below the strongest one do not announce a packet: a receiver finds the preamble by
// correlation and takes for its start the first peak above a threshold relative to the greatest, and a
// preamble compressed to one peak has sidelobes of its own up to -13 dB (a linear sweep without shading). 20
// dB stays clear of these.
inline constexpr Decibels kSignificantBelowStrongest{20};

// One end of a link.
struct LinkEnd {
  VehicleId id = 0;                         // 0: a position
  Vec3 position_ned_m = Vec3::Zero();       // world NED, m
  Vec3 velocity_ned_mps = Vec3::Zero();     // world NED, over ground, m/s
  const acoustics::Modem* modem = nullptr;  // never null in a call; outlives it
  Decibels above_ambient = {};  // of a receiver: by how much its noise exceeds that of the environment
};

using acoustics::SoundPath;

// A link, one way.
struct EndPair {
  LinkEnd from, to;
};

enum class PathState {
  kOpen,      // there is at least one path
  kShadow,    // no ray at all: the water bends every one away from the receiver
  kBlocked,   // no ray at all, and the terrain stands in the straight line
  kTooWeak,   // rays arrive, but their bounces leave less of them than counts
  kTooSteep,  // rays arrive, but only launched more steeply than is searched
};

enum class PropagationUsed {
  kStraight,               // one straight path
  kRays,                   // rays in the water above the known bottom
  kStraightWithoutBottom,  // rays were wanted, the bottom is not known: one straight path
  kStraightNotSearched,    // of tables alone: rays were wanted, no search has been granted yet: one straight
                           // path
  kRaysBeyondTerrain,      // as kRays, but over the last known depth where the terrain ends or has no data
};
inline bool is_along_rays(PropagationUsed used) {
  return used == PropagationUsed::kRays || used == PropagationUsed::kRaysBeyondTerrain;
}

// What arrives over one link. In the budget, `delay_s` is that of the strongest path in the receiver's guard
// window, `received_level` is the mean power of all paths together (acoustics/fading/link_fading.h; without
// fading, the sum of their powers), and the rest follows from these. Without a path the delay is that of the
// straight line, both levels are kSilence or a floor that the implementation states, and nothing is
// receivable.
struct Reception {
  acoustics::LinkBudget budget;
  PathState state = PathState::kOpen;
  PropagationUsed used = PropagationUsed::kStraight;
  double delay_spread_s = 0;  // from the first significant path to the last
  // Part of the received level: that of the paths that are diffuse; kSilence of none.
  Decibels diffuse_level = kSilence;
  std::vector<SoundPath> paths;  // by delay; empty unless the state is kOpen
  // Of tables: since when the paths are not those of a search for the link as it was, but extrapolated from
  // it; 0 where they are. Only with a budget of searches.
  SimDuration paths_age = {};
  // The paths are its taps, and fade as it does; null: they fade by the model.
  std::shared_ptr<const acoustics::MeasuredChannel> measured = {};
};

// What is known of links so weak that only their energy is computed: all whose energy lies this far below the
// noise over the transmitter's band, less the receiver's directivity.
struct WeakLinks {
  acoustics::LeastMixedLoss loss;
  Decibels below_noise;
};

// Index of the first path within kSignificantBelowStrongest of the strongest; `paths` by delay, not empty.
std::size_t first_significant(const std::vector<SoundPath>& paths);
// Of paths by delay: from the first significant to the last significant; 0 of one path or none.
double delay_spread_s(const std::vector<SoundPath>& paths);
// Sum of the powers; kSilence of none.
Decibels total_level(const std::vector<SoundPath>& paths);
// But those that are diffuse.
std::size_t number_of_paths(const std::vector<SoundPath>& paths);
// The level of these.
Decibels diffuse_level(const std::vector<SoundPath>& paths);

class Propagation {
 public:
  virtual ~Propagation() = default;

  // Throws InvalidArgument when a modem is out of range.
  virtual Reception reception(SimTime at, const LinkEnd& from, const LinkEnd& to) = 0;
  // The same where nobody reads the capacity, as packets do not: it may be 0.
  virtual Reception reception_without_capacity(SimTime at, const LinkEnd& from, const LinkEnd& to) {
    return reception(at, from, to);
  }
  // reception_without_capacity() of each link of one packet for which it is ready, shared out by `for_each`;
  // empty for others.
  virtual std::vector<std::optional<Reception>> packet_receptions(SimTime at,
                                                                  const std::vector<EndPair>& links,
                                                                  const ForEach& for_each);
  // Whether begin_tick() is to be called before receptions(), once for each tick, with all links between all
  // vehicles whoever asks for them: an implementation that has time for some searches only plans which.
  virtual bool plans_ticks() const { return false; }
  virtual void begin_tick(SimTime /*at*/, const std::vector<EndPair>& /*all*/) {}
  // Whether this server and others tell each other what they search for, through `exchange`, from now on; it
  // must outlive the propagation. Then prepare_tables() is to be called with the links of a tick before
  // receptions() may be, at once where it awaits nothing: it searches for what others wait for. It changes no
  // result.
  virtual bool share_searches(PathExchange& /*exchange*/) { return false; }
  virtual void prepare_tables(SimTime /*at*/, const std::vector<EndPair>& /*links*/,
                              const ForEach& /*for_each*/) {}
  // For many links that leave at one instant, shared out by `for_each`: as reception() one by one, or nearly
  // where an implementation lets links near each other share a search; the same whatever the sharing out.
  virtual std::vector<Reception> receptions(SimTime at, const std::vector<EndPair>& links,
                                            const ForEach& for_each);
  // Whether all is known that reception() needs, or receptions(). What is not is requested here, and becomes
  // known or turns out to be unavailable: to be called again then.
  virtual bool is_ready(SimTime /*at*/, const LinkEnd& /*from*/, const LinkEnd& /*to*/) { return true; }
  // The same of reception_without_capacity().
  virtual bool is_ready_for_packet(SimTime at, const LinkEnd& from, const LinkEnd& to) {
    return is_ready(at, from, to);
  }
  virtual bool are_ready(SimTime /*at*/, const std::vector<EndPair>& /*links*/) { return true; }
  // Whether answers depend on the bottom along the link: then reception() uses what is known of it, and
  // reception_over() the one that is given, from the one end to the other (null: unknown). The latter is not
  // to be called otherwise.
  virtual bool uses_bottom() const { return false; }
  // How far a place lies inside the seabed, m; 0 or less in the water, and where the seabed is not known.
  virtual double depth_inside_seabed_m(const Vec3& /*place_ned_m*/) const { return 0; }
  virtual Reception reception_over(SimTime at, const LinkEnd& from, const LinkEnd& to,
                                   const std::shared_ptr<const SeabedProfile>& seabed);
  // The link in full, as reception() computes it; here along the straight line.
  virtual LinkTracks tracks(SimTime at, const LinkEnd& from, const LinkEnd& to);
  // Whether an echo off one of these points of the bottom reaches the receiver above its cut-off.
  virtual bool echo_is_receivable(SimTime at, const acoustics::Modem& transmitter,
                                  const acoustics::Modem& receiver, const Vec3& from_ned_m,
                                  const Vec3& to_ned_m,
                                  const std::vector<acoustics::BottomPoint>& points) = 0;
  // The least loss of every link at a frequency between ends no deeper than `deepest_end_m`
  // (acoustics/link/least_loss.h); empty: levels have no bound by range.
  virtual std::optional<acoustics::LeastLoss> least_loss(SimTime /*at*/, double /*frequency_hz*/,
                                                         double /*deepest_end_m*/) const {
    return std::nullopt;
  }
  // Empty where weak links are computed as others, or the depth of the water is not known.
  virtual std::optional<WeakLinks> weak_links(SimTime /*at*/, double /*frequency_hz*/,
                                              double /*deepest_end_m*/) const {
    return std::nullopt;
  }
  // The water at `at`; valid until the next change.
  virtual const acoustics::Environment& environment(SimTime at) const = 0;
};

}  // namespace halocline::channel_server
