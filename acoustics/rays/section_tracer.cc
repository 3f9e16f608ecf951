#include "acoustics/rays/section_tracer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "acoustics/math/arc_math.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

using Half = SectionCell::Half;

constexpr std::uint64_t kTurnOfSection = 100'000;  // numbers of turns follow those of facets
constexpr int kMaxTriangles = 1'000'000;           // of one ray: a guard, never met
constexpr double kNever = std::numeric_limits<double>::infinity();

// w of where an arc goes out through an edge at the distance d >= 0 along the normal m; never where it does not within half a
// circle.
double way_to(double along_t, double along_n, double d, double curvature) {
  const double turned = along_n - curvature * d, square = 1 - turned * turned;
  if (!(square >= 0)) return kNever;
  const double leaving = std::sqrt(square);
  if (along_t > 0) return 2 * d / (along_t + leaving);
  // Curving back to it: (t' . m)^2 - (t . m)^2 = 2 kappa d (n . m - kappa d / 2).
  const double towards = curvature * (along_n - curvature * d / 2);
  return towards > 0 ? (leaving - along_t) / towards : kNever;
}

}  // namespace

struct SectionTracer::State {
  double r, z, sine, cosine, c, curvature;
  SpeedGradient g;
  SectionCell cell;
  double q, p;    // the tube
  double qx, px;  // the same for rays as they are reflected, facet by facet: the slope of zeta
  std::size_t facet;
  bool on_facet = false;
  double orientation = 1, images = 0;  // o and k of zeta

  void look_at(const RaySection& section) {
    g = section.gradient(cell);
    c = section.speed_in(cell, r, z);
    curvature = (g.along * sine - g.down * cosine) / c;
  }
};

// To an edge, of normal (along, down), by the chord (dr, dz).
struct SectionTracer::Step {
  Edge edge = Edge::kNone;
  double w = kNever;
  double along = 0, down = 0;
  double dr = 0, dz = 0;
};

SectionTracer::State SectionTracer::start(double theta, TracedRay& ray) const {
  ray.begin(theta);
  const auto [sine, cosine] = elementary::sin_cos(theta);
  State s{0,
          ends_.source_depth_m,
          sine,
          cosine,
          0,
          0,
          {},
          section_.enter(0, ends_.source_depth_m, sine < 0),
          0,
          0,
          0,
          0,
          profile_.facet_at(0)};
  s.look_at(section_);
  s.p = s.px = 1 / s.c;
  return s;
}

SectionTracer::Step SectionTracer::next_step(const State& s) const {
  const std::vector<double>& depths = section_.depths_m();
  const double top = depths[s.cell.layer], bottom = depths[s.cell.layer + 1];
  const double strip_end = section_.end_of(s.cell.strip);
  Step first;
  const auto try_edge = [&](Edge edge, double along, double down, double d) {
    const double w = way_to(s.cosine * along + s.sine * down, s.cosine * down - s.sine * along,
                            std::max(d, 0.0), s.curvature);
    if (w < first.w) first = {edge, w, along, down};
  };
  if (s.cell.half != Half::kLower) try_edge(Edge::kAbove, 0, -1, s.z - top);
  if (s.cell.half != Half::kUpper) try_edge(Edge::kBelow, 0, 1, bottom - s.z);
  if (s.cell.half != Half::kWhole) {
    // Its normal points down, out of the upper half; h times the unit vector.
    const double width = strip_end - section_.ranges_m()[s.cell.strip], height = bottom - top;
    const bool falls = section_.diagonal_falls(s.cell);
    const double slope = falls ? height / width : -height / width, h = std::sqrt(1 + slope * slope);
    const double depth = (falls ? top : bottom) + slope * (s.r - section_.ranges_m()[s.cell.strip]);
    const double out = s.cell.half == Half::kUpper ? 1 : -1;
    try_edge(Edge::kDiagonal, -out * slope / h, out / h, out * (depth - s.z) / h);
  }
  if (ends_.range_m <= strip_end) {
    try_edge(Edge::kReceiver, 1, 0, ends_.range_m - s.r);
  } else if (section_.reaches_end(s.cell)) {
    try_edge(Edge::kEnd, 1, 0, strip_end - s.r);
  }
  if (first.edge == Edge::kNone) return first;
  const double half_turn = s.curvature * first.w / 2, x = first.w / (1 + half_turn * half_turn),
               y = x * half_turn;
  first.dr = x * s.cosine - y * s.sine;
  first.dz = x * s.sine + y * s.cosine;
  return first;
}

