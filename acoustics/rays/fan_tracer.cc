// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/fan_tracer.h"

#include <algorithm>

#include "acoustics/sea/boundary_reflection.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr std::size_t kLossSteps = 64;
constexpr double kMaxLossOfABounceDb = 400;
constexpr double kKnotMargin = 1e-6;  // m by which the bottom has to lie below a layer that is crossed whole
constexpr double kGiveUpDb = 6;       // margin on the loss of a path
constexpr double kGiveUpNepers = 1;   // and on what scattering takes from it
constexpr int kMaxSteps = 200'000;    // arcs per ray: a guard that is never reached
constexpr std::size_t kUsualEvents = 4096;  // per search, for the first allocation

// `sine` with its magnitude bounded below by kMinSine, for divisions by it.
double away_from_zero(double sine) {
  return std::abs(sine) > kMinSine ? sine : std::copysign(kMinSine, sine);
}

// Value at `sine` of a table at evenly spaced sines 0..1, by linear interpolation.
double interpolated(const std::vector<double>& table, double sine) {
  const double place = sine * static_cast<double>(kLossSteps);
  const std::size_t i = std::min(static_cast<std::size_t>(place), kLossSteps - 1);
  return table[i] + (place - static_cast<double>(i)) * (table[i + 1] - table[i]);
}

}  // namespace

struct FanTracer::State : ArcPoint {
  double q, p;  // ray tube for rays as the facets reflect them: qx and px of arc_tracer.cc
  double theta;
  double orientation = 1, images = 0;  // o and k of zeta
  double loss_db = 0;
  double scattered_nepers = -kGiveUpNepers;
  int bounces = 0;
  bool hits = false;  // `hit` is already known
  ArcHit hit{};
};

FanTracer::FanTracer(const ArcTracer& exact)
    : exact_(exact),
      water_(exact.sea().water),
      profile_(exact.sea().profile),
      column_(water_, profile_.shallowest_m(), profile_.deepest_m()),
      range_(exact.range_m()),
      shallowest_(profile_.shallowest_m()),
      max_loss_db_(kGiveUpDb - 20 * elementary::log10(exact.sea().options.min_boundary_factor)),
      steepest_rise_(0),
      scattering_(exact.sea().options.scattering) {
  events_.reserve(kUsualEvents);
  for (const Facet& facet : profile_.facets()) steepest_rise_ = std::max(steepest_rise_, -facet.sine);
  const ProfiledSea& sea = exact.sea();
  const double speed = water_.speed_at(profile_.deepest_m());
  const SurfaceLoss surface(sea.surface, sea.options.frequency_hz);
  for (std::size_t i = 0; i <= kLossSteps; ++i) {
    const double sine = std::max(static_cast<double>(i) / static_cast<double>(kLossSteps), 1e-3);
    const double bottom_db = -20 * elementary::log10(bottom_magnitude_at_sine(sea.bottom, sine, speed));
    bottom_loss_db_.push_back(std::min(bottom_db, kMaxLossOfABounceDb));
    surface_loss_db_.push_back(
        sine * surface_loss_db(sea.surface, elementary::asin(sine), sea.options.frequency_hz));
  }
}

FanTracer::State FanTracer::start(double theta) const {
  const double c = exact_.source_speed_mps(), sine = elementary::sin(theta), xi = elementary::cos(theta) / c;
  State s{{0, exact_.source_depth_m(), sine, xi, c, 1 / xi, exact_.source_layer(), exact_.source_facet()},
          0,
          1 / c,
          theta};
  // A ray that starts at a knot belongs to the layer into which it runs.
  const bool rises = sine < 0 || (sine == 0 && water_.gradients_per_s()[s.layer] > 0);
  if (s.z == water_.depths_m()[s.layer] && rises) --s.layer;
  return s;
}

void FanTracer::note_turn(bool lower) {
  events_.push_back({lower ? RayEvent::kLowerTurn : RayEvent::kUpperTurn, 0});
}

// Within a layer q grows by p dr / xi, and p is constant.
void FanTracer::go(State& s, double dr, double z, double sine) const {
  s.q += s.p * dr * s.per_xi;
  s.r += dr;
  s.z = z;
  s.sine = sine;
  s.on_facet = s.on_facet && dr == 0;
}

void FanTracer::go_part(State& s, double dr) {
  // ds/dr = -xi g; z2 - z1 = dr (s1 + s2) / (xi (c1 + c2)); c = cos / xi.
  const double sine = s.sine - s.xi * water_.gradients_per_s()[s.layer] * dr;
  const double c = std::sqrt(std::max(1 - sine * sine, 0.0)) * s.per_xi;
  if (s.sine * sine < 0) note_turn(s.sine > 0);
  go(s, dr, s.z + dr * (s.sine + sine) / (s.xi * (s.c + c)), sine);
  s.c = c;
}

