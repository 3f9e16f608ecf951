// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/arc_tracer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "acoustics/math/arc_math.h"
#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kOffBoundary = 1e-6;          // m, as in acoustics/rays/layered_eigenray.cc
constexpr std::uint64_t kTurnsFrom = 100'000;  // family numbers of turns follow those of facets
constexpr int kMaxSteps = 200'000;             // layers crossed: a guard that is never reached

}  // namespace

struct ArcTracer::State : ArcPoint {
  double q, p;  // the ray tube
  // The ray tube for rays as the facets reflect them, which gives the slope of zeta.
  double qx, px;
  double orientation = 1, images = 0;  // o and k of zeta
};

ArcTracer::ArcTracer(const ProfiledSea& sea, const RayLink& link)
    : sea_(sea),
      losses_(sea, sea.water.speed_at(sea.profile.deepest_m())),
      range_(std::max(link.range_m, 1e-3)) {
  require_in_range(link.range_m, 0, 1e7, "range", "m");
  bottom_at_receiver_ = sea.profile.depth_at(range_);
  const double bottom_at_source = sea.profile.depth_at(0);
  require_in_range(link.source_depth_m, 0, bottom_at_source, "depth of the source", "m");
  source_depth_ = std::clamp(link.source_depth_m, kOffBoundary, bottom_at_source - kOffBoundary);
  move_receiver(link.receiver_depth_m);
  source_layer_ = sea.water.layer_at(source_depth_);
  source_facet_ = sea.profile.facet_at(0);
  source_speed_ = sea.water.speed_at(source_depth_);
  if (sea.section == nullptr) return;
  source_speed_ = sea.section->speed_at(0, source_depth_);
  section_.emplace(sea_, losses_, SectionEnds{source_depth_, range_, bottom_at_receiver_});
}

void ArcTracer::move_receiver(double depth_m) {
  require_in_range(depth_m, 0, bottom_at_receiver_, "depth of the receiver", "m");
  receiver_depth_ = std::clamp(depth_m, kOffBoundary, bottom_at_receiver_ - kOffBoundary);
}

void ArcTracer::add_details(const State& s, double dr, double z, double sine, TraceDetails& details) const {
  // The arc is part of a circle of radius R = 1 / (xi g), along which the sine changes by ds/dr = -xi g:
  //   delay  = integral of xi dr / cos^2 = atanh(xi g dr / (1 - s1 s2)) / g
  //   length = 2 R asin(chord / (2 R))
  const double g = sea_.water.gradients_per_s()[s.layer], mix = 1 - s.sine * sine;
  const double chord = std::sqrt(dr * dr + (z - s.z) * (z - s.z));
  const double length = chord * asin_over(s.xi * g * chord / 2);
  details.delay_s += s.xi * dr / mix * atanh_over(s.xi * g * dr / mix);
  details.path_length_m += length;
  details.slowness_over_range += s.xi * dr;
  const double top = sea_.water.depths_m()[s.layer], height = sea_.water.depths_m()[s.layer + 1] - top;
  const LayerAbsorption& layer = sea_.water.absorption()[s.layer];
  const double u1 = (s.z - top) / height, u2 = (z - top) / height;
  if (s.sine * sine >= 0) {
    details.absorption_db +=
        length * mean_absorption(restricted(layer, u1, u2), std::abs(s.sine), std::abs(sine));
    // Through a turn: two pieces, with lengths in proportion to the sines at the ends.
  } else {
    const double turn = (1 / s.xi - sea_.water.speeds_mps()[s.layer]) / g / height;
    const double share = std::abs(s.sine) / (std::abs(s.sine) + std::abs(sine));
    details.absorption_db +=
        length * (share * mean_absorption(restricted(layer, u1, turn), std::abs(s.sine), 0) +
                  (1 - share) * mean_absorption(restricted(layer, u2, turn), std::abs(sine), 0));
  }
}

void ArcTracer::add_to_track(const State& s, double dr, double z, double sine,
                             std::vector<RayPoint>& track) const {
  // The depth curves by d2z/dr2 = -xi g / cos^3, so a chord of length dr departs from the arc by
  //   dr^2 xi g / (8 cos^3).
  constexpr double kMaxPieces = 32;
  const double g = sea_.water.gradients_per_s()[s.layer];
  const double cosine = std::sqrt(std::max(1 - std::max(s.sine * s.sine, sine * sine), kMinCosine));
  const double off_m = dr * dr * s.xi * std::abs(g) / (8 * cosine * cosine * cosine);
  const double pieces = std::min(std::ceil(std::sqrt(off_m / TraceDetails::kTrackErrorM)), kMaxPieces);
  for (double piece = 1; piece < pieces; ++piece) {
    const double part = dr * piece / pieces, there = s.sine - s.xi * g * part;
    const double c = std::sqrt(std::max(1 - there * there, 0.0)) * s.per_xi;
    track.push_back({s.r + part, s.z + part * (s.sine + there) / (s.xi * (s.c + c))});
  }
  track.push_back({s.r + dr, z});
}

