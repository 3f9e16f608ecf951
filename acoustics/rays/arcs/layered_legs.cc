// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/arcs/layered_legs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acoustics/math/arc_math.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr double kThinnestLayer = 1e-9;    // m
constexpr double kMinSquaredSine = 1e-28;  // lower bound that keeps a grazing ray finite
// Bounds in x of turning_field.h, from an end of the link to a boundary: below kNearBoundary the wave
// correction fades out towards plain ray theory.
constexpr double kNearBoundary = 1, kEndReach = 2;

// Snell's law: with cos = xi c, xi = cos* / c* and sin* the sine at the barrier,
//   sin^2 = ((c* - c)(c* + c) + sin*^2 c^2) / c*^2.
struct SineAt {
  double barrier, inverse_barrier_squared, squared_sine;
  // The square of the sine; negative at a speed before which the ray turns.
  double square(double c) const {
    return ((barrier - c) * (barrier + c) + squared_sine * c * c) * inverse_barrier_squared;
  }
  double operator()(double c) const { return std::sqrt(std::max(square(c), kMinSquaredSine)); }
};

constexpr std::size_t index_of(Leg leg) { return static_cast<std::size_t>(leg); }

}  // namespace

LayeredLegs::LayeredLegs(const RayWater& water, double upper_m, double lower_m, double bottom_m,
                         double frequency_hz) {
  append(up_, water, upper_m, 0);
  append(between_, water, upper_m, lower_m);
  append(down_, water, lower_m, bottom_m);
  if (frequency_hz > 0) {
    mark_knots(up_, frequency_hz);
    mark_knots(down_, frequency_hz);
  }
  barrier_ = std::max(water.speed_at(upper_m), water.speed_at(lower_m));
  for (const LegLayer& layer : between_) barrier_ = std::max({barrier_, layer.c1, layer.c2});
  pass_what_is_slower();
}

void LayeredLegs::append(std::vector<LegLayer>& layers, const RayWater& water, double from_m, double to_m) {
  if (std::abs(to_m - from_m) < kThinnestLayer) return;
  const bool downward = to_m > from_m;
  const std::vector<double>& knots = water.depths_m();
  const std::size_t first = water.layer_at(std::min(from_m, to_m)),
                    last = water.layer_at(std::max(from_m, to_m));
  layers.reserve(last - first + 1);
  for (std::size_t step = 0; step <= last - first; ++step) {
    const std::size_t layer = downward ? first + step : last - step;
    const double top = std::max(knots[layer], std::min(from_m, to_m));
    const double base = std::min(knots[layer + 1], std::max(from_m, to_m));
    if (base - top < kThinnestLayer) continue;
    const auto speed = [&](double z) {
      if (z == knots[layer + 1]) return water.speeds_mps()[layer + 1];  // to the bit: barriers are compared
      return water.speeds_mps()[layer] + water.gradients_per_s()[layer] * (z - knots[layer]);
    };
    const auto share = [&](double z) { return (z - knots[layer]) / (knots[layer + 1] - knots[layer]); };
    const double from = downward ? top : base, to = downward ? base : top;
    const double c1 = speed(from), c2 = speed(to), height = base - top;
    const double gradient = downward ? water.gradients_per_s()[layer] : -water.gradients_per_s()[layer];
    layers.push_back({height, c1, c2, gradient, height * (c1 + c2),
                      restricted(water.absorption()[layer], share(from), share(to))});
  }
}

// Marks the far ends of layers at which rays can turn close to a knot or a boundary: those with speed rising
// on both sides of the knot, or up to the boundary.
void LayeredLegs::mark_knots(std::vector<LegLayer>& layers, double frequency_hz) {
  if (layers.empty()) return;
  const double start = layers.front().c1;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    LegLayer& layer = layers[i];
    layer.is_last = i + 1 == layers.size();
    const double before = layer.gradient, beyond = layer.is_last ? before : layers[i + 1].gradient;
    if (before <= 0 || beyond <= 0 || layer.c2 <= start) continue;
    // Squares of two sines: the wave's scale s0, and the sine at the knot of the ray that is horizontal at
    // the end of the link.
    const double wave = elementary::pow(turning_sine(std::min(before, beyond), frequency_hz), 2);
    const double end = (layer.c2 - start) * (layer.c2 + start) / (layer.c2 * layer.c2);
    if (layer.is_last) {
      const double x = end / wave, t = std::min(x / kNearBoundary, 1.0);
      layer.knot_s = -t * t * (3 - 2 * t) / before;
      layer.turning_sine = std::sqrt(wave);
      layer.end_x = x;
      layer.at_end = turning_at_boundary(-std::min(x, -kDeepTurning));
    } else {
      layer.knot_s = 1 / beyond - 1 / before;
      const double wider = knot_widening(std::min(before, beyond) * std::abs(layer.knot_s));
      layer.turning_sine = std::sqrt(std::min(wave * wider, end / kKnotHalfWidth));
    }
  }
}

