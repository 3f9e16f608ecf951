// SPDX-License-Identifier: BSD-3-Clause
// One path of sound from a source to a receiver, and what all ray solvers agree on about paths.
//
// Conventions: depth is positive down from the flat mean surface, m; angles are from the horizontal, positive
// down, rad: a launch angle is the direction in which the ray leaves, an arrival angle the one in which it
// travels on when it meets the receiver. Amplitude is pressure relative to that at 1 m in free water, of the
// spreading of the ray tube and of reflections, without absorption (which depends most on frequency and is
// given beside it).
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <vector>

#include "core/units.h"

namespace halocline::acoustics {

// Identity of a path, the same from step to step as long as its ends move only little, so that its delay and
// Doppler can be tracked. Two paths of one link never have the same identity.
struct PathIdentity {
  bool launched_up = false;
  int surface_bounces = 0, bottom_bounces = 0;
  int upper_turns = 0, lower_turns = 0;  // where the water itself bent the ray back, above and below
  int branch = 0;  // 0, 1, ... by rising launch angle among paths alike in all of the above
  auto operator<=>(const PathIdentity&) const = default;
};

struct Arrival {
  double delay_s = 0;
  double amplitude = 0;  // above 0: spreading and bounces
  double phase_rad = 0;  // 0..2 pi: pi a surface bounce, the bottom's own, pi / 2 a caustic
  double launch_angle_rad = 0;
  double arrival_angle_rad = 0;
  double launch_slowness_spm = 0;  // cos(launch angle) / sound speed at the source, s/m: Snell's invariant
  // Mean over the range of cos(angle) / sound speed, s/m: by how much the delay grows with the range when the
  // bottom legs along. The launch slowness over a level bottom.
  double range_slowness_spm = 0;
  double path_length_m = 0;    // along the arcs
  double absorption_db = 0;    // along the arcs, at RayOptions::frequency_hz
  double surface_loss_db = 0;  // of all surface bounces, part of the amplitude
  double bottom_loss_db = 0;   // of all bottom bounces, part of the amplitude
  // Sums over the bounces of the squared sine of the grazing angle, by which rough boundaries scatter.
  double surface_sine_squares = 0, bottom_sine_squares = 0;
  int surface_bounces = 0, bottom_bounces = 0;
  int caustics = 0;  // touched on the way
  // Not one path: all rays within a window of launch angles that are not sought one by one
  // (acoustics/rays/diffuse_windows.h). The amplitude is the root of their mean power, the phase stands for
  // none, the rest is that of a ray among them.
  bool diffuse = false;
  PathIdentity identity;

  // Pressure relative to that at 1 m with everything in it.
  double received_pressure() const;
  // Of all bounces.
  double bounce_loss_db() const { return surface_loss_db + bottom_loss_db; }
};

// The same angle within 0..2 pi, rad.
inline double positive_angle(double angle_rad) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return angle_rad - kTurn * std::floor(angle_rad / kTurn);
}

enum class RaySolver { kImages, kSnell, kArcs };

// "images", "snell", "arcs".
std::string_view to_name(RaySolver solver);

// Why a link has no path.
enum class PathLack {
  kShadow,    // no ray arrives at all: the water bends every one away, or the bottom stands in every way
  kTooWeak,   // rays arrive; their bounces, or RayOptions::min_amplitude, leave none of them
  kTooSteep,  // rays arrive, all launched more steeply than RayOptions::max_launch_angle_rad
};

// "shadow", "too weak", "too steep".
std::string_view to_name(PathLack lack);

// All paths of one link in the order of their delays.
struct Arrivals {
  RaySolver solver = RaySolver::kImages;  // the one that found them
  std::vector<Arrival> paths;
  PathLack lack = PathLack::kShadow;  // holds when there is no path

  bool silent() const { return paths.empty(); }
  // The receiver lies in a shadow zone. Diffraction and scattering, which ray theory leaves out, still bring
  // some sound there; FieldOptions::floor stands for it.
  bool shadow() const { return silent() && lack == PathLack::kShadow; }
  // Sum of the powers of what is diffuse, relative to that at 1 m, with everything in it.
  double diffuse_power() const;
};

