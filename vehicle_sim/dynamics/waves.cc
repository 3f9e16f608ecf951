// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/waves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.h"
#include "core/elementary.h"
#include "core/random.h"

namespace halocline::vehicle_sim {
namespace {

using std::numbers::pi;

constexpr double kLowest = 0.5, kHighest = 4;  // times the peak frequency: all but 0.5 % of the energy
constexpr double kNarrowBelow = 0.07, kNarrowAbove = 0.09;  // sigma of JONSWAP below and above the peak

double uniform(std::uint64_t seed, const char* purpose, int component) {
  return uniform_at({.seed = seed,
                     .purpose = purpose_of(purpose),
                     .who = static_cast<std::uint32_t>(component),
                     .which = 0});
}

// JONSWAP spectrum (Hasselmann et al. 1973), up to a factor; gamma = 1 is that of Pierson and Moskowitz 1964:
//
//   S(omega) ~ omega^-5 exp(-5/4 (omega_p / omega)^4) gamma^b
//   b        = exp(-(omega - omega_p)^2 / (2 sigma^2 omega_p^2)),  sigma = 0.07 below the peak, 0.09 above
double spectrum(double omega, double peak, double gamma) {
  const double sigma = omega <= peak ? kNarrowBelow : kNarrowAbove;
  const double bell = elementary::exp(-elementary::pow((omega - peak) / (sigma * peak), 2) / 2);
  return elementary::pow(omega, -5) * elementary::exp(-1.25 * elementary::pow(peak / omega, 4)) *
         elementary::pow(gamma, bell);
}

// Dispersion relation of deep water: k = omega^2 / g.
WaveField::Component component(double amplitude, double omega, double phase) {
  return {amplitude, omega, omega * omega / WaveField::kGravity, phase};
}

// Amplitudes of the components, scaled to the significant height H_s:
//
//   a_i = sqrt(2 S(omega_i) d omega),  sum of a_i^2 / 2 = (H_s / 4)^2
std::vector<WaveField::Component> sea(const WaveSettings& s, double gamma, std::uint64_t seed) {
  const double peak = 2 * pi / s.period_s, width = (kHighest - kLowest) * peak / s.components;
  std::vector<WaveField::Component> components;
  double energy = 0;  // sum of a^2 / 2
  for (int i = 0; i < s.components; ++i) {
    const double omega = kLowest * peak + (i + uniform(seed, "wave-frequency", i)) * width;
    const double amplitude = std::sqrt(2 * spectrum(omega, peak, gamma) * width);
    energy += amplitude * amplitude / 2;
    components.push_back(component(amplitude, omega, 2 * pi * uniform(seed, "wave-phase", i)));
  }
  const double scale = s.height_m / 4 / std::sqrt(energy);
  for (auto& c : components) c.amplitude_m *= scale;
  return components;
}

}  // namespace

WaveField::WaveField(const WaveSettings& s, std::uint64_t seed)
    : north_(elementary::cos(s.toward_rad)), east_(elementary::sin(s.toward_rad)) {
  require_in_range(s.height_m, 0, 40, "wave height", "m");
  require_in_range(s.period_s, 1, 30, "wave period", "s");
  require_in_range(s.peakedness, 1, 10, "peakedness");
  require_in_range(s.components, 1, 1000, "wave components");
  require_finite(s.toward_rad, "direction of waves");
  if (s.height_m == 0 || s.kind == SeaKind::kCalm) return;
  if (s.kind == SeaKind::kRegular) {
    components_ = {component(s.height_m / 2, 2 * pi / s.period_s, 2 * pi * uniform(seed, "wave-phase", 0))};
  } else {
    components_ = sea(s, s.kind == SeaKind::kJonswap ? s.peakedness : 1, seed);
  }
}

// Orbital velocity and its rate of change at a fixed place (Faltinsen 1990, table 2.1):
//
//   theta = k s - omega t + phi
//   v     = a omega exp(-k d) (cos(theta) along, sin(theta) up)
//   dv/dt = a omega^2 exp(-k d) (sin(theta) along, -cos(theta) up)
WaterMotion WaveField::at(const Vec3& position_ned_m, double depth_m, SimTime now) const {
  const double along = north_ * position_ned_m.x() + east_ * position_ned_m.y(), t = now.seconds();
  const double depth = std::max(depth_m, 0.0);
  double forward = 0, down = 0, forward_rate = 0, down_rate = 0;
  for (const Component& c : components_) {
    const double theta = c.wave_number_per_m * along - c.frequency_radps * t + c.phase_rad;
    const double speed = c.amplitude_m * c.frequency_radps * elementary::exp(-c.wave_number_per_m * depth);
    const double cosine = speed * elementary::cos(theta), sine = speed * elementary::sin(theta);
    forward += cosine;
    down -= sine;
    forward_rate += c.frequency_radps * sine;  // d theta / dt = -omega
    down_rate += c.frequency_radps * cosine;
  }
  return {{forward * north_, forward * east_, down},
          {forward_rate * north_, forward_rate * east_, down_rate}};
}

// Elevation, or at a depth d the pressure head of the waves: sum of a exp(-k d) cos(theta).
double WaveField::elevation_m(const Vec3& position_ned_m, double depth_m, SimTime now) const {
  const double along = north_ * position_ned_m.x() + east_ * position_ned_m.y(), t = now.seconds();
  const double depth = std::max(depth_m, 0.0);
  double sum = 0;
  for (const Component& c : components_) {
    const double theta = c.wave_number_per_m * along - c.frequency_radps * t + c.phase_rad;
    sum += c.amplitude_m * elementary::exp(-c.wave_number_per_m * depth) * elementary::cos(theta);
  }
  return sum;
}

double WaveField::highest_m() const {
  double sum = 0;
  for (const Component& c : components_) sum += c.amplitude_m;
  return sum;
}

}  // namespace halocline::vehicle_sim
