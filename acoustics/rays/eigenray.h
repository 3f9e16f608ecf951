// SPDX-License-Identifier: BSD-3-Clause
// Eigenray: one path of sound from a source to a receiver, and the conventions common to all ray solvers.
//
// Conventions:
// - Depth is positive down from the flat mean surface, m.
// - Angles are measured from the horizontal, positive down, rad. The launch angle is the direction in which
//   the ray leaves, the arrival angle the one in which it travels as it meets the receiver.
// - The amplitude is the pressure relative to that at 1 m in free water. It includes the spreading of the ray
//   tube and the reflections, but not the absorption, which depends most on frequency and is a field of its
//   own.
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <vector>

#include "acoustics/sea/fine_structure.h"
#include "core/units.h"

namespace halocline::acoustics {

// Identity of a path. It stays the same from step to step as long as the ends move only little, so that delay
// and Doppler shift can be tracked. Two paths of one link never have the same identity.
struct PathIdentity {
  bool launched_up = false;
  int surface_bounces = 0, bottom_bounces = 0;
  int upper_turns = 0, lower_turns = 0;  // turns in the water itself, above and below
  int branch = 0;  // 0, 1, ... by rising launch angle among paths that agree in all of the above
  auto operator<=>(const PathIdentity&) const = default;

  // The identity packed into one number. Each count is truncated to its low bits: 14 for bounces and turns, 7
  // for the branch.
  std::uint64_t number() const;
  // The identity with that number.
  static PathIdentity of_number(std::uint64_t number);
};

// Geometry of a path between two ends, and what the sea leaves of its sound.
struct Eigenray {
  double delay_s = 0;
  double amplitude = 0;  // above 0; spreading and bounces
  // 0..2 pi: pi per surface bounce, the bottom's own per bottom bounce, pi / 2 per caustic.
  double phase_rad = 0;
  double launch_angle_rad = 0;
  double arrival_angle_rad = 0;
  double launch_slowness_spm = 0;  // cos(launch angle) / sound speed at the source, s/m: Snell's invariant
  // Mean over the range of cos(angle) / sound speed, s/m: the growth of the delay per metre of range if the
  // bottom at the receiver moves along with it. Over a level bottom it equals the launch slowness.
  double range_slowness_spm = 0;
  double path_length_m = 0;    // along the arcs
  double absorption_db = 0;    // along the arcs, at RayOptions::frequency_hz
  double surface_loss_db = 0;  // all surface bounces; part of the amplitude
  double bottom_loss_db = 0;   // all bottom bounces; part of the amplitude
  // Sums over the bounces of the squared sine of the grazing angle, which scattering by rough boundaries
  // depends on.
  double surface_sine_squares = 0, bottom_sine_squares = 0;
  int surface_bounces = 0, bottom_bounces = 0;
  int caustics = 0;  // number of caustics touched
  // True for a diffuse path: not one path but all rays within a window of launch angles that are not
  // resolved one by one (acoustics/rays/diffuse_windows.h). The amplitude is the root of their mean total
  // power and the phase has no meaning; the other fields are those of one ray among them.
  bool diffuse = false;
  PathIdentity identity = {};

  // Received pressure relative to that at 1 m, absorption included.
  double received_pressure() const;
  // Loss of all bounces, dB.
  double bounce_loss_db() const { return surface_loss_db + bottom_loss_db; }
};

// The angle reduced to 0..2 pi, rad.
inline double positive_angle(double angle_rad) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return angle_rad - kTurn * std::floor(angle_rad / kTurn);
}

enum class RaySolver { kImages, kSnell, kArcs };

// Name of a solver: "images", "snell" or "arcs".
std::string_view to_name(RaySolver solver);

// The reason why a link has no path.
enum class PathLack {
  kShadow,    // no ray arrives: refraction bends every one away, or the bottom blocks it
  kTooWeak,   // rays arrive, but their bounces or RayOptions::min_amplitude exclude all of them
  kTooSteep,  // rays arrive, but all are launched more steeply than RayOptions::max_launch_angle_rad
};

// Name of the reason: "shadow", "too weak" or "too steep".
std::string_view to_name(PathLack lack);

// The paths of one link in the order of their delays.
struct Eigenrays {
  RaySolver solver = RaySolver::kImages;  // the solver that found them
  std::vector<Eigenray> paths;
  PathLack lack = PathLack::kShadow;  // valid when there is no path

  bool silent() const { return paths.empty(); }
  // True when the receiver lies in a shadow zone. Diffraction and scattering, which ray theory neglects,
  // still bring some sound there; FieldOptions::floor represents it.
  bool shadow() const { return silent() && lack == PathLack::kShadow; }
  // Sum of the powers of the diffuse paths, relative to that at 1 m, absorption included.
  double diffuse_power() const;
};

// What rough boundaries take from the coherent share exp(-sum) of a path's power, for paths of which only
// that share counts: nepers of each bounce per squared sine of its grazing angle, >= 0.
struct BounceScattering {
  // Paths of two bounces or more that lose more than this have no coherent share left, 2e-9.
  static constexpr double kMaxNepers = 20;
  double surface = 0, bottom = 0;
  double nepers(double surface_sine_squares, double bottom_sine_squares) const {
    return surface * surface_sine_squares + bottom * bottom_sine_squares;
  }
  bool leaves_none(int bounces, double nepers) const { return bounces > 1 && nepers > kMaxNepers; }
  bool scatters() const { return surface > 0 || bottom > 0; }
  bool operator==(const BounceScattering&) const = default;
};

