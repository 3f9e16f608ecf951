// SPDX-License-Identifier: BSD-3-Clause
// Traces one ray through water that changes smoothly along the link, over a bottom that does.
//
// Model: within a rectangle of acoustics/sea/ray_section.h sound speed is a polynomial. With s = sin / c the
// vertical slowness and xi = sqrt(1 / c^2 - s^2) that along the link, Hamilton's equations in range (Jensen
// and others 2011, section 3.2) are
//   dz/dr = s / xi,  ds/dr = -c_z / (c^3 xi),  d tau/dr = 1 / (c^2 xi),
// and dynamic ray tracing (Cerveny 2001; section 3.3 there), c_nn the second derivative across the ray,
//   dq/dr = p / xi,  dp/dr = -q c_nn / (c^3 xi),  c_nn = c_rr sin^2 - 2 c_rz sin cos + c_zz cos^2.
// Runge and Kutta's scheme of fourth order takes them along in steps of at most 15 m that end at edges
// of rectangles, at turns and at boundaries, so that within a step all is analytic; the bottom is sought
// along the circle through a step's ends, a millimetre off at most, and met by Newton's method. Speed and
// gradient are the same on both sides of an edge: nothing happens to the tube there. The tube at boundaries
// is that of acoustics/rays/arc_tracer.h.
//
// Error: 1e-8 s and 1e-3 dB over 6 km, for the section given. Immutable: calls may overlap between threads.
// Left out: rays that turn back; gradients across the link, which turn rays out of its plane.
#pragma once

#include <array>
#include <vector>

#include "acoustics/rays/arcs/arc_steps.h"
#include "acoustics/rays/traced_ray.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/ray_section.h"

namespace halocline::acoustics {

struct SectionEnds {
  double source_depth_m, range_m, bottom_at_receiver_m;
};

class SectionTracer {
 public:
  // Refers to what the sea refers to, and to its section.
  SectionTracer(const ProfiledSea& sea, const BounceLosses& losses, const SectionEnds& ends)
      : section_(*sea.section), profile_(sea.profile), losses_(losses), ends_(ends) {}

  // As ArcTracer::trace.
  void trace(double theta, TracedRay& ray, TracedDetails* details) const;

 private:
  // What the equations carry along; qx and px are the tube of rays as they are reflected, facet by facet: the
  // slope of zeta.
  struct Carried {
    double z, s, q, p, qx, px;
  };
  // Its derivative along range, and where it was taken.
  struct Stage {
    Carried slope;
    double z, per_c, xi;
  };
  struct State;
  struct Step;
  enum class Edge { kInside, kAbove, kBelow, kBottom };

  State start(double theta, TracedRay& ray) const;
  static Stage stage(const SpeedPatch& patch, double r, const Carried& at);
  static Step stepped(const State& s, double dr);
  Step next_step(const State& s) const;
  // The step that ends at a depth above or below, within this one.
  static Step until_depth(const State& s, const Step& step, double depth_m, Edge edge);
  Step until_bottom(const State& s, const Step& step) const;
  void go(State& s, const Step& step, TracedRay& ray, TracedDetails* details) const;
  void add_details(const State& s, const Step& step, TracedDetails& details) const;
  void enter(State& s, const SectionCell& cell) const;
  // At the edge where a step has ended; false when the ray is given up there.
  [[nodiscard]] bool cross(State& s, const Step& step, TracedRay& ray, TracedDetails* details) const;
  [[nodiscard]] bool meet_surface(State& s, TracedRay& ray, TracedDetails* details) const;
  [[nodiscard]] bool meet_bottom(State& s, std::size_t facet, TracedRay& ray, TracedDetails* details) const;
  void arrive(const State& s, TracedRay& ray) const;

  const RaySection& section_;
  const BottomProfile& profile_;
  BounceLosses losses_;
  SectionEnds ends_;
};

}  // namespace halocline::acoustics