bool FanTracer::bounce(State& s, const Facet& facet) const {
  const FacetBounce one = bounce_off(facet, s);
  if (one.out_cosine < kMinCosine) return false;
  // The ray tube for rays as the facets reflect them: qx and px of acoustics/rays/arc_tracer.cc. With the
  // grazing angles G and G' to the facet of the incident and the reflected ray:
  //   p' = p + q (g (xi cos G + xi' cos G') + 2 k) / (c sin G),  q' = q sin G' / sin G
  const double g = water_.gradients_per_s()[s.layer], ct = s.xi * s.c;
  // A single division serves all quotients: it takes as long as a dozen products.
  const double per_all = 1 / (s.c * one.facet_sine * one.out_cosine), per_in = per_all * one.out_cosine;
  const double xi = per_in * one.facet_sine * one.out_cosine;
  const double in_c = ct * facet.cosine + s.sine * facet.sine;
  const double off_s = facet.sine * one.out_cosine - facet.cosine * one.out_sine;
  const double off_c = facet.cosine * one.out_cosine + facet.sine * one.out_sine;
  s.p += s.q * (g * (s.xi * in_c + xi * off_c) + 2 * one.bend_per_m) * per_in;
  s.q *= off_s * per_in * s.c;
  s.sine = one.out_sine;
  s.xi = xi;
  s.per_xi = per_all * one.facet_sine * s.c * s.c;
  s.images += s.orientation;
  s.orientation = -s.orientation;
  s.loss_db += interpolated(bottom_loss_db_, std::min(one.sine, 1.0));
  s.scattered_nepers += scattering_.bottom * one.sine * one.sine;
  return true;
}

bool FanTracer::go_to_bottom(State& s, ArcHit hit) {
  s.hits = false;
  go_part(s, hit.dr);
  const Facet& facet = profile_.facets()[hit.facet];
  s.z = facet.z0 + facet.slope * (s.r - facet.r0);
  s.c = water_.speeds_mps()[s.layer] + water_.gradients_per_s()[s.layer] * (s.z - water_.depths_m()[s.layer]);
  if (!bounce(s, facet)) return false;
  s.facet = hit.facet;
  s.on_facet = true;
  events_.push_back({RayEvent::kBottom, facet.smooth_group});
  return goes_on(s);
}

bool FanTracer::goes_on(State& s) const {
  return !exact_.is_excluded(s.theta, ++s.bounces) && s.loss_db <= max_loss_db_ &&
         !scattering_.leaves_none(s.bounces, s.scattered_nepers);
}

bool FanTracer::meet_surface(State& s, double sine) {
  s.orientation = -s.orientation;
  events_.push_back({RayEvent::kSurface, 0});
  s.loss_db += interpolated(surface_loss_db_, sine) / std::max(sine, kMinSine);
  s.scattered_nepers += scattering_.surface * sine * sine;
  return goes_on(s);
}

bool FanTracer::go_to_knot(State& s, const ArcStep& step) {
  go(s, step.dr, step.z, step.sine);
  s.facet = profile_.facet_from(s.facet, s.r);
  if (step.turns) {
    note_turn(step.down);
    return true;
  }
  return run_through_layers(s, step.down ? s.layer + 1 : s.layer);
}

void FanTracer::stand_at_knot(State& s, std::size_t knot, bool down) const {
  s.layer = down ? knot : knot - 1;
  s.z = water_.depths_m()[knot];
  s.c = water_.speeds_mps()[knot];
  s.sine = down ? column_.sine_at(knot) : -column_.sine_at(knot);
  s.facet = profile_.facet_from(s.facet, s.r);
}

// A ray that rises more steeply than the bottom does anywhere cannot meet it. Within a layer the ray's sine
// lies between those at the layer's ends.
bool FanTracer::clears_bottom(double sine, double next_sine) const {
  return std::max(sine, next_sine) < -steepest_rise_;
}

bool FanTracer::next_layer_is_whole(State& s, std::size_t knot, bool down) const {
  const std::size_t layer = down ? knot : knot - 1, next = down ? knot + 1 : knot - 1;
  if (next > column_.last_knot() || !(column_.sine_at(next) > 0)) return false;
  const double dr = column_.range_through(layer);
  if (s.r + dr >= range_) return false;
  if (!is_near_bottom(layer)) return true;
  if (!down && clears_bottom(-column_.sine_at(knot), -column_.sine_at(next))) return true;
  s.facet = profile_.facet_from(s.facet, s.r);
  if (profile_.is_deeper_than(water_.depths_m()[layer + 1] + kKnotMargin, s.facet, s.r + dr)) return true;
  stand_at_knot(s, knot, down);
  const double next_sine = down ? column_.sine_at(next) : -column_.sine_at(next);
  s.hits = find_hit(curvature_of(water_, s), profile_, s,
                    {dr, water_.depths_m()[next], next_sine, false, down}, dr, s.hit);
  return !s.hits;
}

