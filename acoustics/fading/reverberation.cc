// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/fading/reverberation.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "acoustics/rays/eigenray.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

constexpr double kSoundSpeedMps = 1500;
constexpr double kMinDecay = 7;  // nepers of power: the tail ends 30 dB down
// First identity of the tail's paths; no traced path has such an identity, for it would bounce 16 383 times.
constexpr std::uint64_t kTailIdentity = ~std::uint64_t{0} - kTailPaths;

// Share pi mu of the power of a bounce that Lambert's law scatters: the integral of mu sin(theta) over the
// hemisphere.
double scattered_by_bounce(double scattering_db) {
  return std::numbers::pi * to_power_ratio(Decibels{scattering_db}).value;
}

}  // namespace

void validate(const Reverberation& reverberation) {
  require_in_range(reverberation.bottom_scattering_db, -80, -5, "scattering strength of the bottom", "dB");
  require_in_range(reverberation.surface_scattering_db, -80, -5, "scattering strength of the surface", "dB");
  require_in_range(reverberation.bounce_loss_db, 0.01, 100, "loss of reverberation at a bounce", "dB");
}

// b = bounces per second times the loss in nepers, with c (2/3) sin(theta_c) / (2 D) bounces per second.
// q = 1 - (c_water / c_bottom)^2.
double trapped_share(const FluidBottom& bottom) {
  const double ratio =
      bottom.sound_speed_ratio > 0 ? bottom.sound_speed_ratio : bottom.sound_speed_mps / kSoundSpeedMps;
  return ratio > 1 ? 1 - 1 / (ratio * ratio) : 0;
}

double tail_decay_per_s(const Reverberation& reverberation, const Duct& duct) {
  // sin(theta_c) = sqrt(q); the mean sine of Lambert's angles below theta_c is 2/3 of it.
  const double bounces_per_s =
      kSoundSpeedMps * (2.0 / 3) * std::sqrt(duct.trapped_share) / (2 * duct.depth_m);
  return bounces_per_s * reverberation.bounce_loss_db * std::numbers::ln10 / 10;
}

bool is_reverberation(const Arrival& path) { return path.identity.number() >= kTailIdentity; }

std::vector<Arrival> with_reverberation(const Reverberation& reverberation, const Duct& duct,
                                        std::vector<Arrival> paths) {
  if (!reverberation.enabled || paths.empty() || !(duct.trapped_share > 0)) return paths;
  const double at_bottom = scattered_by_bounce(reverberation.bottom_scattering_db),
               at_surface = scattered_by_bounce(reverberation.surface_scattering_db);
  Arrival tail = paths.front();
  double fed = 0, spread_hz = 0;
  for (const Arrival& path : paths) {
    fed += to_power_ratio(path.level).value * duct.trapped_share *
           (path.bottom_bounces * at_bottom + path.surface_bounces * at_surface);
    spread_hz = std::max(spread_hz, path.fading.doppler_spread_hz);
    if (path.level > tail.level) tail = path;
  }
  if (!(fed > 0)) return paths;
  tail.diffuse = false;
  const double begin_s = tail.delay_s, x = tail_decay_per_s(reverberation, duct) * begin_s;
  const double step = elementary::acosh(1 + kMinDecay / x) / kTailPaths;
  tail.fading = {.scattered = 1, .doppler_spread_hz = spread_hz};
  for (std::size_t k = 0; k < kTailPaths; ++k) {
    // The power of a tail path, by the midpoint rule over equal steps of u, where t = t0 cosh u:
    //   R exp(-x (cosh u - 1)) du
    const double later = elementary::cosh((static_cast<double>(k) + 0.5) * step) - 1;
    tail.delay_s = begin_s * (1 + later);
    tail.level = to_decibels(PowerRatio{fed * elementary::exp(-x * later) * step});
    tail.identity = PathIdentity::of_number(kTailIdentity + k);
    paths.push_back(tail);
  }
  std::stable_sort(paths.begin(), paths.end(),
                   [](const Arrival& a, const Arrival& b) { return a.delay_s < b.delay_s; });
  return paths;
}

}  // namespace halocline::acoustics