// Limits of the search. The defaults keep every path that can matter to a modem.
struct RayOptions {
  double frequency_hz = 25'000;  // for absorption and reflection, 10..1e6
  // Greatest angle from the horizontal at which paths are launched, (0, pi/2].
  double max_launch_angle_rad = to_radians(80);
  // Also keep the path that meets neither surface nor bottom, however steep it is: one vehicle may be right
  // above another.
  bool keep_steep_direct = true;
  int max_bounces = 400;  // surface and bottom bounces together, 0..10 000
  // Least boundary factor, [0, 1): paths are dropped whose bounces leave less than this share of what the
  // bounces of the strongest path leave. The strongest path is kept whatever it loses. While it loses less
  // than 6 dB, paths are compared with one without bounces.
  double min_boundary_factor = 0.005;
  double min_amplitude = 0;  // paths below this amplitude are dropped, >= 0; 1e-6 is -120 dB
  // Over a rough bottom, where rays are many, paths more than this below the strongest are not resolved one
  // by one: their energy is summed over windows of launch angles, see Eigenray::diffuse. 10..100, dB; 0:
  // every ray is resolved everywhere.
  double diffuse_below_db = 22;
  // Over a rough bottom, paths more than this below the energy flux of all rays are not resolved one by one
  // either. Unlike a limit by pressure it gives every source level the same paths. 10..100, dB; 0: no limit.
  double diffuse_below_flux_db = 0;
  // Received pressure, relative to that at 1 m, below which paths are not resolved one by one either; >= 0.
  double diffuse_below_pressure = 0;
  BounceScattering scattering = {};  // paths that it leaves no coherent share are dropped
  // True: near caustics the wave field applies, with one path on their shadow side. False: plain ray theory,
  // whose amplitudes are unbounded there.
  bool airy_folds = true;
  // Irregularity of the water, which smooths folds and cusps (acoustics/rays/search/smoothed_folds.h). A
  // perfect medium leaves paths as they are.
  FineStructure fine_structure = {};
  // Vertical movement of each end from packet to packet, m rms, 0..5; it adds to that smoothing.
  double platform_jitter_m = 0;
  bool operator==(const RayOptions&) const = default;
};

// Throws InvalidArgument, naming the field, its value and the permitted range, unless every field is in
// range.
void validate(const RayOptions& options);

// The options with the least boundary factor lowered to a multiple of 10 dB, so that receivers whose
// strongest paths lose about as much share their rays.
RayOptions widened(RayOptions options);
// Drops paths whose bounces leave less than the options allow.
void drop_faint(std::vector<Eigenray>& paths, const RayOptions& options);

// The ends of a link. The receiver lies `range_m` >= 0 from the source; both depths lie within the water.
struct RayLink {
  double source_depth_m = 0, receiver_depth_m = 0, range_m = 0;
};

// The distance at which source levels are defined, m. Sound does not spread within it: the paths between ends
// closer to each other are those of ends at this distance, extrapolated so that delay, length and angles are
// those of the true distance.
inline constexpr double kMinDistance = 1;
// The link with its range increased, if necessary, so that the ends are kMinDistance apart.
RayLink held_apart(RayLink link);

// The number of family `family` continued by the event `what`. Rays have the same number when range and depth
// of arrival change smoothly with the launch angle between them.
constexpr std::uint64_t continued_family(std::uint64_t family, std::uint64_t what) {
  // A mixing step like those of SplitMix64 (Steele and others 2014).
  family = (family ^ (what + 1)) * 0x9E3779B97F4A7C15ULL;
  return family ^ (family >> 29);
}

// The place of a path among those that may form a fold with it: a family within which range and depth of
// arrival change smoothly, and the angle that orders its rays, rad. A path of kNoFamily has no neighbours.
struct FoldMember {
  std::uint64_t family = 0;
  double order_rad = 0;
  int touched = 0;       // caustics of the family that the ray has touched
  double phase_rad = 0;  // phase beyond that common to the family
  double x = 0;          // x of the fold with its neighbour (acoustics/math/fold_field.h); 0: from the delays
};
inline constexpr std::uint64_t kNoFamily = 0;

// The last steps common to all solvers:
// - gives the rays of folds the field of acoustics/math/fold_field.h, if RayOptions::airy_folds;
// - drops what the options exclude;
// - merges paths of the same kind launched within 0.02 degrees of each other that arrive within 1 us; their
//   amplitudes add as phasors at the carrier;
// - sorts by delay and numbers the branches.
//
// `members` has an entry for each path. The two rays of a fold are neighbours in a family, and one has
// touched one caustic more. A ray without a partner, because its family ends before the caustic (at a kink of
// the sound speed profile or an edge of the bottom), keeps the amplitude of its ray tube.
void finish(std::vector<Eigenray>& paths, const std::vector<FoldMember>& members, const RayOptions& options);

}  // namespace halocline::acoustics
