// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/energy_flux.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "acoustics/rays/traced_eigenray.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kCoarseness = 3;  // width of windows relative to those of a ray search
// Lower bound of the sine, hence upper bound of the density near a turning point.
constexpr double kMinTurnSine = 0.02;
constexpr double kKeptShare = 0.99;  // share of the power
constexpr double kFarAway = 10;      // least length of a flux-only link, in depths
// Numbers of end depths and of bottom depths at which the least loss is sought.
constexpr int kEnds = 12, kBottoms = 5;

// Sine of the ray's angle by Snell's law, cos(angle) = xi c.
double sine_at(double xi, double speed) { return std::sqrt(std::max(1 - xi * xi * speed * speed, 0.0)); }

// Half a cycle of a ray in water of constant depth: between two points where it turns or meets a boundary.
struct HalfCycle {
  double range_m = 0, delay_s = 0, length_m = 0, absorption_db = 0;
  double upper_m = 0, lower_m = 0;  // depths of the highest and lowest point
};

// A depth with the sound speed there.
struct Place {
  Place(const RayWater& water, double at_m) : depth_m(at_m), speed_mps(water.speed_at(at_m)) {}
  double depth_m, speed_mps;
};

// A link in the terms of the energy flux.
struct EnergyFluxLink {
  Place source, receiver, bottom;
  double range_m;
};

// Adds the leg of the ray of `xi` from a place, upwards or downwards, to where it turns or to `limit_m`.
// Returns the depth of its end.
double add_leg(const RayWater& water, double xi, const Place& from, double limit_m, HalfCycle& half) {
  const double depth_m = from.depth_m;
  const bool down = limit_m > depth_m;
  std::size_t layer = water.layer_at(depth_m);
  if (!down && depth_m == water.depths_m()[layer] && layer > 0) --layer;
  double z = depth_m, c = from.speed_mps, s = sine_at(xi, c);
  while (z != limit_m && s > 0) {
    const double edge =
        down ? std::min(water.depths_m()[layer + 1], limit_m) : std::max(water.depths_m()[layer], limit_m);
    const double g = water.gradients_per_s()[layer], c2 = c + g * (edge - z), s2 = sine_at(xi, c2);
    // Across a layer of thickness h with a constant gradient g, from the speed c1 to c2 (sines s1 and s2),
    // and to a turning point:
    //   dr = h xi (c1 + c2) / (s1 + s2),  dr = s / (xi |g|).
    const double dr = s2 > 0 ? std::abs(edge - z) * xi * (c + c2) / (s + s2) : s / (xi * std::abs(g));
    const double end = s2 > 0 ? edge : z + (1 / xi - c) / g;
    const double length = dr / (xi * (s2 > 0 ? 0.5 * (c + c2) : 0.5 * (c + 1 / xi)));
    half.range_m += dr;
    half.length_m += length;
    half.delay_s += length / (s2 > 0 ? 0.5 * (c + c2) : 0.5 * (c + 1 / xi));
    half.absorption_db += length * water.absorption_db_per_m(0.5 * (z + end), layer);
    z = end;
    c = c2;
    s = s2;
    if (down ? layer + 1 < water.layers() : layer > 0) layer += down ? 1 : -1;
  }
  return z;
}

// Power of a flux-only link: `below` under that of RayOptions::diffuse_below_pressure.
double weak_power(const RayOptions& options, Decibels below) {
  return options.diffuse_below_pressure * options.diffuse_below_pressure * to_power_ratio(-below).value;
}

double power_of(const Eigenray& path) { return path.received_pressure() * path.received_pressure(); }

double surface_loss_of(const EnergyFluxSea& sea, double xi) {
  const double sine = sine_at(xi, sea.water.speeds_mps().front());
  return surface_loss_db(sea.surface, elementary::asin(sine), sea.options.frequency_hz);
}

