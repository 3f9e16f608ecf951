// Traces one ray through layered water over a bottom that changes with range, arc by arc, without step
// error.
//
// Model: within a layer of gradient g the sine s of the ray's angle falls evenly with range, ds/dr = -xi g,
// and depth follows from z2 - z1 = (r2 - r1)(s1 + s2) / (xi (c1 + c2)); the meeting with a straight piece of
// bottom is the root of a quadratic. xi = cos(angle)/c changes at sloping bottom only. The ray tube: q, how
// far the neighbouring ray of launch angle 1 rad more is off, across the ray, and p, its change of direction
// over c (Cerveny; Jensen and others 2011, section 3.3):
//   q grows by p dr / xi within a layer; at a knot p loses q xi^2 (g2 - g1) / sin; at the surface 2 q xi^2 g
//   / sin;
//   at the bottom it gains q (g (xi + xi') cot G + 2 k / sin G) / c, G the grazing angle and k the bend of
//   the bottom.
// Each change of q's sign is a caustic. Depth is unfolded, so that it does not jump where a bounce passes the
// receiver: zeta = o z + 2 H k, H the depth at the receiver, o flips at each bounce, k grows by o at the
// bottom.
//
// Immutable between calls of trace, which may overlap between threads. Left out: rays that turn back; the
// bottom's slope across the link, so tubes widen across the plane as over a bottom that is the same all
// around the source (which makes amplitudes over slopes differ from those of the swapped link by the ratio of
// xi at both ends).
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "acoustics/rays/arc_steps.h"
#include "acoustics/rays/arrivals.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

// A sea whose bottom changes along the link. Refers to water and profile, which have to outlive the call.
struct ProfiledSea {
  const RayWater& water;
  const BottomProfile& profile;  // ranges from the source
  FluidBottom bottom;
  RaySurface surface;
  RayOptions options;
  double core_speed_mps = 0;  // rays that nowhere go faster are left out: acoustics/rays/channel_core.h
};

// What happened to a ray, in order; what makes two rays members of one smooth family.
enum class RayEvent : std::uint8_t { kSurface, kUpperTurn, kLowerTurn, kBottom };
struct EventCode {
  RayEvent event;
  std::uint16_t group;  // of the facet, at the bottom; 0 elsewhere
  bool operator==(const EventCode&) const = default;
};

struct TracedRay {
  double theta = 0;                // launch angle, rad, positive down
  bool arrived = false;            // false: too faint, turned back or too many bounces
  double zeta = 0;                 // unfolded depth at the receiver's range, m
  double zeta_slope = 0;           // d zeta / d theta of the rays as they are
  double z = 0, sine = 0, xi = 0;  // at the receiver's range
  double q = 0, p = 0;             // of the ray tube
  double factor = 1;               // of pressure, by the bounces
  int surface_bounces = 0, bottom_bounces = 0, upper_turns = 0, lower_turns = 0, caustics = 0;
  std::uint64_t family = 0;  // rays of the same events that turned in the same layers share it: arrivals.h
  std::vector<EventCode> events;
};

// A point on a ray's way, m: horizontal range from the source, depth below the surface.
struct RayPoint {
  double range_m, depth_m;
};

// Sums that an eigenray needs besides.
struct TracedDetails {
  double delay_s = 0, length_m = 0, absorption_db = 0, bottom_phase_rad = 0, bottom_loss_db = 0,
         surface_loss_db = 0, surface_sine_squares = 0, bottom_sine_squares = 0;
  double slowness_over_range = 0;  // sum of xi dr, s
  // Where not null, takes the ray's way from behind the source to the receiver's range: the ends of all arcs, and points
  // on them between which the straight line stays within kTrackErrorM of the arc (32 pieces of an arc at most).
  std::vector<RayPoint>* track = nullptr;
  static constexpr double kTrackErrorM = 0.1;
};

class ArcTracer {
 public:
  // Link as RayLink; depths are moved a micrometre off the boundaries.
  ArcTracer(const ProfiledSea& sea, const RayLink& link);

  // Traces the ray of `theta` to the receiver's range into `ray` (whose buffers are used again). Rays that
  // bounces leave less than a quarter of the least factor are given up. With `details`, all sums are taken,
  // and exactly.
  void trace(double theta, TracedRay& ray, TracedDetails* details = nullptr) const;

  double source_depth_m() const { return source_depth_; }
  double receiver_depth_m() const { return receiver_depth_; }
  double range_m() const { return range_; }
  double bottom_at_receiver_m() const { return bottom_at_receiver_; }
  double source_speed_mps() const { return source_speed_; }
  std::size_t source_layer() const { return source_layer_; }
  std::size_t source_facet() const { return source_facet_; }
  // Whether the options exclude a ray launched at `theta` after `bounces`.
  bool is_excluded(double theta, int bounces) const {
    return bounces > sea_.options.max_bounces ||
           (bounces > 0 && std::abs(theta) > sea_.options.max_launch_angle_rad);
  }
  const ProfiledSea& sea() const { return sea_; }

 private:
  struct State;
  State start(double theta, TracedRay& ray) const;
  void go(State& s, double dr, double z, double sine, TracedRay& ray, TracedDetails* details) const;
  void add_details(const State& s, double dr, double z, double sine, TracedDetails& details) const;
  void add_to_track(const State& s, double dr, double z, double sine, std::vector<RayPoint>& track) const;
  static void note_turn(bool lower, std::size_t layer, TracedRay& ray);
  // To a point within a step, to the bottom, to the end of a step; false when the ray is given up there.
  void go_part(State& s, double dr, TracedRay& ray, TracedDetails* details) const;
  [[nodiscard]] bool go_to_bottom(State& s, const ArcHit& hit, TracedRay& ray, TracedDetails* details) const;
  [[nodiscard]] bool go_to_knot(State& s, const ArcStep& step, TracedRay& ray, TracedDetails* details) const;
  void cross_knot(State& s, bool down) const;
  [[nodiscard]] bool meet_surface(State& s, TracedRay& ray, TracedDetails* details) const;
  [[nodiscard]] bool meet_bottom(State& s, std::size_t facet, TracedRay& ray, TracedDetails* details) const;
  void arrive(const State& s, TracedRay& ray) const;
  double rough_bottom_factor(double sine) const;

  ProfiledSea sea_;
  SurfaceLoss surface_loss_;
  double source_depth_, receiver_depth_, range_, bottom_at_receiver_, source_speed_, min_factor_;
  std::size_t source_layer_, source_facet_;
  std::vector<double> bottom_factor_;  // at sines 0..1, evenly: enough to give up faint rays by
};

}  // namespace halocline::acoustics
