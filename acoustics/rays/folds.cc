#include "acoustics/rays/folds.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "core/check.h"

namespace halocline::acoustics {
namespace {

constexpr double kPeakPhase = 2.0 / 3 * 0.555 * 0.555 * 0.555 / 4;  // omega dt of Airy's greatest value
constexpr double kLeastTime = 1e-13;                                // s: rounding of a delay

double bound(double time_s, double frequency_hz) {
  const double phase = 2 * std::numbers::pi * frequency_hz * std::max(time_s, kLeastTime);
  return phase < kPeakPhase ? std::pow(phase / kPeakPhase, 1.0 / 6) : 1;
}

}  // namespace

void bound_folds(const std::vector<std::uint64_t>& families, double frequency_hz,
                 std::vector<Arrival>& paths) {
  ensure(families.size() == paths.size(), "a family for each path");
  std::vector<std::size_t> order(paths.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return families[a] != families[b] ? families[a] < families[b]
                                      : paths[a].launch_angle_rad < paths[b].launch_angle_rad;
  });
  double before = 1;  // of the fold with the ray before
  for (std::size_t i = 0; i < order.size(); ++i) {
    Arrival& path = paths[order[i]];
    double after = 1;
    if (i + 1 < order.size() && families[order[i + 1]] == families[order[i]]) {
      const Arrival& next = paths[order[i + 1]];
      if (std::abs(next.caustics - path.caustics) == 1)
        after = bound(std::abs(next.delay_s - path.delay_s), frequency_hz);
    }
    path.amplitude *= std::min(before, after);
    before = after;
  }
}

}  // namespace halocline::acoustics
