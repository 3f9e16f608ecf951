// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/section_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "acoustics/math/hermite_cubic.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr std::uint64_t kTurnOfSection = 100'000;  // family numbers of turns follow those of facets
constexpr int kMaxSteps = 1'000'000;               // per ray: a guard that is never reached
constexpr double kLongestStep = 15;                // m along the ray
constexpr double kOnEdge = 1e-9;                   // m
constexpr double kMinShare = 1e-6;                 // share of a step: a turn closer than that has been passed
constexpr int kMaxCorrections = 4;                 // Newton steps to the end of a step: a guard, two suffice

}  // namespace

struct SectionTracer::State {
  double r;
  Carried ray;
  SectionCell cell;
  SpeedPatch patch;
  double c, xi, sine, cosine;  // at the present place
  Stage first;                 // first stage of the next step
  std::size_t facet;
  bool on_facet = false;
  double orientation = 1, images = 0;  // o and k of zeta

  // Updates what depends on the place.
  void look() {
    c = patch.at(r, ray.z).c;
    sine = ray.s * c;
    cosine = std::sqrt(std::max(1 - sine * sine, 0.0));
    xi = cosine / c;
    first = stage(patch, r, ray);
  }
};

struct SectionTracer::Step {
  double dr;
  Carried end;
  std::array<Stage, 4> stages;
  Edge edge = Edge::kInside;
  std::size_t facet = 0;
};

// The derivatives of section_tracer.h, with c_nn the second derivative of the sound speed across the ray:
//   dz/dr = s / xi,  ds/dr = -c_z / (c^3 xi),  dq/dr = p / xi,  dp/dr = -q c_nn / (c^3 xi)
SectionTracer::Stage SectionTracer::stage(const SpeedPatch& patch, double r, const Carried& at) {
  const LocalSpeed speed = patch.at(r, at.z);
  const double per_c = 1 / speed.c, sine = at.s * speed.c;
  const double cosine = std::sqrt(std::max(1 - sine * sine, kMinCosine * kMinCosine));
  const double per_xi = speed.c / cosine, bend = per_c * per_c / cosine;
  const double across = speed.along_along * sine * sine - 2 * speed.along_down * sine * cosine +
                        speed.down_down * cosine * cosine;
  return {{at.s * per_xi, -speed.down * bend, at.p * per_xi, -at.q * across * bend, at.px * per_xi,
           -at.qx * across * bend},
          at.z,
          per_c,
          cosine * per_c};
}

// One step of the fourth-order Runge-Kutta scheme:
//   y(r + dr) = y + dr (k1 + 2 k2 + 2 k3 + k4) / 6
SectionTracer::Step SectionTracer::stepped(const State& s, double dr) {
  const auto moved = [&s](const Carried& d, double by) {
    const Carried& a = s.ray;
    return Carried{a.z + by * d.z, a.s + by * d.s,   a.q + by * d.q,
                   a.p + by * d.p, a.qx + by * d.qx, a.px + by * d.px};
  };
  Step step{dr, {}, {}};
  auto& k = step.stages;
  k[0] = s.first;
  k[1] = stage(s.patch, s.r + dr / 2, moved(k[0].slope, dr / 2));
  k[2] = stage(s.patch, s.r + dr / 2, moved(k[1].slope, dr / 2));
  k[3] = stage(s.patch, s.r + dr, moved(k[2].slope, dr));
  const auto mean = [&k](double Carried::*of) {
    return (k[0].slope.*of + 2 * (k[1].slope.*of + k[2].slope.*of) + k[3].slope.*of) / 6;
  };
  step.end = moved({mean(&Carried::z), mean(&Carried::s), mean(&Carried::q), mean(&Carried::p),
                    mean(&Carried::qx), mean(&Carried::px)},
                   dr);
  return step;
}

void SectionTracer::enter(State& s, const SectionCell& cell) const {
  s.cell = cell;
  s.patch = section_.patch(cell);
  s.look();
}

SectionTracer::State SectionTracer::start(double theta, RayTrace& ray) const {
  ray.begin(theta);
  const auto [sine, cosine] = elementary::sin_cos(theta);
  State s{.r = 0,
          .ray = {},
          .cell = {},
          .patch = {},
          .c = 0,
          .xi = 0,
          .sine = 0,
          .cosine = 0,
          .first = {},
          .facet = profile_.facet_at(0)};
  s.ray.z = ends_.source_depth_m;
  enter(s, section_.cell_at(0, ends_.source_depth_m, sine < 0));
  s.ray.s = sine / s.c;
  s.ray.p = s.ray.px = 1 / s.c;
  s.look();
  return s;
}

