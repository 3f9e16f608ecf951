// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/prediction/gamma_power.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "acoustics/math/fast_functions.h"
#include "acoustics/math/functions.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

// Position of a coordinate in a uniform grid: the row below and the fraction of the way to the next.
struct Place {
  std::size_t row;
  double part;
};
Place place(double x, std::size_t rows) {
  const double within = std::clamp(x, 0.0, static_cast<double>(rows - 1));
  const auto row = std::min(static_cast<std::size_t>(within), rows - 2);
  return {row, within - static_cast<double>(row)};
}
double mix(double a, double b, double part) { return a + part * (b - a); }

constexpr double kMinZ = -4.5, kStepZ = 0.25, kMinSkewness = 0.1, kStepSkewness = 0.1;
constexpr std::size_t kZs = 37, kSkewnesses = 20;
constexpr double kLow = 0.3;  // share of the mean below which the gamma variable's constant may be too low

// Logarithms of the quantiles of gamma variables of mean 1, whose variance is skewness^2 / 4.
using QuantileTable = std::array<std::array<double, kZs>, kSkewnesses>;

const QuantileTable& quantiles() {
  static const QuantileTable table = [] {
    QuantileTable made{};
    for (std::size_t i = 0; i < kSkewnesses; ++i) {
      const double skewness = kMinSkewness + kStepSkewness * static_cast<double>(i);
      const double k = 4 / squared(skewness);
      for (std::size_t j = 0; j < kZs; ++j) {
        made[i][j] = elementary::log(gamma_quantile_at(k, kMinZ + kStepZ * static_cast<double>(j)) / k);
      }
    }
    return made;
  }();
  return table;
}

// Logarithms of the gamma quantiles of one skewness.
class LogQuantiles {
 public:
  explicit LogQuantiles(double skewness) {
    const Place i = place((skewness - kMinSkewness) / kStepSkewness, kSkewnesses);
    low_ = &quantiles()[i.row];
    high_ = &quantiles()[i.row + 1];
    part_ = i.part;
  }
  double at(double z) const {
    const Place j = place((z - kMinZ) / kStepZ, kZs);
    return mix(mix((*low_)[j.row], (*low_)[j.row + 1], j.part),
               mix((*high_)[j.row], (*high_)[j.row + 1], j.part), part_);
  }

 private:
  const QuantileTable::value_type *low_, *high_;
  double part_;
};

// Least quantiles of a positive power of mean 1: those of Rice's of the same variance v <= 1, of which the
// part t = 1 - sqrt(1 - v) is diffuse and K = (1 - t) / t, near 0:
//   probability p = e^-K (y + (K - 1) y^2 / 2 + ..), y = x / t.
// Above v = 1 a power may be lower than any of Rice's: the bound goes to 0 at v = 2.
class LeastQuantiles {
 public:
  explicit LeastQuantiles(double variance)
      : diffuse_(1 - std::sqrt(std::max(1 - variance, 0.0))),
        share_(std::clamp(2 - variance, 0.0, 1.0)),
        steady_((1 - diffuse_) / diffuse_) {}
  double at(double z) const {
    const double first = normal_probability(z) * fast_exp(std::min(steady_, kMaxSteady));
    return share_ * diffuse_ * first / (1 + (steady_ - 1) * first / 2);
  }

 private:
  static constexpr double kMaxSteady = 100;  // keeps the exponential finite
  double diffuse_, share_, steady_;
};

}  // namespace

double GammaPower::at(double z) const { return at(std::array{z})[0]; }

void GammaPower::replace(std::span<double> scores) const {
  if (!(variance > 1e-12 * mean * mean)) return std::fill(scores.begin(), scores.end(), mean);
  const double deviation = std::sqrt(variance);
  const double skewness = std::clamp(third / (variance * deviation), -2.0, 2.0);
  if (std::abs(skewness) < kMinSkewness) {
    // Cornish-Fisher expansion for small skewness.
    for (double& z : scores) z = mean + deviation * (z + skewness * (z * z - 1) / 6);
    return;
  }
  const double sign = skewness < 0 ? -1 : 1, unit = deviation * 2 / skewness;
  const LogQuantiles logs(sign * skewness);
  const LeastQuantiles least(variance / (mean * mean));
  for (double& z : scores) {
    const double power = mean + unit * (fast_exp(logs.at(sign * z)) - 1);
    z = skewness > 0 && power < kLow * mean ? std::max(power, mean * least.at(z)) : power;
  }
}

double third_share(double kept) { return kept > 0.5 ? (3 * kept - 1) / 2 : kept * kept; }

}  // namespace halocline::acoustics
