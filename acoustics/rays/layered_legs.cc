#include "acoustics/rays/layered_legs.h"

#include <algorithm>
#include <cmath>

#include "acoustics/math/arc_math.h"
#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {
namespace {

constexpr double kThinnestLayer = 1e-9;    // m
constexpr double kMinSquaredSine = 1e-28;  // keeps a ray that just grazes finite

// Snell's law: with cos = xi c and xi = cos* / c*, sin^2 = ((c* - c)(c* + c) + sin*^2 c^2) / c*^2, sin* at the barrier.
struct SineAt {
  double barrier, inverse_barrier_squared, squared_sine;
  double operator()(double c) const {
    const double exact = ((barrier - c) * (barrier + c) + squared_sine * c * c) * inverse_barrier_squared;
    return std::sqrt(std::max(exact, kMinSquaredSine));
  }
};

constexpr std::size_t index_of(Leg leg) { return static_cast<std::size_t>(leg); }

}  // namespace

LayeredLegs::LayeredLegs(const RayWater& water, double upper_m, double lower_m, double bottom_m) {
  append(up_, water, upper_m, 0);
  append(between_, water, upper_m, lower_m);
  append(down_, water, lower_m, bottom_m);
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
  // Through a layer r / xi = h (c1 + c2) / (s1 + s2) and dr/dxi = h (c1 + c2) / ((s1 + s2) s1 s2)
  // (acoustics/math/arc_math.h; Jensen, Kuperman, Porter and Schmidt 2011, section 3.3: arcs of circles).
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
  if (reach < layers.size()) {  // turns within: r = s1 / (xi g), dr/dxi = -1 / (g xi^2 s1)
    const double scale = 1 / (layers[reach].gradient * sums.xi * sums.xi);
    q += scale * s1;
    m -= scale / s1;
    end_sine = 0;
  }
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
  // q = r / xi; tau and L of acoustics/math/arc_math.h; the intercept time tau - xi r is stationary in xi.
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
  if (reach == layers.size()) return;
  LegLayer part =
      layers[reach];  // as far as the turn, where c = 1 / xi: 1 / xi - c1 = s1^2 / (xi^2 (1 / xi + c1))
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

}  // namespace halocline::acoustics