void ArcTracer::go(State& s, double dr, double z, double sine, RayTrace& ray, TraceDetails* details) const {
  // Dynamic ray tracing (Cerveny 2001; Jensen and others 2011, section 3.3):
  //   dq/ds = c p,  dp/ds = -q c_nn / c^2
  // Where c is linear c_nn = 0: p is constant and dq = p dr / xi.
  const double way = dr * s.per_xi, q = s.q + s.p * way;
  if (q * s.q < 0) ++ray.caustics;
  s.q = q;
  s.qx += s.px * way;
  if (details != nullptr && dr > 0) {
    add_details(s, dr, z, sine, *details);
    if (details->track != nullptr) add_to_track(s, dr, z, sine, *details->track);
  }
  s.r += dr;
  s.z = z;
  s.sine = sine;
  s.on_facet = s.on_facet && dr == 0;
}

void ArcTracer::cross_knot(State& s, bool down) const {
  const double before = sea_.water.gradients_per_s()[s.layer];
  s.layer = down ? s.layer + 1 : s.layer - 1;
  s.c = sea_.water.speeds_mps()[down ? s.layer : s.layer + 1];
  // The jump of the gradient: p decreases by q xi^2 (g2 - g1) / sin.
  const double change = (sea_.water.gradients_per_s()[s.layer] - before) * (down ? 1 : -1);
  const double kink = s.xi * s.xi * change / std::max(std::abs(s.sine), kMinSine);
  s.p -= s.q * kink;
  s.px -= s.qx * kink;
}

bool ArcTracer::meet_surface(State& s, RayTrace& ray, TraceDetails* details) const {
  const double g = sea_.water.gradients_per_s()[0], sine = std::max(std::abs(s.sine), kMinSine);
  s.c = sea_.water.speeds_mps()[0];
  // The mirrored water has the gradient -g, which is a jump of 2 g: p decreases by 2 q xi^2 g / sin.
  s.p -= 2 * s.q * s.xi * s.xi * g / sine;
  s.px -= 2 * s.qx * s.xi * s.xi * g / sine;
  s.sine = -s.sine;
  s.orientation = -s.orientation;
  return losses_.at_surface(sine, ray, details);
}

bool ArcTracer::meet_bottom(State& s, std::size_t index, RayTrace& ray, TraceDetails* details) const {
  // The direction is mirrored at the reflecting slope (bounce_off), which gives xi' = cos(out) / c. The tube
  // changes as at a curved boundary in the plane of the ray (Cerveny 2001),
  //   p' = p + q (g (xi + xi') cot G + 2 k / sin G) / c,
  // with G the grazing angle and k the bend of the bottom per metre.
  const Facet& facet = sea_.profile.facets()[index];
  const double g = sea_.water.gradients_per_s()[s.layer], ct = s.xi * s.c, st = s.sine;
  const FacetBounce bounce = bounce_off(facet, s);
  const double sin_g = bounce.sine, cos_g = bounce.cosine, bend = bounce.bend_per_m;
  const double out_sine = bounce.out_sine, out_cosine = bounce.out_cosine;
  if (out_cosine < kMinCosine) return false;
  // The second tube is that of rays that meet the facet itself, at another angle than the one at which they
  // leave.
  const double in_s = bounce.facet_sine, in_c = ct * facet.cosine + st * facet.sine;
  // A single division serves all quotients: it takes as long as a dozen products.
  const double sines = sin_g * in_s, per_all = 1 / (s.c * out_cosine * sines),
               per_sines = per_all * out_cosine;
  const double xi = per_sines * sines * out_cosine;
  s.p += s.q * (g * (s.xi + xi) * cos_g + 2 * bend) * (per_sines * in_s);
  const double off_s = facet.sine * out_cosine - facet.cosine * out_sine;
  const double off_c = facet.cosine * out_cosine + facet.sine * out_sine;
  s.px += s.qx * (g * (s.xi * in_c + xi * off_c) + 2 * bend) * (per_sines * sin_g);
  s.qx *= off_s * (per_sines * sin_g * s.c);
  s.sine = out_sine;
  s.xi = xi;
  s.per_xi = per_all * sines * s.c * s.c;
  s.facet = index;
  s.on_facet = true;
  s.images += s.orientation;
  s.orientation = -s.orientation;
  return losses_.at_bottom(facet, sin_g, s.c, ray, details);
}

void ArcTracer::arrive(const State& s, double bottom_m, RayTrace& ray) {
  ray.arrived = true;
  ray.z = s.z;
  ray.sine = s.sine;
  ray.xi = s.xi;
  ray.q = s.q;
  ray.p = s.p;
  // zeta = o z + 2 H k. Its slope is the width of the tube along the vertical, q / cos, for rays as the
  // facets reflect them.
  ray.zeta = s.orientation * s.z + 2 * bottom_m * s.images;
  ray.zeta_slope = s.qx / std::sqrt(std::max(1 - s.sine * s.sine, kMinCosine * kMinCosine));
}