template <class Visit>
void LayeredLegs::visit_knots(const std::vector<LegLayer>& layers, std::size_t reach, double squared_sine,
                              Visit visit) const {
  const SineAt sine{barrier_, inverse_barrier_squared_, squared_sine};
  const auto is_near = [&](const LegLayer& layer, bool is_passed) {
    if (layer.knot_s == 0) return layer.gradient > 0;
    const double square = sine.square(layer.c2), x = square / (layer.turning_sine * layer.turning_sine);
    if (!(x > kDeepTurning && x < kSteepTurning)) return false;
    NearKnot knot{layer, layer.is_last ? turning_at_boundary(x) : turning_at_knot(x), square, 0};
    if (square > 0 && is_passed) {
      knot.inverse_sine = 1 / std::sqrt(std::max(square, kMinSquaredSine));
    } else if (square > 0) {  // the ray continued beyond the knot as if the gradient did not change
      knot.share.sine += std::sqrt(x);
      knot.share.phase += 2.0 / 3 * x * std::sqrt(x);
    }
    // The correction vanishes for the ray that is horizontal at the end of the link: a leg to the boundary
    // does not change it.
    const double off = 1 - (layer.end_x + x) / kEndReach;
    if (layer.is_last && off > 0) {
      knot.share.sine -= off * off * layer.at_end.sine;
      knot.share.slope += 4 / kEndReach * off * layer.at_end.sine;
      knot.share.phase -= off * off * layer.at_end.phase;
    }
    visit(knot);
    return true;
  };
  for (std::size_t i = reach; i > 0 && is_near(layers[i - 1], true); --i) {
  }
  for (std::size_t i = reach; i < layers.size() && is_near(layers[i], false); ++i) {
  }
}

void LayeredLegs::pass_what_is_slower() {
  while (up_reach_ < up_.size() && up_[up_reach_].c2 <= barrier_) ++up_reach_;
  while (down_reach_ < down_.size() && down_[down_reach_].c2 <= barrier_) ++down_reach_;
  inverse_barrier_squared_ = 1 / (barrier_ * barrier_);
}

double LayeredLegs::next_barrier_mps() const {
  const double above = meets_surface() ? 0 : up_[up_reach_].c2;
  const double below = meets_bottom() ? 0 : down_[down_reach_].c2;
  return above > 0 && below > 0 ? std::min(above, below) : std::max(above, below);
}

bool LayeredLegs::advance() {
  const double next = next_barrier_mps();
  if (next <= 0) return false;
  const auto is_smooth = [next](const std::vector<LegLayer>& layers, std::size_t reach) {
    if (reach == layers.size() || layers[reach].c2 != next) return true;
    return layers[reach].knot_s != 0 ||
           (reach + 1 < layers.size() && layers[reach].gradient == layers[reach + 1].gradient);
  };
  smooth_ = is_smooth(up_, up_reach_) && is_smooth(down_, down_reach_);
  barrier_ = next;
  pass_what_is_slower();
  return true;
}

double LayeredLegs::sine_at(double speed_mps, double sine) const {
  return SineAt{barrier_, inverse_barrier_squared_, sine * sine}(speed_mps);
}

void LayeredLegs::add_sums(const std::vector<LegLayer>& layers, std::size_t reach, double squared_sine,
                           Leg leg, LegSums& sums, double& end_sine) const {
  if (layers.empty()) return;
  // Through one layer (acoustics/math/arc_math.h; Jensen, Kuperman, Porter and Schmidt 2011, section 3.3:
  // circular arcs):
  //   r / xi = h (c1 + c2) / (s1 + s2)
  //   dr/dxi = h (c1 + c2) / ((s1 + s2) s1 s2)
  const SineAt sine{barrier_, inverse_barrier_squared_, squared_sine};
  double s1 = sine(layers.front().c1), q = 0, m = 0;
  for (std::size_t i = 0; i < reach; ++i) {
    const double s2 = sine(layers[i].c2);
    const double part = layers[i].hc / ((s1 + s2) * s1 * s2);
    q += part * s1 * s2;
    m += part;
    s1 = s2;
  }
  end_sine = s1;
  // A ray that turns within the layer: r = s1 / (xi g), dr/dxi = -1 / (g xi^2 s1).
  if (reach < layers.size()) {
    const double scale = 1 / (layers[reach].gradient * sums.xi * sums.xi);
    q += scale * s1;
    m -= scale / s1;
    end_sine = 0;
  }
  // Corrections near knots (acoustics/math/turning_field.h), D the change of 1 / gradient:
  //   r / xi += D s0 S / xi^2,  S the share's sine;  dr/dxi accordingly
  visit_knots(layers, reach, squared_sine, [&](const NearKnot& knot) {
    const double s0 = knot.layer.turning_sine, scale = knot.layer.knot_s / (sums.xi * sums.xi);
    q += scale * s0 * knot.share.sine;
    m -= scale * (s0 * knot.share.sine + (1 - knot.square) * (knot.share.slope / s0 - knot.inverse_sine));
  });
  sums.q[index_of(leg)] = q;
  sums.m[index_of(leg)] = m;
}

