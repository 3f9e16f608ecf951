// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/scattering/delay_windows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "acoustics/math/fast_functions.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kShortestLog = -13.8155105579643, kBinsPerFold = 16;  // from 1 us on
constexpr std::size_t kBins = 288;                                     // to 60 s
// Medians of eight parts of equal probability of a standard normal variable.
constexpr std::array<double, 8> kParts{-1.5341205443525463, -0.8871465590188759, -0.4887764111146696,
                                       -0.1573106846101707, 0.1573106846101707,  0.4887764111146696,
                                       0.8871465590188759,  1.5341205443525463};
// Logarithms of the probabilities of these medians.
constexpr std::array<double, 8> kLogShares{-2.772588722239781,  -1.6739764335716716, -1.1631508098056809,
                                           -0.8266785731844679, -0.5753641449035618, -0.3746934494414107,
                                           -0.2076393647782445, -0.06453852113757118};
constexpr double kWide = 0.5;    // v below which the cubes are beyond the power law
constexpr double kWidest = 100;  // v above which only the last part is late
// Shares of the power between which windows lie: finer at both ends, which decide how long echoes last.
constexpr std::array<double, kMaxDelayWindows + 1> kCuts{0,   0.01, 0.04, 0.1,  0.17, 0.24, 0.32, 0.4, 0.5,
                                                         0.6, 0.68, 0.76, 0.84, 0.91, 0.96, 0.99, 1};

// Place of a delay among the middles of the bins, from 0 to below the last one.
double place_of(double excess_s) {
  const double place = (fast_log(std::max(excess_s, 1e-12)) - kShortestLog) * kBinsPerFold - 0.5;
  return std::clamp(place, 0.0, kBins - 1.001);
}

// Quantiles of a gamma distribution of unit mean and relative variance v = 1 / shape, with unit mean:
//   x = (1 - v / 9 + z sqrt(v) / 3)^3
// Low quantiles of wide distributions are those of its power law instead, a lower bound at any probability p:
//   x = v (p Gamma(1 + 1 / v))^v
// Without it a part would fall by decades of delay at a small change of v.
std::array<double, 8> gamma_parts(double v) {
  std::array<double, 8> parts{};
  const double root = std::sqrt(v) / 3, base = 1 - v / 9, wide = std::min(v, kWidest);
  const double log_gamma = v > kWide ? elementary::lgamma(1 + 1 / wide) : 0;
  double sum = 0;
  for (std::size_t q = 0; q < parts.size(); ++q) {
    const double x = std::max(base + kParts[q] * root, 0.0);
    const double least = v > kWide ? wide * fast_exp(wide * (kLogShares[q] + log_gamma)) : 0;
    sum += parts[q] = std::max(x * x * x, least);
  }
  for (double& part : parts) part *= static_cast<double>(parts.size()) / sum;
  return parts;
}

}  // namespace

DelaySpectrum::DelaySpectrum(const TurnedSound& forward, const TurnedSound& backward) : bins_(kBins) {
  add(forward, true);
  add(backward, false);
}

void DelaySpectrum::add(const TurnedSound& sound, bool forward) {
  constexpr double kShare = 0.5 / static_cast<double>(kParts.size());  // of the mean of both directions
  for (const TurnedPart& part : sound.parts) {
    if (!(part.power > 0)) continue;
    const double mean = std::max(part.excess_s, 1e-9), power = kShare * part.power;
    power_ += 0.5 * part.power;
    for (const double place : gamma_parts(part.variance_s2 / (mean * mean))) {
      const double at = place_of(mean * place);
      const auto below = static_cast<std::size_t>(at);
      const double above = at - static_cast<double>(below);
      for (const auto& [bin, share] : {std::pair(below, 1 - above), {below + 1, above}}) {
        Bin& shared = bins_[bin];
        shared.power += share * power;
        shared.delay += share * power * mean * place;
        (forward ? shared.launch : shared.arrival) += share * power * part.sine_squares;
        (forward ? shared.launch_power : shared.arrival_power) += share * power;
      }
    }
  }
}

std::vector<DelayWindow> DelaySpectrum::windows() const {
  std::vector<DelayWindow> windows;
  if (!(power_ > 0)) return windows;
  Bin all;
  double sum = 0;
  std::size_t cut = 1;
  const auto add_share = [&](const Bin& bin, double share) {
    all.power += share * bin.power;
    all.delay += share * bin.delay;
    all.launch += share * bin.launch;
    all.launch_power += share * bin.launch_power;
    all.arrival += share * bin.arrival;
    all.arrival_power += share * bin.arrival_power;
  };
  const auto close = [&] {
    const auto rms = [](double squares, double power) { return power > 0 ? std::sqrt(squares / power) : 0; };
    const double launch = rms(all.launch, all.launch_power), arrival = rms(all.arrival, all.arrival_power);
    if (all.power > 0)
      windows.push_back({all.power, all.delay / all.power, all.launch_power > 0 ? launch : arrival,
                         all.arrival_power > 0 ? arrival : launch});
    all = {};
    ++cut;
  };
  for (const Bin& bin : bins_) {
    if (!(bin.power > 0)) continue;
    double left = bin.power;
    while (cut + 1 < kCuts.size() && sum + left > kCuts[cut] * power_) {
      const double part = std::max(kCuts[cut] * power_ - sum, 0.0);
      add_share(bin, part / bin.power);
      sum += part;
      left -= part;
      close();
    }
    add_share(bin, left / bin.power);
    sum += left;
  }
  close();
  return windows;
}

}  // namespace halocline::acoustics
