// SPDX-License-Identifier: BSD-3-Clause
// Traces one ray through water that changes smoothly along the link, over a range-dependent bottom.
//
// Model. Within a rectangle of acoustics/sea/ray_section.h the sound speed is a polynomial. With the vertical
// slowness s = sin / c and the slowness along the link xi = sqrt(1 / c^2 - s^2), Hamilton's equations in
// range (Jensen and others 2011, section 3.2) are
//   dz/dr = s / xi,  ds/dr = -c_z / (c^3 xi),  d tau/dr = 1 / (c^2 xi),
// and the equations of dynamic ray tracing (Cerveny 2001; section 3.3 of Jensen and others), with c_nn the
// second derivative across the ray, are
//   dq/dr = p / xi,  dp/dr = -q c_nn / (c^3 xi),  c_nn = c_rr sin^2 - 2 c_rz sin cos + c_zz cos^2.
// The fourth-order Runge-Kutta scheme integrates them in steps of at most 15 m. Steps end at edges of
// rectangles, at turns and at boundaries, so that all is analytic within a step. The bottom is found along
// the circle through a step's ends, to a millimetre, and then met by Newton's method. Speed and gradient are
// the same on both sides of an edge, so the ray tube does not change there. At boundaries it changes as in
// acoustics/rays/arc_tracer.h.
//
// Error: 1e-8 s and 1e-3 dB over 6 km, for the given section.
//
// Thread rule: immutable; threads may call at the same time.
//
// Neglected: rays that turn back towards the source; gradients across the link, which would bend rays out of
// its plane.
#pragma once

#include "acoustics/rays/arcs/arc_steps.h"
#include "acoustics/rays/ray_trace.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/ray_section.h"

namespace halocline::acoustics {

// Ends of the link: depth of the source, range of the receiver and depth of the bottom there.
struct SectionEnds {
  double source_depth_m, range_m, bottom_at_receiver_m;
};

class SectionTracer {
 public:
  // Refers to what the sea refers to, and to its section.
  SectionTracer(const ProfiledSea& sea, const BounceLosses& losses, const SectionEnds& ends)
      : section_(*sea.section), profile_(sea.profile), losses_(losses), ends_(ends) {}

  // Traces a ray with the results of ArcTracer::trace.
  void trace(double theta, RayTrace& ray, TraceDetails* details) const;

 private:
  // The variables of the equations. qx and px are the ray tube for rays as the facets reflect them, which
  // gives the slope of zeta.
  struct Carried {
    double z, s, q, p, qx, px;
  };
  // The derivatives of these variables along the range, and the place at which these were taken: depth, 1 / c
  // and xi.
  struct Stage {
    Carried slope;
    double z, per_c, xi;
  };
  struct State;
  struct Step;
  enum class Edge { kInside, kAbove, kBelow, kBottom };

  State start(double theta, RayTrace& ray) const;
  static Stage stage(const SpeedPatch& patch, double r, const Carried& at);
  static Step stepped(const State& s, double dr);
  Step next_step(const State& s) const;
  // The part of a step up to a depth above or below.
  static Step until_depth(const State& s, const Step& step, double depth_m, Edge edge);
  // The part of a step up to the bottom, or all of it.
  Step until_bottom(const State& s, const Step& step) const;
  void go(State& s, const Step& step, RayTrace& ray, TraceDetails* details) const;
  void add_details(const State& s, const Step& step, TraceDetails& details) const;
  void enter(State& s, const SectionCell& cell) const;
  // Handles the edge at which a step has ended; false when the ray stops there.
  [[nodiscard]] bool cross(State& s, const Step& step, RayTrace& ray, TraceDetails* details) const;
  [[nodiscard]] bool meet_surface(State& s, RayTrace& ray, TraceDetails* details) const;
  [[nodiscard]] bool meet_bottom(State& s, std::size_t facet, RayTrace& ray, TraceDetails* details) const;
  void arrive(const State& s, RayTrace& ray) const;

  const RaySection& section_;
  const BottomProfile& profile_;
  BounceLosses losses_;
  SectionEnds ends_;
};

}  // namespace halocline::acoustics
