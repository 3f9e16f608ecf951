// Traces one ray through water that changes along the link, over a bottom that does, triangle by triangle, without step error.
//
// Model: within a triangle of acoustics/sea/ray_section.h, c = c0 + g . (x - x0), g = (a, b) along and down, a ray of direction
// t = (cos, sin) of its angle, positive down, and normal n = (-sin, cos) has the curvature kappa = -(g . n) / c all along: an
// arc of a circle. With a straight edge at the distance d along its normal m the arc meets where t . m has become
//   t' . m = sqrt(1 - (n . m - kappa d)^2),  w = 2 d / (t . m + t' . m),
// w = 2 tan(kappa s / 2) / kappa, s the length of the arc: its chord L is w / sqrt(1 + (kappa w / 2)^2), which leaves by
// X = w / (1 + (kappa w / 2)^2) along t and kappa L^2 / 2 along n. From this follow
//   time = 2 / |g| asinh(|g| L / (2 sqrt(c1 c2))),  length = 2 / kappa asin(kappa L / 2).
// The ray tube is that of acoustics/rays/arc_tracer.h; dq/ds = c p, dp/ds = -q c_nn / c^2 (Cerveny 2001) give
//   q' = q + p (c X + (g . t) L^2 / 2) within a triangle,
//   p' = p - q ((g' - g) . m) (1 - (t . m)^2) / (c^2 (t . m)) where the gradient jumps, at an edge of normal m ahead.
// At the surface and at the bottom the mirrored water's gradient takes the place of g'.
//
// Error: rounding (1e-9 s), for the triangles given. Immutable: calls may overlap between threads. Left out: rays that turn
// back; gradients across the link, which turn rays out of its plane.
#pragma once

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
  enum class Edge { kAbove, kBelow, kDiagonal, kEnd, kReceiver, kNone };
  struct State;
  struct Step;
  State start(double theta, TracedRay& ray) const;
  Step next_step(const State& s) const;
  // Along the arc by a range, to a direction of that sine and a depth.
  void go(State& s, double dr, double z, double sine, TracedRay& ray, TracedDetails* details) const;
  void add_details(const State& s, double dr, double z, double sine, TracedDetails& details) const;
  static void add_to_track(const State& s, double dr, double z, std::vector<RayPoint>& track);
  // Into the triangle beyond an edge; false when the ray is given up there.
  [[nodiscard]] bool cross(State& s, const Step& step, TracedRay& ray, TracedDetails* details) const;
  void bend_tube(State& s, const SpeedGradient& before, double along, double down) const;
  [[nodiscard]] bool meet_surface(State& s, TracedRay& ray, TracedDetails* details) const;
  [[nodiscard]] bool meet_bottom(State& s, const ArcHit& hit, TracedRay& ray, TracedDetails* details) const;
  void arrive(const State& s, TracedRay& ray) const;

  const RaySection& section_;
  const BottomProfile& profile_;
  BounceLosses losses_;
  SectionEnds ends_;
};

}  // namespace halocline::acoustics
