// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/bubble_layer.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "core/units.h"

namespace halocline::acoustics {

BubbleLayer bubble_layer(double wind_mps, double frequency_hz) {
  constexpr double kJoin = 6;  // m/s
  if (!(wind_mps > 0)) return {};
  const double steady = 0.63e-3 * elementary::pow(std::max(wind_mps, kJoin), 1.57) *
                        elementary::pow(hz_to_khz(frequency_hz), 0.85);
  const double weaker = wind_mps < kJoin ? elementary::exp(1.2 * (wind_mps - kJoin)) : 1;
  return {steady * weaker, 0.4 + 0.115 * std::max(wind_mps - 7.5, 0.0)};
}

double BubbleLayer::db_per_m(double depth_m) const {
  return one_way_db / e_folding_m * elementary::exp(-depth_m / e_folding_m);
}

double BubbleLayer::straight_loss_db(double from_m, double to_m, double length_m) const {
  const double thickness = std::abs(to_m - from_m) / e_folding_m;
  // exp(-z1/L) - exp(-z2/L) = exp(-z1/L) (1 - exp(-h)), with (1 - exp(-h)) / h -> 1 for a level path.
  const double mean = thickness > 1e-8 ? -elementary::expm1(-thickness) / thickness : 1;
  return db_per_m(std::min(from_m, to_m)) * mean * length_m;
}

}  // namespace halocline::acoustics
