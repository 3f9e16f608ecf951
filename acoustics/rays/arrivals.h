// One path of sound from a source to a receiver, and what all ray solvers agree on about paths.
//
// Conventions: depth is positive down from the flat mean surface, m; angles are from the horizontal, positive
// down, rad: a launch angle is the direction in which the ray leaves, an arrival angle the one in which it
// travels on when it meets the receiver. Amplitude is pressure relative to that at 1 m in free water, of the
// spreading of the ray tube and of reflections, without absorption (which depends most on frequency and is
// given beside it).
#pragma once

#include <compare>
#include <string_view>
#include <vector>

#include "core/units.h"

namespace halocline::acoustics {

// Identity of a path, the same from step to step as long as its ends move only little, so that its delay and Doppler
// can be tracked. Two paths of one link never have the same identity.
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
  // Mean over the range of cos(angle) / sound speed, s/m: by how much the delay grows with the range when the bottom
  // legs along. The launch slowness over a level bottom.
  double range_slowness_spm = 0;
  double path_length_m = 0;    // along the arcs
  double absorption_db = 0;    // along the arcs, at RayOptions::frequency_hz
  double surface_loss_db = 0;  // of all surface bounces, part of the amplitude
  double bottom_loss_db = 0;   // of all bottom bounces, part of the amplitude
  // Sums over the bounces of the squared sine of the grazing angle, by which rough boundaries scatter.
  double surface_sine_squares = 0, bottom_sine_squares = 0;
  int surface_bounces = 0, bottom_bounces = 0;
  int caustics = 0;  // touched on the way
  PathIdentity identity;

  // Pressure relative to that at 1 m with everything in it.
  double received_pressure() const;
};

enum class RaySolver { kImages, kSnell, kArcs };

// "images", "snell", "arcs".
std::string_view to_name(RaySolver solver);

// All paths of one link in the order of their delays.
struct Arrivals {
  RaySolver solver = RaySolver::kImages;  // the one that found them
  std::vector<Arrival> paths;

  // No ray at all: the receiver lies in a shadow zone. Diffraction and scattering, which ray theory leaves out, still
  // bring some sound there; FieldOptions::floor stands for it.
  bool shadow() const { return paths.empty(); }
};

// Limits of the search. The defaults keep what can matter to a modem.
struct RayOptions {
  double frequency_hz = 25'000;  // for absorption and reflection, 10..1e6
  // Paths are kept when launched within this of the horizontal, (0, pi/2].
  double max_launch_angle_rad = to_radians(80);
  // Also the path that meets neither surface nor bottom however steep it is: a vehicle right above another.
  bool keep_steep_direct = false;
  int max_bounces = 400;               // surface and bottom together, 0..10 000
  double min_boundary_factor = 0.005;  // paths whose bounces leave less of the pressure are dropped, [0, 1)
  double min_amplitude = 0;            // paths of less amplitude are dropped, >= 0; 1e-6 is -120 dB
};

// Throws InvalidArgument, naming the field, its value and what is allowed, unless every field is in range.
void validate(const RayOptions& options);

// Where the ends are. The receiver lies `range_m` >= 0 away; depths within the water.
struct RayLink {
  double source_depth_m = 0, receiver_depth_m = 0, range_m = 0;
};

// Last touches common to the solvers: drops what the options exclude, merges folds (paths alike, launched
// within 0.02 degrees of each other and arriving within 1 us: their amplitudes add as phasors do at the
// carrier), sorts by delay, numbers branches.
void finish(std::vector<Arrival>& paths, const RayOptions& options);

}  // namespace halocline::acoustics