ArcTracer::State ArcTracer::start(double theta, RayTrace& ray) const {
  ray.begin(theta);
  const double sine = elementary::sin(theta), xi = elementary::cos(theta) / source_speed_,
               p = 1 / source_speed_;
  State s{{0, source_depth_, sine, xi, source_speed_, 1 / xi, source_layer_, source_facet_}, 0, p, 0, p};
  // A ray that starts at a knot belongs to the layer into which it runs.
  const bool rises = sine < 0 || (sine == 0 && sea_.water.gradients_per_s()[s.layer] > 0);
  if (s.z == sea_.water.depths_m()[s.layer] && rises) --s.layer;
  return s;
}

void ArcTracer::note_turn(bool lower, std::size_t layer, RayTrace& ray) {
  ray.events.push_back({lower ? RayEvent::kLowerTurn : RayEvent::kUpperTurn, 0});
  ray.family = continued_family(ray.family, kTurnsFrom + layer);
  ++(lower ? ray.lower_turns : ray.upper_turns);
}

void ArcTracer::go_part(State& s, double dr, RayTrace& ray, TraceDetails* details) const {
  // ds/dr = -xi g; z2 - z1 = dr (s1 + s2) / (xi (c1 + c2)); c = cos / xi.
  const double sine = s.sine - s.xi * sea_.water.gradients_per_s()[s.layer] * dr;
  const double c = std::sqrt(std::max(1 - sine * sine, 0.0)) * s.per_xi;
  if (s.sine * sine < 0) note_turn(s.sine > 0, s.layer, ray);
  go(s, dr, s.z + dr * (s.sine + sine) / (s.xi * (s.c + c)), sine, ray, details);
  s.c = c;
}

bool ArcTracer::go_to_bottom(State& s, const ArcHit& hit, RayTrace& ray, TraceDetails* details) const {
  go_part(s, hit.dr, ray, details);
  const Facet& facet = sea_.profile.facets()[hit.facet];
  s.z = facet.z0 + facet.slope * (s.r - facet.r0);
  s.c = sea_.water.speeds_mps()[s.layer] +
        sea_.water.gradients_per_s()[s.layer] * (s.z - sea_.water.depths_m()[s.layer]);
  return meet_bottom(s, hit.facet, ray, details);
}

bool ArcTracer::go_to_knot(State& s, const ArcStep& step, RayTrace& ray, TraceDetails* details) const {
  if (step.turns) note_turn(step.down, s.layer, ray);
  go(s, step.dr, step.z, step.sine, ray, details);
  s.facet = sea_.profile.facet_from(s.facet, s.r);
  if (step.turns) return true;
  if (!step.down && s.layer == 0) return meet_surface(s, ray, details);
  cross_knot(s, step.down);
  return true;
}

void ArcTracer::trace(double theta, RayTrace& ray, TraceDetails* details) const {
  if (section_) return section_->trace(theta, ray, details);
  State s = start(theta, ray);
  const double shallowest = sea_.profile.shallowest_m();
  for (int steps = 0; steps < kMaxSteps; ++steps) {
    const ArcStep step = next_step(sea_.water, s);
    const double left = range_ - s.r;
    const bool near_bottom = sea_.water.depths_m()[s.layer + 1] > shallowest;
    ArcHit hit;
    if (near_bottom &&
        find_hit(curvature_of(sea_.water, s), sea_.profile, s, step, std::min(step.dr, left), hit)) {
      if (!go_to_bottom(s, hit, ray, details)) return;
    } else if (step.dr >= left) {
      go_part(s, left, ray, details);
      arrive(s, bottom_at_receiver_, ray);
      return;
    } else if (!go_to_knot(s, step, ray, details)) {
      return;
    }
  }
}

void ArcTracer::trace_past(double theta, std::span<const double> ranges_m, const AtRange& at) const {
  ensure(!section_, "water of depth alone");
  RayTrace ray;
  TraceDetails details;
  State s = start(theta, ray);
  const double shallowest = sea_.profile.shallowest_m();
  std::size_t next = 0;
  for (int steps = 0; steps < kMaxSteps; ++steps) {
    const ArcStep step = next_step(sea_.water, s);
    const bool near_bottom = sea_.water.depths_m()[s.layer + 1] > shallowest;
    ArcHit hit;
    const bool hits = near_bottom && find_hit(curvature_of(sea_.water, s), sea_.profile, s, step,
                                              std::min(step.dr, range_ - s.r), hit);
    for (; next < ranges_m.size() && ranges_m[next] - s.r <= (hits ? hit.dr : step.dr); ++next) {
      State there = s;
      RayTrace arriving = ray;
      TraceDetails sums = details;
      go_part(there, ranges_m[next] - s.r, arriving, &sums);
      arrive(there, sea_.profile.depth_at(ranges_m[next]), arriving);
      at(next, arriving, sums);
    }
    if (next == ranges_m.size()) return;
    if (hits ? !go_to_bottom(s, hit, ray, &details) : !go_to_knot(s, step, ray, &details)) return;
    ray.events.clear();  // they would be copied at each range
  }
}

}  // namespace halocline::acoustics
