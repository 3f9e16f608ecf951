// SPDX-License-Identifier: BSD-3-Clause
// Traces one ray through layered water over a range-dependent bottom, arc by arc, without step error.
//
// Terms. A knot is a tabulated depth of the sound speed profile, a layer lies between two knots, and a facet
// is a straight piece of the bottom profile.
//
// Model. Within a layer of gradient g the sine s of the ray's angle changes linearly with range, and the
// depth follows from it:
//   ds/dr = -xi g,
//   z2 - z1 = (r2 - r1)(s1 + s2) / (xi (c1 + c2)).
// The intersection with a straight piece of bottom is the root of a quadratic equation. Snell's invariant
// xi = cos(angle) / c changes only at a sloping bottom.
//
// Ray tube (Cerveny; Jensen and others 2011, section 3.3): q is the offset, across the ray, of the
// neighbouring ray per radian of launch angle, and p the change of its direction over c. They change as
// follows:
// - within a layer, q grows by p dr / xi;
// - at a knot, p decreases by q xi^2 (g2 - g1) / sin;
// - at the surface, p decreases by 2 q xi^2 g / sin;
// - at the bottom, p grows by q (g (xi + xi') cot G + 2 k / sin G) / c, with G the grazing angle and k the
//   bend of the bottom.
//
// Each change of q's sign is a caustic.
//
// Depth is unfolded, so that it does not jump where a bounce passes the receiver:
//   zeta = o z + 2 H k,
// with H the depth of the bottom at the receiver. The orientation o changes its sign at each bounce, and k
// grows by o at each bottom bounce.
//
// For water that changes along the link, acoustics/rays/section_tracer.h traces the rays instead.
//
// Thread rule: immutable between calls of trace, which may overlap between threads.
//
// Neglected: rays that turn back towards the source, and the slope of the bottom across the link. Tubes
// therefore widen across the plane as over a bottom that is the same all around the source, and over slopes
// amplitudes differ from those of the reversed link by the ratio of xi at the two ends.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "acoustics/rays/arcs/arc_steps.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/ray_trace.h"
#include "acoustics/rays/section_tracer.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

class ArcTracer {
 public:
  // The link is as in RayLink; depths at a boundary are moved off it by a micrometre.
  ArcTracer(const ProfiledSea& sea, const RayLink& link);

  // Traces the ray launched at `theta` to the receiver's range into `ray`, whose buffers are reused. A ray
  // stops when its bounces leave less than a quarter of the least boundary factor. With `details`, all sums
  // are computed, and exactly.
  void trace(double theta, RayTrace& ray, TraceDetails* details = nullptr) const;
  // Traces the ray past rising ranges, m, of which the last is at most the receiver's, in water that depends
  // on depth alone. At each range that the ray reaches it calls at(i, ray, details) with what trace() gives
  // for a receiver there, without the ray's events.
  using AtRange = std::function<void(std::size_t, const RayTrace&, const TraceDetails&)>;
  void trace_past(double theta, std::span<const double> ranges_m, const AtRange& at) const;

  // Moves the receiver to another depth, m; source, bottom and range stay the same.
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
  // True when the options exclude a ray launched at `theta` after `bounces`.
  bool is_excluded(double theta, int bounces) const { return losses_.is_excluded(theta, bounces); }
  const ProfiledSea& sea() const { return sea_; }

 private:
  struct State;
  State start(double theta, RayTrace& ray) const;
  void go(State& s, double dr, double z, double sine, RayTrace& ray, TraceDetails* details) const;
  void add_details(const State& s, double dr, double z, double sine, TraceDetails& details) const;
  void add_to_track(const State& s, double dr, double z, double sine, std::vector<RayPoint>& track) const;
  static void note_turn(bool lower, std::size_t layer, RayTrace& ray);
  // Moves the state to a point within a step, to the bottom, and to the end of a step. The latter two return
  // false when the ray stops there.
  void go_part(State& s, double dr, RayTrace& ray, TraceDetails* details) const;
  [[nodiscard]] bool go_to_bottom(State& s, const ArcHit& hit, RayTrace& ray, TraceDetails* details) const;
  [[nodiscard]] bool go_to_knot(State& s, const ArcStep& step, RayTrace& ray, TraceDetails* details) const;
  void cross_knot(State& s, bool down) const;
  [[nodiscard]] bool meet_surface(State& s, RayTrace& ray, TraceDetails* details) const;
  [[nodiscard]] bool meet_bottom(State& s, std::size_t facet, RayTrace& ray, TraceDetails* details) const;
  static void arrive(const State& s, double bottom_m, RayTrace& ray);

  ProfiledSea sea_;
  BounceLosses losses_;
  double source_depth_, receiver_depth_, range_, bottom_at_receiver_, source_speed_;
  std::size_t source_layer_, source_facet_;
  std::optional<SectionTracer> section_;  // present where the water changes along the link
};

}  // namespace halocline::acoustics
