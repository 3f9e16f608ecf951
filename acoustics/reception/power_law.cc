#include "acoustics/reception/power_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <boost/math/special_functions/gamma.hpp>

#include "acoustics/math/fast_functions.h"
#include "acoustics/math/functions.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

// A grid of one coordinate: where x lies, within it.
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

constexpr double kLeastZ = -4.5, kStepZ = 0.25, kLeastSkewness = 0.1, kStepSkewness = 0.1;
constexpr std::size_t kZs = 37, kSkewnesses = 20;

// ln of gamma_quantile.
using QuantileTable = std::array<std::array<double, kZs>, kSkewnesses>;

const QuantileTable& quantiles() {
  static const QuantileTable table = [] {
    QuantileTable made{};
    for (std::size_t i = 0; i < kSkewnesses; ++i) {
      const double skewness = kLeastSkewness + kStepSkewness * static_cast<double>(i);
      const double k = 4 / squared(skewness);
      for (std::size_t j = 0; j < kZs; ++j) {
        const double p = normal_probability(kLeastZ + kStepZ * static_cast<double>(j));
        made[i][j] = std::log(boost::math::gamma_p_inv(k, p) / k);
      }
    }
    return made;
  }();
  return table;
}

using Parts = std::array<double, kFadeScores>;  // their logarithms
constexpr std::array<double, 5> kPartsSkewness{0.1, 0.5, 1, 1.5, 2};
constexpr std::size_t kStretchRows = 4, kTurnRows = 12;
constexpr double kLeastTurns = 0.0005;

// -ln of the chance that the power stays above its value of score `z` (power_law.h).
double loss(double z, double skewness, double stretches, double turns) {
  const double k = 4 / squared(skewness), p = normal_probability(z), x = gamma_quantile(z, skewness);
  const double crossings =
      2 * std::sqrt(pi) * turns * std::exp((k - 0.5) * std::log(k * x) - k * x - std::lgamma(k));
  const double both = p * (1 - p), crossed = both * -std::expm1(-crossings / both);
  const double apart = 1 + 0.27 * std::exp(-squared(turns / 0.12));
  return -std::log1p(-p) - (stretches - 1) * apart * std::log1p(-crossed / (1 - p));
}

Parts log_parts(double skewness, double stretches, double turns) {
  Parts parts{};
  for (std::size_t i = 0; i < kFadeScores; ++i) {
    const double z = kLeastFadeScore + static_cast<double>(i);
    parts[i] = std::log(loss(z, skewness, stretches, turns) / -std::log1p(-normal_probability(z)));
  }
  return parts;
}

using PartsTable = std::array<std::array<std::array<Parts, kTurnRows>, kStretchRows>, 5>;

const PartsTable& parts_table() {
  static const PartsTable table = [] {
    PartsTable made{};
    for (std::size_t i = 0; i < kPartsSkewness.size(); ++i) {
      for (std::size_t j = 0; j < kStretchRows; ++j) {
        for (std::size_t k = 0; k < kTurnRows; ++k) {
          made[i][j][k] = log_parts(kPartsSkewness[i], 8 * std::exp2(static_cast<double>(j)),
                                    kLeastTurns * std::exp2(static_cast<double>(k)));
        }
      }
    }
    return made;
  }();
  return table;
}

}  // namespace

double gamma_quantile(double z, double skewness) {
  const Place i = place((skewness - kLeastSkewness) / kStepSkewness, kSkewnesses),
              j = place((z - kLeastZ) / kStepZ, kZs);
  const auto &low = quantiles()[i.row], &high = quantiles()[i.row + 1];
  return fast_exp(
      mix(mix(low[j.row], low[j.row + 1], j.part), mix(high[j.row], high[j.row + 1], j.part), i.part));
}

double PowerLaw::at(double z) const {
  if (!(variance > 1e-12 * mean * mean)) return mean;
  const double deviation = std::sqrt(variance);
  const double skewness = std::clamp(third / (variance * deviation), -2.0, 2.0);
  if (std::abs(skewness) < kLeastSkewness) return mean + deviation * (z + skewness * (z * z - 1) / 6);
  if (skewness < 0) return mean - deviation * 2 / -skewness * (gamma_quantile(-z, -skewness) - 1);
  return mean + deviation * 2 / skewness * (gamma_quantile(z, skewness) - 1);
}

Parts independent_parts(double skewness, double stretches, double turns) {
  const auto above = std::upper_bound(kPartsSkewness.begin() + 1, kPartsSkewness.end() - 1, skewness);
  const auto row = static_cast<std::size_t>(above - kPartsSkewness.begin()) - 1;
  const double part = std::clamp(
      (skewness - kPartsSkewness[row]) / (kPartsSkewness[row + 1] - kPartsSkewness[row]), 0.0, 1.0);
  const Place j = place(std::log2(stretches / 8), kStretchRows),
              k = place(std::log2(std::max(turns, kLeastTurns) / kLeastTurns), kTurnRows);
  Parts parts{};
  for (std::size_t m = 0; m < kFadeScores; ++m) {
    const auto at = [&](std::size_t i) {
      const auto& table = parts_table()[i];
      return mix(mix(table[j.row][k.row][m], table[j.row][k.row + 1][m], k.part),
                 mix(table[j.row + 1][k.row][m], table[j.row + 1][k.row + 1][m], k.part), j.part);
    };
    parts[m] = fast_exp(mix(at(row), at(row + 1), part));
  }
  return parts;
}

}  // namespace halocline::acoustics
