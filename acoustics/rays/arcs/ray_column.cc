// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/arcs/ray_column.h"

#include <cmath>

namespace halocline::acoustics {

RayColumn::RayColumn(const RayWater& water, double shallowest_m, double deepest_m)
    : water_(water), excursion_knot_(water.layer_at(shallowest_m)) {
  const std::size_t layers = water.layer_at(deepest_m) + 1;
  for (std::size_t i = 0; i <= layers; ++i) speed_.push_back(water.speeds_mps()[i]);
  for (std::size_t i = 0; i < layers; ++i) {
    weight_.push_back((water.depths_m()[i + 1] - water.depths_m()[i]) * (speed_[i] + speed_[i + 1]));
  }
  sine_.resize(layers + 1);
  range_.resize(layers);
  slope_.resize(layers);
}

void RayColumn::set(double xi) {
  xi_ = xi;
  const double *speed = speed_.data(), *weight = weight_.data();
  double *sine = sine_.data(), *range = range_.data(), *slope = slope_.data();
  const std::size_t layers = range_.size();
  for (std::size_t i = 0; i <= layers; ++i) {
    const double cosine = xi * speed[i], square = (1 - cosine) * (1 + cosine);
    sine[i] = std::sqrt(square > 0 ? square : 0.0);
  }
  // Closed forms of acoustics/math/arc_math.h, with K = h (c1 + c2):
  //   dr        = K xi / (s1 + s2)
  //   d(dr)/dxi = K / ((s1 + s2) s1 s2)
  // Layers in which the ray turns get meaningless values, which are never read.
  for (std::size_t i = 0; i < layers; ++i) {
    const double product = sine[i] * sine[i + 1];
    slope[i] = weight[i] / ((sine[i] + sine[i + 1]) * product);
    range[i] = slope[i] * product * xi;
  }
  sum_excursion();
}

void RayColumn::sum_excursion() {
  double range = 0, slope = 0;
  std::size_t knot = excursion_knot_;
  for (; knot > 0 && sine_[knot - 1] > 0; --knot) {
    range += range_[knot - 1];
    slope += slope_[knot - 1];
  }
  excursion_.turns = knot > 0;
  // The arc from the knot to the turning point:
  //   r = sin / (xi |g|),  dr/dxi = -1 / (|g| xi^2 sin)
  if (excursion_.turns) {
    const double g = std::abs(water_.gradients_per_s()[knot - 1]);
    range += sine_[knot] / (xi_ * g);
    slope -= 1 / (g * xi_ * xi_ * sine_[knot]);
  }
  excursion_.range_m = 2 * range;
  excursion_.range_slope = 2 * slope;
}

}  // namespace halocline::acoustics