LegSums LayeredLegs::sums(double sine, double cosine) const {
  LegSums sums;
  const double squared_sine = sine * sine;
  double unused = 0;
  sums.xi = cosine / barrier_;
  if (up_.empty()) sums.sine_top = sine_at(between_.empty() ? down_.front().c1 : between_.front().c1, sine);
  if (down_.empty()) sums.sine_bottom = sine_at(between_.empty() ? up_.front().c1 : between_.back().c2, sine);
  add_sums(up_, up_reach_, squared_sine, Leg::kUp, sums, sums.sine_top);
  add_sums(between_, between_.size(), squared_sine, Leg::kBetween, sums, unused);
  add_sums(down_, down_reach_, squared_sine, Leg::kDown, sums, sums.sine_bottom);
  return sums;
}

void LayeredLegs::add_layer(const LegLayer& layer, double s1, double s2, double xi, std::size_t leg,
                            LegDetails& details) {
  // q = r / xi; k, tau and length are K, tau and L of acoustics/math/arc_math.h. The intercept time
  //   tau - xi r = tau - xi^2 q
  // is stationary in xi.
  const double q = layer.hc / (s1 + s2), c1 = layer.c1, c2 = layer.c2;
  const double k = (1 + s1 + c1 * xi * xi * (c1 + c2) / (s1 + s2)) / (c1 * (1 + s2));
  const double tau = layer.height_m * k * log1p_over(layer.gradient * layer.height_m * k);
  const double chord = layer.hc / (s1 * c2 + s2 * c1);
  const double length = chord * asin_over(xi * layer.gradient * chord);
  details.intercept_s[leg] += tau - xi * xi * q;
  details.length_m[leg] += length;
  details.absorption_db[leg] += length * mean_absorption(layer.absorption, s1, s2);
}

void LayeredLegs::add_details(const std::vector<LegLayer>& layers, std::size_t reach, double squared_sine,
                              double xi, Leg leg, LegDetails& details) const {
  if (layers.empty()) return;
  const SineAt sine{barrier_, inverse_barrier_squared_, squared_sine};
  double s1 = sine(layers.front().c1);
  for (std::size_t i = 0; i < reach; ++i) {
    const double s2 = sine(layers[i].c2);
    add_layer(layers[i], s1, s2, xi, index_of(leg), details);
    s1 = s2;
  }
  visit_knots(layers, reach, squared_sine, [&](const NearKnot& knot) {
    const LegLayer& layer = knot.layer;
    const double s0 = layer.turning_sine, range = layer.knot_s / xi * s0 * knot.share.sine;
    details.length_m[index_of(leg)] += range;
    details.absorption_db[index_of(leg)] += range * mean_absorption(restricted(layer.absorption, 1, 1), 1, 1);
    // The phase at a boundary is accounted for by touch().
    if (!layer.is_last)
      details.intercept_s[index_of(leg)] +=
          layer.knot_s * s0 * s0 * s0 / 2 * knot.share.phase / (1 - knot.square);
  });
  if (reach == layers.size()) return;
  // The part of the layer up to the turning point, where c = 1 / xi; its height follows from
  //   1 / xi - c1 = s1^2 / (xi^2 (1 / xi + c1)).
  LegLayer part = layers[reach];
  part.c2 = 1 / xi;
  part.height_m = s1 * s1 / (xi * xi * (part.c2 + part.c1) * part.gradient);
  part.hc = part.height_m * (part.c1 + part.c2);
  part.absorption = restricted(layers[reach].absorption, 0, part.height_m / layers[reach].height_m);
  add_layer(part, s1, 0, xi, index_of(leg), details);
}

LegDetails LayeredLegs::details(double sine, double cosine) const {
  LegDetails details;
  const double squared_sine = sine * sine, xi = cosine / barrier_;
  add_details(up_, up_reach_, squared_sine, xi, Leg::kUp, details);
  add_details(between_, between_.size(), squared_sine, xi, Leg::kBetween, details);
  add_details(down_, down_reach_, squared_sine, xi, Leg::kDown, details);
  return details;
}

BoundaryTouch LayeredLegs::touch(Leg leg, double sine) const {
  const std::vector<LegLayer>& layers = leg == Leg::kUp ? up_ : down_;
  const std::size_t reach = leg == Leg::kUp ? up_reach_ : down_reach_;
  const bool reflects = reach == layers.size();
  BoundaryTouch touch;
  if (layers.empty()) return touch;
  const double inverse = reflects ? 1 / sine_at(layers.back().c2, sine) : 0;
  touch.turned_rad = reflects ? pi / 4 : 0;
  visit_knots(layers, reach, sine * sine, [&](const NearKnot& knot) {
    if (!knot.layer.is_last) return;
    const double weight = -knot.layer.knot_s * knot.layer.gradient;
    touch.phase_rad = weight * (knot.share.phase - touch.turned_rad);
    touch.turned_rad += touch.phase_rad;
    touch.inverse_sine = inverse + weight * (knot.share.slope / knot.layer.turning_sine - inverse);
  });
  return touch;
}

}  // namespace halocline::acoustics