bool FanTracer::run_through_layers(State& s, std::size_t knot) {
  // Between bottom bounces (acoustics/rays/arcs/ray_column.h):
  //   E = d xi/d theta = -(sin p + g xi^2 q) is constant,
  //   X = -q / sin grows by E d(dr)/dxi in each layer.
  if (column_.xi() != s.xi) column_.set(s.xi);
  const double xi2 = s.xi * s.xi, sine_before = away_from_zero(s.sine);
  double turning = -(sine_before * s.p + water_.gradients_per_s()[s.layer] * xi2 * s.q);  // E
  double off = -s.q / sine_before;                                                        // X
  const RayColumn::Excursion& excursion = column_.excursion();
  for (bool down = s.sine > 0;; knot = down ? knot + 1 : knot - 1) {
    const bool away = !down && knot == column_.excursion_knot() && s.r + excursion.range_m < range_;
    if (away) {
      s.on_facet = false;
      s.r += excursion.range_m;
      off += turning * excursion.range_slope;
    }
    if (away && excursion.turns) {
      note_turn(false);
      down = true;
    } else if (away || (!down && knot == 0)) {
      if (!meet_surface(s, column_.sine_at(0))) return false;
      off = -off;  // the unfolded tube is mirrored at the surface
      turning = -turning;
      down = true;
    }
    if (!next_layer_is_whole(s, knot, down)) {
      stand_at_knot(s, knot, down);
      break;
    }
    const std::size_t layer = down ? knot : knot - 1;
    s.on_facet = false;
    s.r += column_.range_through(layer);
    off += turning * column_.range_slope_through(layer);
  }
  const double sine = away_from_zero(s.sine);
  s.q = -sine * off;
  s.p = -(turning + water_.gradients_per_s()[s.layer] * xi2 * s.q) / sine;
  return true;
}

void FanTracer::trace_from(State& s, std::size_t enough_events, FanRay& ray) {
  for (int steps = 0; steps < kMaxSteps; ++steps) {
    if (events_.size() - ray.first_event >= enough_events) return;
    if (s.hits) {
      if (!go_to_bottom(s, s.hit)) return;
      continue;
    }
    const ArcStep step = next_step(water_, s);
    const double left = range_ - s.r;
    const bool may_hit = is_near_bottom(s.layer) && !clears_bottom(s.sine, step.sine);
    if (may_hit && find_hit(curvature_of(water_, s), profile_, s, step, std::min(step.dr, left), s.hit)) {
      if (!go_to_bottom(s, s.hit)) return;
    } else if (step.dr >= left) {
      go_part(s, left);
      ray.arrived = true;
      ray.zeta = s.orientation * s.z + 2 * exact_.bottom_at_receiver_m() * s.images;
      ray.zeta_slope = s.q / std::sqrt(std::max(1 - s.sine * s.sine, kMinCosine * kMinCosine));
      ray.slowness = s.sine / s.c;
      return;
    } else if (!go_to_knot(s, step)) {
      return;
    }
  }
}

FanRay FanTracer::trace_through_section(double theta) {
  exact_.trace(theta, traced_);
  FanRay ray{.theta = theta, .first_event = events_.size(), .events = traced_.events.size()};
  events_.insert(events_.end(), traced_.events.begin(), traced_.events.end());
  ray.arrived = traced_.arrived;
  ray.loss_db = traced_.factor > 0 ? -20 * elementary::log10(traced_.factor) : kMaxLossOfABounceDb;
  if (!ray.arrived) return ray;
  ray.zeta = traced_.zeta;
  ray.zeta_slope = traced_.zeta_slope;
  ray.slowness = traced_.sine * traced_.xi / std::sqrt(1 - traced_.sine * traced_.sine);
  return ray;
}

FanRay FanTracer::trace(double theta, std::size_t enough_events) {
  if (exact_.sea().section != nullptr) return trace_through_section(theta);
  FanRay ray{.theta = theta, .first_event = events_.size()};
  State s = start(theta);
  trace_from(s, enough_events, ray);
  ray.loss_db = s.loss_db;
  ray.events = events_.size() - ray.first_event;
  return ray;
}

}  // namespace halocline::acoustics