void SectionTracer::add_details(const State& s, double dr, double z, double sine,
                                TracedDetails& details) const {
  const double dz = z - s.z, square = dr * dr + dz * dz, chord = std::sqrt(square);
  const double cosine = std::sqrt(std::max(1 - sine * sine, 0.0));
  const double c = s.c + s.g.along * dr + s.g.down * dz;
  // 2 / |g| asinh(x / sqrt(1 - x^2)) = 2 / |g| atanh(x), x = |g| L / sqrt(g^2 L^2 + 4 c1 c2).
  const double g2 = s.g.along * s.g.along + s.g.down * s.g.down, root = std::sqrt(g2 * square + 4 * s.c * c);
  const double length = chord * asin_over(s.curvature * chord / 2);
  details.delay_s += 2 * chord / root * atanh_over(std::sqrt(g2) * chord / root);
  details.length_m += length;
  details.slowness_over_range += (s.cosine / s.c + cosine / c) / 2 * dr;
  // Simpson's rule; the middle of the arc is kappa L^2 / 8 off that of the chord.
  const double off = s.curvature * chord / 8;
  const auto absorption = [&](double along, double down) {
    return section_.absorption_db_per_m(s.cell, s.r + along, s.z + down);
  };
  details.absorption_db +=
      length / 6 *
      (absorption(0, 0) + 4 * absorption(dr / 2 + off * dz, dz / 2 - off * dr) + absorption(dr, dz));
}

// As those of arc_tracer.cc, by a sine that grows by kappa dr.
void SectionTracer::add_to_track(const State& s, double dr, double z, std::vector<RayPoint>& track) {
  constexpr double kMaxPieces = 32;
  const double dz = z - s.z, off_m = (dr * dr + dz * dz) * std::abs(s.curvature) / 8;
  const double pieces = std::min(std::ceil(std::sqrt(off_m / TracedDetails::kTrackErrorM)), kMaxPieces);
  for (double piece = 1; piece < pieces; ++piece) {
    const double part = dr * piece / pieces, sine = s.sine + s.curvature * part;
    const double cosine = std::sqrt(std::max(1 - sine * sine, 0.0));
    track.push_back({s.r + part, s.z + part * (s.sine + sine) / (s.cosine + cosine)});
  }
  track.push_back({s.r + dr, z});
}

void SectionTracer::go(State& s, double dr, double z, double sine, TracedRay& ray,
                       TracedDetails* details) const {
  const double dz = z - s.z, along = s.g.along * s.cosine + s.g.down * s.sine;
  const double way =
      s.c * (dr * s.cosine + dz * s.sine) + along * (dr * dr + dz * dz) / 2;  // integral of c ds
  const double q = s.q + s.p * way;
  if (q * s.q < 0) ++ray.caustics;
  s.q = q;
  s.qx += s.px * way;
  if (details != nullptr && dr > 0) {
    add_details(s, dr, z, sine, *details);
    if (details->track != nullptr) add_to_track(s, dr, z, *details->track);
  }
  if (s.sine * sine < 0) {
    const bool is_lower = s.sine > 0;
    ray.events.push_back({is_lower ? RayEvent::kLowerTurn : RayEvent::kUpperTurn, 0});
    ray.family = continued_family(ray.family, kTurnOfSection + (is_lower ? 1 : 0));
    ++(is_lower ? ray.lower_turns : ray.upper_turns);
  }
  s.r += dr;
  s.z = z;
  s.sine = sine;
  s.cosine = std::sqrt(std::max(1 - sine * sine, 0.0));
  s.on_facet = s.on_facet && dr == 0;
  s.facet = profile_.facet_from(s.facet, s.r);
}

void SectionTracer::bend_tube(State& s, const SpeedGradient& before, double along, double down) const {
  const double out = s.cosine * along + s.sine * down;
  const double jump = (s.g.along - before.along) * along + (s.g.down - before.down) * down;
  const double kink = jump * (1 - out * out) / (s.c * s.c * std::max(out, kMinSine));
  s.p -= s.q * kink;
  s.px -= s.qx * kink;
}

bool SectionTracer::cross(State& s, const Step& step, TracedRay& ray, TracedDetails* details) const {
  if (step.edge == Edge::kAbove && s.cell.layer == 0) return meet_surface(s, ray, details);
  switch (step.edge) {
    case Edge::kAbove:
      --s.cell.layer;
      if (s.cell.half != Half::kWhole) s.cell.half = Half::kLower;
      break;
    case Edge::kBelow:
      ++s.cell.layer;
      if (s.cell.half != Half::kWhole) s.cell.half = Half::kUpper;
      break;
    case Edge::kDiagonal:
      s.cell.half = s.cell.half == Half::kUpper ? Half::kLower : Half::kUpper;
      break;
    default:
      s.cell = section_.enter_layer(s.cell.strip + 1, s.cell.layer);
  }
  const SpeedGradient before = s.g;
  s.look_at(section_);
  bend_tube(s, before, step.along, step.down);
  return true;
}

