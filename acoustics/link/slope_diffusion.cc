// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/slope_diffusion.h"

#include <cstddef>

#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr int kSteps = 24;  // steps of range

// One row of the tridiagonal system, a g(i - 1) + b g(i) + c g(i + 1), reduced to g(i) = p(i) - q(i) g(i + 1)
// (Thomas's algorithm).
struct Row {
  double a = 0, scale = 1, q = 0;
};

std::vector<Row> reduced_rows(const std::vector<BottomRay>& rays, double width_rad, double strength) {
  std::vector<Row> rows(rays.size());
  double below = 0;  // sine at the lower edge of the angle
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double place = static_cast<double>(i) * width_rad;
    const double above = i + 1 < rays.size() ? elementary::sin(place + width_rad) : 0;
    const double rate = strength / (rays[i].cycle_m * elementary::sin(place + 0.5 * width_rad));
    const double a = -rate * below, c = -rate * above;
    rows[i].a = a;
    rows[i].scale = 1 / (1 - a - c - (i > 0 ? a * rows[i - 1].q : 0));
    rows[i].q = c * rows[i].scale;
    below = above;
  }
  return rows;
}

}  // namespace

// Implicit steps of range: losses of the step, then forward elimination and back substitution.
void diffuse_by_slopes(std::vector<BottomRay>& rays, double width_rad, double mean_square_slope,
                       double range_m) {
  const double step_m = range_m / kSteps;
  const std::vector<Row> rows =
      reduced_rows(rays, width_rad, 2 * mean_square_slope * step_m / (width_rad * width_rad));
  std::vector<double> kept;  // share of power that remains after a step
  for (const BottomRay& ray : rays) kept.push_back(elementary::exp(-ray.nepers_per_m * step_m));
  for (int step = 0; step < kSteps; ++step) {
    double before = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
      before = rays[i].power = (rays[i].power * kept[i] - rows[i].a * before) * rows[i].scale;
    double after = 0;
    for (std::size_t i = rays.size(); i-- > 0;) after = rays[i].power -= rows[i].q * after;
  }
}

}  // namespace halocline::acoustics
