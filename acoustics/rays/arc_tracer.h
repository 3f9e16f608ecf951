// SPDX-License-Identifier: BSD-3-Clause
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
// Where the water changes along the link, acoustics/rays/section_tracer.h takes its place.
//
// Immutable between calls of trace, which may overlap between threads. Left out: rays that turn back; the
// bottom's slope across the link, so tubes widen across the plane as over a bottom that is the same all
// around the source (which makes amplitudes over slopes differ from those of the swapped link by the ratio of
// xi at both ends).
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "acoustics/rays/arcs/arc_steps.h"
#include "acoustics/rays/arrivals.h"
#include "acoustics/rays/section_tracer.h"
#include "acoustics/rays/traced_ray.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

class ArcTracer {
 public:
  // Link as RayLink; depths are moved a micrometre off the boundaries.
  ArcTracer(const ProfiledSea& sea, const RayLink& link);

  // Traces the ray of `theta` to the receiver's range into `ray` (whose buffers are used again). Rays that
  // bounces leave less than a quarter of the least factor are given up. With `details`, all sums are taken,
  // and exactly.
  void trace(double theta, TracedRay& ray, TracedDetails* details = nullptr) const;
  // Traces the ray past rising ranges, m, the last of them the receiver's at most, in water of depth alone.
  // At each that it reaches calls at(i, ray, details) with what trace() gives for a receiver there, but for
  // the ray's events.
  using AtRange = std::function<void(std::size_t, const TracedRay&, const TracedDetails&)>;
  void trace_past(double theta, std::span<const double> ranges_m, const AtRange& at) const;

  // The same source, bottom and range for a receiver at another depth.
  void move_receiver(double depth_m);

  double source_depth_m() const { return source_depth_; }
  double receiver_depth_m() const { return receiver_depth_; }
  double range_m() const { return range_; }
  double bottom_at_receiver_m() const { return bottom_at_receiver_; }
  double source_speed_mps() const { return source_speed_; }
  const RayWater& water_at_receiver() const {
    return sea_.section != nullptr ? sea_.section->columns().back() : sea_.water;
  }
  std::size_t source_layer() const { return source_layer_; }
  std::size_t source_facet() const { return source_facet_; }
  // Whether the options exclude a ray launched at `theta` after `bounces`.
  bool is_excluded(double theta, int bounces) const { return losses_.is_excluded(theta, bounces); }
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
  static void arrive(const State& s, double bottom_m, TracedRay& ray);

  ProfiledSea sea_;
  BounceLosses losses_;
  double source_depth_, receiver_depth_, range_, bottom_at_receiver_, source_speed_;
  std::size_t source_layer_, source_facet_;
  std::optional<SectionTracer> section_;  // where water changes along the link
};

}  // namespace halocline::acoustics