// Sets the bounces over the range, and the loss at both boundaries.
void set_bounces(const EnergyFluxSea& sea, double xi, const HalfCycle& half, double bottom_speed_mps,
                 double range_m, Eigenray& window) {
  const double times = range_m / half.range_m / 2;
  if (half.upper_m == 0) {
    const double sine = sine_at(xi, sea.water.speeds_mps().front());
    window.surface_bounces = static_cast<int>(times);
    window.surface_sine_squares = times * sine * sine;
    window.surface_loss_db = times * surface_loss_of(sea, xi);
  }
  if (half.lower_m == sea.depth_m) {
    const double sine = sine_at(xi, bottom_speed_mps);
    window.bottom_bounces = static_cast<int>(times);
    window.bottom_sine_squares = times * sine * sine;
    window.bottom_loss_db =
        -20 * times * elementary::log10(bottom_magnitude_at_sine(sea.bottom, sine, bottom_speed_mps));
  }
}

// Density of the rays of `xi` over depth, 1/m, during half a cycle: cot(angle) / half cycle.
double density_at(double xi, const Place& place, const HalfCycle& half) {
  if (place.depth_m < half.upper_m || place.depth_m > half.lower_m) return 0;
  return xi * place.speed_mps / std::max(sine_at(xi, place.speed_mps), kMinTurnSine) / half.range_m;
}

// Diffuse path of the rays launched between the angles `low` and `high`; none when they miss the receiver's
// depth.
std::optional<Eigenray> window_of(const EnergyFluxSea& sea, const EnergyFluxLink& link, double low,
                                  double high) {
  const double theta = 0.5 * (low + high), speed = link.receiver.speed_mps;
  const double xi = elementary::cos(theta) / link.source.speed_mps;
  HalfCycle half;
  half.upper_m = add_leg(sea.water, xi, link.source, 0, half);
  half.lower_m = add_leg(sea.water, xi, link.source, sea.depth_m, half);
  if (!(half.range_m > 0)) return std::nullopt;
  Eigenray window;
  set_bounces(sea, xi, half, link.bottom.speed_mps, link.range_m, window);
  const double power = density_at(xi, link.receiver, half) * elementary::exp10(-window.bounce_loss_db() / 10);
  if (!(power > 0)) return std::nullopt;
  // Power of the window: f^2 cot(angle at the receiver) / D dtheta / r.
  window.amplitude = std::sqrt((high - low) * power / link.range_m);
  const double halves = link.range_m / half.range_m;
  window.delay_s = half.delay_s * halves;
  window.path_length_m = half.length_m * halves;
  window.absorption_db = half.absorption_db * halves;
  window.launch_angle_rad = theta;
  window.arrival_angle_rad = std::copysign(elementary::acos(std::min(xi * speed, 1.0)), theta);
  window.launch_slowness_spm = window.range_slowness_spm = xi;
  window.diffuse = true;
  return window;
}

// Keeps the strongest windows that together have kKeptShare of the power, sorted by delay.
void keep_most(std::vector<Eigenray>& windows) {
  double power = 0, kept = 0;
  for (const Eigenray& window : windows) power += power_of(window);
  std::stable_sort(windows.begin(), windows.end(),
                   [](const Eigenray& a, const Eigenray& b) { return power_of(a) > power_of(b); });
  std::size_t count = 0;
  while (count < windows.size() && kept < kKeptShare * power) kept += power_of(windows[count++]);
  windows.resize(count);
  std::stable_sort(windows.begin(), windows.end(),
                   [](const Eigenray& a, const Eigenray& b) { return a.delay_s < b.delay_s; });
}

std::vector<Eigenray> all_windows(const EnergyFluxSea& sea, const RayLink& link) {
  const std::vector<double> edges = even_angles(sea.options.max_launch_angle_rad, kCoarseness);
  const EnergyFluxLink mixed{{sea.water, link.source_depth_m},
                             {sea.water, link.receiver_depth_m},
                             {sea.water, sea.depth_m},
                             link.range_m};
  std::vector<Eigenray> windows;
  for (std::size_t i = 1; i < edges.size(); ++i) {
    auto window = window_of(sea, mixed, edges[i - 1], edges[i]);
    if (!window) continue;
    window->identity = diffuse_identity(window->launch_angle_rad, i);
    windows.push_back(*window);
  }
  return windows;
}

}  // namespace