bool SectionTracer::meet_surface(State& s, TracedRay& ray, TracedDetails* details) const {
  // The mirrored water has the gradient (a, -b): a jump of 2 b along the normal (0, -1).
  const double sine = std::max(std::abs(s.sine), kMinSine);
  s.c = section_.speed_in(s.cell, s.r, s.z);
  const double kink = 2 * s.g.down * s.cosine * s.cosine / (s.c * s.c * sine);
  s.p -= s.q * kink;
  s.px -= s.qx * kink;
  s.sine = -s.sine;
  s.orientation = -s.orientation;
  s.look_at(section_);
  return losses_.at_surface(sine, ray, details);
}

bool SectionTracer::meet_bottom(State& s, const ArcHit& hit, TracedRay& ray, TracedDetails* details) const {
  const Facet& facet = profile_.facets()[hit.facet];
  const double sine = s.sine + s.curvature * hit.dr;
  go(s, hit.dr, facet.z0 + facet.slope * (s.r + hit.dr - facet.r0), sine, ray, details);
  s.c = section_.speed_in(s.cell, s.r, s.z);
  const double xi = s.cosine / s.c;
  const FacetBounce bounce = bounce_off(facet, {s.r, s.z, s.sine, xi, s.c, 1 / xi, 0, hit.facet});
  if (bounce.out_cosine < kMinCosine) return false;
  // As at the bottom of arc_tracer.cc, with u = g . n = b cos - a sin of the ray as it comes and u' as it goes in the place
  // of g cos: p' = p + q ((u + u') cot G / c + 2 k / sin G) / c. Likewise for rays that meet the facet itself and leave it at
  // another angle.
  const double in = s.g.down * s.cosine - s.g.along * s.sine;
  const double out = s.g.down * bounce.out_cosine - s.g.along * bounce.out_sine;
  const double in_c = s.cosine * facet.cosine + s.sine * facet.sine;
  const double off_s = facet.sine * bounce.out_cosine - facet.cosine * bounce.out_sine;
  const double off_c = facet.cosine * bounce.out_cosine + facet.sine * bounce.out_sine;
  const double bend = 2 * bounce.bend_per_m;
  s.p += s.q * ((in + out) * bounce.cosine / s.c + bend) / (s.c * bounce.sine);
  s.px += s.qx * ((in * in_c + out * off_c) / s.c + bend) / (s.c * bounce.facet_sine);
  s.qx *= off_s / bounce.facet_sine;
  s.sine = bounce.out_sine;
  s.cosine = bounce.out_cosine;
  s.look_at(section_);
  s.facet = hit.facet;
  s.on_facet = true;
  s.images += s.orientation;
  s.orientation = -s.orientation;
  return losses_.at_bottom(facet, bounce.sine, s.c, ray, details);
}

void SectionTracer::arrive(const State& s, TracedRay& ray) const {
  ray.arrived = true;
  ray.z = s.z;
  ray.sine = s.sine;
  ray.xi = s.cosine / section_.speed_in(s.cell, s.r, s.z);
  ray.q = s.q;
  ray.p = s.p;
  ray.zeta = s.orientation * s.z + 2 * ends_.bottom_at_receiver_m * s.images;
  ray.zeta_slope = s.qx / std::max(s.cosine, kMinCosine);
}

void SectionTracer::trace(double theta, TracedRay& ray, TracedDetails* details) const {
  State s = start(theta, ray);
  const double shallowest = profile_.shallowest_m();
  for (int steps = 0; steps < kMaxTriangles; ++steps) {
    const Step step = next_step(s);
    const double sine = s.sine + s.curvature * step.dr;
    if (step.edge == Edge::kNone || !(1 - sine * sine > kMinCosine * kMinCosine)) return;
    ArcHit hit;
    const ArcPoint at{s.r, s.z, s.sine, s.cosine / s.c, s.c, s.c / s.cosine, 0, s.facet, s.on_facet};
    const bool near_bottom = section_.depths_m()[s.cell.layer + 1] > shallowest;
    if (near_bottom &&
        find_hit(s.curvature, profile_, at, {step.dr, s.z + step.dz, sine, false, sine > 0}, step.dr, hit)) {
      if (!meet_bottom(s, hit, ray, details)) return;
      continue;
    }
    const std::vector<double>& depths = section_.depths_m();
    const double z = step.edge == Edge::kAbove   ? depths[s.cell.layer]
                     : step.edge == Edge::kBelow ? depths[s.cell.layer + 1]
                                                 : s.z + step.dz;
    go(s, step.dr, z, sine, ray, details);
    if (step.edge == Edge::kReceiver) return arrive(s, ray);
    if (step.edge == Edge::kEnd) s.r = section_.end_of(s.cell.strip);
    if (!cross(s, step, ray, details)) return;
  }
}

}  // namespace halocline::acoustics
