// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/ray_trace.h"

#include <algorithm>
#include <cstddef>
#include <numbers>

#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kGiveUpFactor = 0.25;  // relative to the least boundary factor
constexpr std::size_t kFactorSteps = 64;
constexpr std::size_t kReservedEvents = 48;  // per ray, so that its list of events rarely grows

}  // namespace

void RayTrace::begin(double launch_theta) {
  theta = launch_theta;
  arrived = false;
  factor = 1;
  scattered_nepers = 0;
  family = 0;
  surface_bounces = bottom_bounces = upper_turns = lower_turns = caustics = 0;
  events.clear();
  events.reserve(kReservedEvents);
}

BounceLosses::BounceLosses(const ProfiledSea& sea, double deepest_speed_mps)
    : options_(sea.options),
      bottom_(sea.bottom),
      surface_loss_(sea.surface, sea.options.frequency_hz),
      min_factor_(kGiveUpFactor * sea.options.min_boundary_factor),
      bottom_factor_(kFactorSteps + 1) {
  for (std::size_t i = 0; i <= kFactorSteps; ++i) {
    bottom_factor_[i] = bottom_magnitude_at_sine(
        bottom_, static_cast<double>(i) / static_cast<double>(kFactorSteps), deepest_speed_mps);
  }
}

double BounceLosses::rough_bottom_factor(double sine) const {
  const double place = sine * static_cast<double>(kFactorSteps);
  const std::size_t i = std::min(static_cast<std::size_t>(place), kFactorSteps - 1);
  return bottom_factor_[i] + (place - static_cast<double>(i)) * (bottom_factor_[i + 1] - bottom_factor_[i]);
}

bool BounceLosses::goes_on(const RayTrace& ray) const {
  return ray.factor >= min_factor_ &&
         !options_.scattering.leaves_none(ray.surface_bounces + ray.bottom_bounces, ray.scattered_nepers);
}

// A pressure release surface, V = -1, with the loss by wind and bubbles.
bool BounceLosses::at_surface(double sine, RayTrace& ray, TraceDetails* details) const {
  ray.events.push_back({RayEvent::kSurface, 0});
  ray.family = continued_family(ray.family, 0);
  ++ray.surface_bounces;
  if (is_excluded(ray.theta, ray.surface_bounces + ray.bottom_bounces)) return false;
  const double lost_db = surface_loss_.db_at_sine(std::min(sine, 1.0));
  if (lost_db > 0) ray.factor *= elementary::exp(-std::numbers::ln10 / 20 * lost_db);
  if (details != nullptr) {
    details->surface_loss_db += lost_db;
    details->surface_sine_squares += sine * sine;
  }
  ray.scattered_nepers += options_.scattering.nepers(sine * sine, 0);
  return goes_on(ray);
}

// Rayleigh's reflection coefficient V (acoustics/sea/boundary_reflection.h).
bool BounceLosses::at_bottom(const Facet& facet, double sine, double speed_mps, RayTrace& ray,
                             TraceDetails* details) const {
  ray.events.push_back({RayEvent::kBottom, facet.smooth_group});
  ray.family = continued_family(ray.family, 1 + facet.smooth_group);
  ++ray.bottom_bounces;
  if (is_excluded(ray.theta, ray.surface_bounces + ray.bottom_bounces)) return false;
  if (details == nullptr) {
    ray.factor *= rough_bottom_factor(sine);
  } else {
    const Reflection one = bottom_reflection_at_sine(bottom_, std::min(sine, 1.0), speed_mps);
    ray.factor *= one.magnitude;
    details->phase_rad += one.phase_rad;
    details->bottom_loss_db += one.loss_db();
    details->bottom_sine_squares += sine * sine;
  }
  ray.scattered_nepers += options_.scattering.nepers(0, sine * sine);
  return goes_on(ray);
}

}  // namespace halocline::acoustics