// The depth is met by the cubic through depths and slopes at both ends of the step, to a millimetre; that
// suffices at an edge, where speed and gradient are continuous. The surface is then met by Newton's method.
SectionTracer::Step SectionTracer::until_depth(const State& s, const Step& step, double depth_m, Edge edge) {
  const HermiteCubic depths(s.ray.z, step.stages[0].slope.z, step.end.z, step.stages[3].slope.z, step.dr);
  Step part = stepped(s, step.dr * depths.crossing(depth_m));
  part.edge = edge;
  if (depth_m > 0) return part;
  for (int i = 0; i < kMaxCorrections && std::abs(part.end.z - depth_m) > kOnEdge; ++i) {
    const double slope = part.stages[3].slope.z;
    if (slope == 0) break;
    part = stepped(s, std::clamp(part.dr - (part.end.z - depth_m) / slope, 0.0, step.dr));
  }
  part.end.z = depth_m;
  part.edge = edge;
  return part;
}

// The bottom is met along the circle through the step's ends (acoustics/rays/arcs/arc_steps.h), then by
// Newton's method on the facet's line.
SectionTracer::Step SectionTracer::until_bottom(const State& s, const Step& step) const {
  const double sine = step.end.s / step.stages[3].per_c, curvature = (sine - s.sine) / step.dr;
  const ArcPoint at{s.r, s.ray.z, s.sine, s.xi, s.c, 1 / s.xi, 0, s.facet, s.on_facet};
  const auto below = [&](const Step& there, std::size_t facet_index) {
    const Facet& facet = profile_.facets()[facet_index];
    return there.end.z - facet.z0 - facet.slope * (s.r + there.dr - facet.r0);
  };
  ArcHit hit{step.dr, profile_.facet_from(s.facet, s.r + step.dr)};
  if (!find_hit(curvature, profile_, at, {step.dr, step.end.z, sine, false, sine > 0}, step.dr, hit) &&
      below(step, hit.facet) <= 0)
    return step;
  Step part = stepped(s, hit.dr);
  const double bottom_slope = profile_.facets()[hit.facet].slope;
  for (int i = 0; i < kMaxCorrections && std::abs(below(part, hit.facet)) > kOnEdge; ++i) {
    const double slope = part.stages[3].slope.z - bottom_slope;
    if (slope <= 0) break;
    part = stepped(s, std::clamp(part.dr - below(part, hit.facet) / slope, 0.0, step.dr));
  }
  part.end.z -= below(part, hit.facet);
  part.edge = Edge::kBottom;
  part.facet = hit.facet;
  return part;
}

SectionTracer::Step SectionTracer::next_step(const State& s) const {
  const std::vector<double>& depths = section_.depths_m();
  const double top = depths[s.cell.layer], bottom = depths[s.cell.layer + 1];
  const bool near_bottom = std::min(bottom, s.ray.z + kLongestStep) > profile_.shallowest_m();
  const double longest = kLongestStep * std::max(s.cosine, kMinCosine);
  Step step = stepped(s, std::min({longest, section_.end_of(s.cell.strip) - s.r, ends_.range_m - s.r}));
  const HermiteCubic way(s.ray.z, step.stages[0].slope.z, step.end.z, step.stages[3].slope.z, step.dr);
  const HermiteCubic::Turns turns = way.turns();
  if (turns.count > 0 && turns.at[0] > kMinShare) step = stepped(s, step.dr * turns.at[0]);
  if (step.end.z < top) step = until_depth(s, step, top, Edge::kAbove);
  if (step.end.z > bottom) step = until_depth(s, step, bottom, Edge::kBelow);
  return near_bottom && step.dr > 0 ? until_bottom(s, step) : step;
}

void SectionTracer::add_details(const State& s, const Step& step, TraceDetails& details) const {
  // Integrals over the step, by the weights of the scheme:
  //   d tau = dr / (c^2 xi),  d length = dr / (c xi)
  const auto mean = [&](const auto& of) {
    const auto& k = step.stages;
    return (of(k[0], 0) + 2 * (of(k[1], 0.5) + of(k[2], 0.5)) + of(k[3], 1)) / 6;
  };
  const auto length = [](const Stage& k, double) { return k.per_c / k.xi; };
  details.delay_s += step.dr * mean([](const Stage& k, double) { return k.per_c * k.per_c / k.xi; });
  details.path_length_m += step.dr * mean(length);
  details.slowness_over_range += step.dr * mean([](const Stage& k, double) { return k.xi; });
  details.absorption_db +=
      step.dr * mean([&](const Stage& k, double share) {
        return length(k, share) * section_.absorption_db_per_m(s.cell, s.r + share * step.dr, k.z);
      });
  // A chord of 15 m stays within 0.1 m of a ray that is bent by a gradient of at most 5 1/s.
  if (details.track != nullptr) details.track->push_back({s.r + step.dr, step.end.z});
}