// Limits of the search. The defaults keep what can matter to a modem.
struct RayOptions {
  double frequency_hz = 25'000;  // for absorption and reflection, 10..1e6
  // Paths are kept when launched within this of the horizontal, (0, pi/2].
  double max_launch_angle_rad = to_radians(80);
  // Also the path that meets neither surface nor bottom however steep it is: a vehicle right above another.
  bool keep_steep_direct = true;
  int max_bounces = 400;  // surface and bottom together, 0..10 000
  // Paths are dropped whose bounces leave less than this of what those of the strongest path leave, [0, 1).
  // The strongest is kept whatever it loses; while it loses less than 6 dB, paths are compared with one that
  // does not bounce.
  double min_boundary_factor = 0.005;
  double min_amplitude = 0;  // paths of less amplitude are dropped, >= 0; 1e-6 is -120 dB
  // Over a rough bottom, where rays are many, paths more than this below the strongest are not sought one by
  // one: their energy comes in windows, Arrival::diffuse. 10..100, dB; 0: every ray is sought everywhere.
  double diffuse_below_db = 22;
  // Nor those whose received pressure, relative to that at 1 m, is less than this; >= 0.
  double diffuse_below_pressure = 0;
  // Near caustics the field of waves, and one path on their dark side; else rays as they are, without bound
  // there.
  bool airy_folds = true;
  bool operator==(const RayOptions&) const = default;
};

// Throws InvalidArgument, naming the field, its value and what is allowed, unless every field is in range.
void validate(const RayOptions& options);

// With what bounces may leave in steps of 10 dB, so that receivers whose strongest paths lose about as much
// share their rays.
RayOptions widened(RayOptions options);
// Drops paths whose bounces leave less than the options allow.
void drop_faint(std::vector<Arrival>& paths, const RayOptions& options);

// Where the ends are. The receiver lies `range_m` >= 0 away; depths within the water.
struct RayLink {
  double source_depth_m = 0, receiver_depth_m = 0, range_m = 0;
};

// The distance at which source levels are defined, m: sound does not spread within it. Paths between ends
// nearer to each other are those of ends so far apart, extrapolated: delay, length and angles are those of
// the true distance.
inline constexpr double kMinDistance = 1;
// The same link with its range so great that the ends are that far apart.
RayLink held_apart(RayLink link);

// A number for `family` continued by `what`: rays between whose launch angles range and depth of arrival
// change smoothly share theirs.
constexpr std::uint64_t continued_family(std::uint64_t family, std::uint64_t what) {
  // A step like those of SplitMix64 (Steele and others 2014).
  family = (family ^ (what + 1)) * 0x9E3779B97F4A7C15ULL;
  return family ^ (family >> 29);
}

// What makes two rays neighbours of one fold: a family within which range and depth of arrival change
// smoothly, and the angle by which its rays follow each other, rad. A path without a family has no
// neighbours.
struct FoldMember {
  std::uint64_t family = 0;
  double order_rad = 0;
  int touched = 0;       // of the caustics of the family
  double phase_rad = 0;  // beside what all of the family have
  double x = 0;          // of the fold with its neighbour (acoustics/math/fold_field.h); 0: by the delays
};
inline constexpr std::uint64_t kNoFamily = 0;

// Last touches common to the solvers: gives the rays of folds the field of acoustics/math/fold_field.h if
// RayOptions::airy_folds, drops what the options exclude, merges paths alike, launched within 0.02 degrees of
// each other and arriving within 1 us (their amplitudes add as phasors do at the carrier), sorts by delay,
// numbers branches. `members` of all paths. The rays of a fold are next to each other in a family, and one
// has touched a caustic more. A ray whose partner is missing, because its family ends before the caustic (at
// a kink of the water, at an edge of the bottom), keeps the level of its tube.
void finish(std::vector<Arrival>& paths, const std::vector<FoldMember>& members, const RayOptions& options);

}  // namespace halocline::acoustics