std::vector<Eigenray> energy_flux_eigenrays(const EnergyFluxSea& sea, const RayLink& link) {
  std::vector<Eigenray> windows = all_windows(sea, link);
  keep_most(windows);
  return windows;
}

bool may_be_flux_only(const RayWater& water, const RayOptions& options, const RayLink& link, Decibels below) {
  const double r = link.range_m, absorption_db = r * water.absorption_db_per_m(link.source_depth_m);
  const double direct = elementary::exp10(-absorption_db / 10) / (r * r);
  return options.diffuse_below_db > 0 && direct <= weak_power(options, below);
}

std::optional<std::vector<Eigenray>> flux_only_eigenrays(const EnergyFluxSea& sea, const RayLink& link,
                                                         Decibels below) {
  if (link.range_m < kFarAway * sea.depth_m || !may_be_flux_only(sea.water, sea.options, link, below))
    return std::nullopt;
  std::vector<Eigenray> windows = energy_flux_eigenrays(sea, link);
  double power = 0;
  for (const Eigenray& window : windows) power += power_of(window);
  return windows.empty() || power > weak_power(sea.options, below) ? std::nullopt
                                                                   : std::optional(std::move(windows));
}

// Every loss of a window grows linearly with range, so that its loss over 1 m is sufficient.
LeastFluxLoss::LeastFluxLoss(const EnergyFluxSea& sea, const Depths& depths, Decibels gain)
    : shortest_m_(kFarAway * depths.greatest_m),
      least_absorption_db_per_m_(std::numeric_limits<double>::infinity()),
      gain_(gain) {
  constexpr double kMetre = 1, kNepersPerDb = std::numbers::ln10 / 10;
  const double growth = elementary::exp(elementary::log(depths.greatest_m / depths.least_m) / (kBottoms - 1));
  double depth_m = depths.least_m;
  for (int bottom = 0; bottom < kBottoms; ++bottom, depth_m *= growth) {
    const EnergyFluxSea here{sea.water, depth_m, sea.bottom, sea.surface, sea.options};
    const double step_m = std::min(depths.deepest_end_m, depth_m) / kEnds;
    for (int i = 0; i < kEnds; ++i) {
      least_absorption_db_per_m_ =
          std::min(least_absorption_db_per_m_, sea.water.absorption_db_per_m(i * step_m));
      for (int j = 0; j <= i; ++j) {
        links_.emplace_back();
        for (const Eigenray& one : all_windows(here, {(i + 0.5) * step_m, (j + 0.5) * step_m, kMetre})) {
          const double boundaries_db = one.bounce_loss_db();
          if (!(one.amplitude > 0)) continue;
          links_.back().push_back({one.amplitude * one.amplitude * elementary::exp10(boundaries_db / 10),
                                   kNepersPerDb * (one.absorption_db + boundaries_db)});
        }
      }
    }
  }
}

Decibels LeastFluxLoss::at(double range_m) const {
  double most = 0;
  for (const std::vector<Window>& link : links_) {
    double power = 0;
    for (const Window& window : link)
      power += window.power_m * elementary::exp(-window.nepers_per_m * range_m);
    most = std::max(most, power / range_m);
  }
  return most > 0 ? -to_decibels(PowerRatio{most}) - gain_
                  : Decibels{std::numeric_limits<double>::infinity()};
}

double LeastFluxLoss::range_of(Decibels loss, Decibels flux_only_loss) const {
  constexpr double kBeyondAll = std::numeric_limits<double>::infinity(), kFurthest = 1e7;
  if (loss < flux_only_loss) return kBeyondAll;
  const auto matters = [&](double range_m) {
    const double direct_db = 20 * elementary::log10(range_m) + least_absorption_db_per_m_ * range_m;
    return at(range_m) <= loss || direct_db <= flux_only_loss.value;
  };
  if (!matters(shortest_m_)) return shortest_m_;
  double low = shortest_m_, high = std::max(kFurthest, shortest_m_);
  if (matters(high)) return kBeyondAll;
  while (high > low * (1 + 1e-4)) {
    const double middle = std::sqrt(low * high);
    (matters(middle) ? low : high) = middle;
  }
  return high;
}

}  // namespace halocline::acoustics