void SectionTracer::go(State& s, const Step& step, RayTrace& ray, TraceDetails* details) const {
  if (step.end.q * s.ray.q < 0) ++ray.caustics;
  if (details != nullptr && step.dr > 0) add_details(s, step, *details);
  if (s.ray.s * step.end.s < 0) {
    const bool is_lower = s.ray.s > 0;
    ray.events.push_back({is_lower ? RayEvent::kLowerTurn : RayEvent::kUpperTurn, 0});
    ray.family = continued_family(ray.family, kTurnOfSection + (is_lower ? 1 : 0));
    ++(is_lower ? ray.lower_turns : ray.upper_turns);
  }
  s.r += step.dr;
  s.ray = step.end;
  s.on_facet = s.on_facet && step.dr == 0;
  s.facet = profile_.facet_from(s.facet, s.r);
  s.look();
}

bool SectionTracer::cross(State& s, const Step& step, RayTrace& ray, TraceDetails* details) const {
  if (step.edge == Edge::kBottom) return meet_bottom(s, step.facet, ray, details);
  if (step.edge == Edge::kAbove && s.cell.layer == 0) return meet_surface(s, ray, details);
  SectionCell cell = s.cell;
  if (step.edge == Edge::kAbove) --cell.layer;
  if (step.edge == Edge::kBelow) ++cell.layer;
  if (s.r > section_.end_of(cell.strip) - kOnEdge) ++cell.strip;
  if (cell.strip != s.cell.strip || cell.layer != s.cell.layer) enter(s, cell);
  return true;
}

bool SectionTracer::meet_surface(State& s, RayTrace& ray, TraceDetails* details) const {
  // The mirrored water has the gradient (a, -b), which is a jump of 2 b along the normal (0, -1).
  const double sine = std::max(std::abs(s.sine), kMinSine);
  const double kink = 2 * s.patch.at(s.r, 0).down * s.cosine * s.cosine / (s.c * s.c * sine);
  s.ray.p -= s.ray.q * kink;
  s.ray.px -= s.ray.qx * kink;
  s.ray.s = -s.ray.s;
  s.orientation = -s.orientation;
  s.look();
  return losses_.at_surface(sine, ray, details);
}

bool SectionTracer::meet_bottom(State& s, std::size_t index, RayTrace& ray, TraceDetails* details) const {
  const Facet& facet = profile_.facets()[index];
  const FacetBounce bounce = bounce_off(facet, {s.r, s.ray.z, s.sine, s.xi, s.c, 1 / s.xi, 0, index});
  if (bounce.out_cosine < kMinCosine) return false;
  // The tube changes as at the bottom in arc_tracer.cc. In place of g cos stands u = g . n = b cos - a sin,
  // with the gradient (a, b), for the incident ray and u' for the reflected one:
  //   p' = p + q ((u + u') cot G / c + 2 k / sin G) / c
  // The second tube, qx and px, is that of rays that meet the facet itself and leave it at another angle.
  const LocalSpeed g = s.patch.at(s.r, s.ray.z);
  const double in = g.down * s.cosine - g.along * s.sine;
  const double out = g.down * bounce.out_cosine - g.along * bounce.out_sine;
  const double in_c = s.cosine * facet.cosine + s.sine * facet.sine;
  const double off_s = facet.sine * bounce.out_cosine - facet.cosine * bounce.out_sine;
  const double off_c = facet.cosine * bounce.out_cosine + facet.sine * bounce.out_sine;
  const double bend = 2 * bounce.bend_per_m;
  s.ray.p += s.ray.q * ((in + out) * bounce.cosine / s.c + bend) / (s.c * bounce.sine);
  s.ray.px += s.ray.qx * ((in * in_c + out * off_c) / s.c + bend) / (s.c * bounce.facet_sine);
  s.ray.qx *= off_s / bounce.facet_sine;
  s.ray.s = bounce.out_sine / s.c;
  s.look();
  s.facet = index;
  s.on_facet = true;
  s.images += s.orientation;
  s.orientation = -s.orientation;
  return losses_.at_bottom(facet, bounce.sine, s.c, ray, details);
}

void SectionTracer::arrive(const State& s, RayTrace& ray) const {
  ray.arrived = true;
  ray.z = s.ray.z;
  ray.sine = s.sine;
  ray.xi = s.xi;
  ray.q = s.ray.q;
  ray.p = s.ray.p;
  ray.zeta = s.orientation * s.ray.z + 2 * ends_.bottom_at_receiver_m * s.images;
  ray.zeta_slope = s.ray.qx / std::max(s.cosine, kMinCosine);
}

void SectionTracer::trace(double theta, RayTrace& ray, TraceDetails* details) const {
  State s = start(theta, ray);
  for (int steps = 0; steps < kMaxSteps; ++steps) {
    const Step step = next_step(s);
    const bool is_there = s.r + step.dr > ends_.range_m - kOnEdge;
    go(s, step, ray, details);
    if (s.cosine < kMinCosine) return;
    // A step to the receiver may end at the bottom of the last facet before it; the ray is then reflected
    // first.
    if (is_there && step.edge != Edge::kBottom && !(step.edge == Edge::kAbove && s.cell.layer == 0))
      return arrive(s, ray);
    if (!cross(s, step, ray, details)) return;
    if (is_there) return arrive(s, ray);
  }
}

}  // namespace halocline::acoustics
