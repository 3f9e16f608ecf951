// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/reception/guard_window.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>

#include "acoustics/math/fast_functions.h"
#include "acoustics/modem/receiver_kind.h"
#include "acoustics/reception/signal_history.h"
#include "core/units.h"
#include "core/vector_clones.h"

namespace halocline::acoustics {
namespace {

// Difference of power below which fading makes one or the other of two windows the stronger.
constexpr double kEqualDb = 1;
// Weight of a window's strongest path in another window above which the receiver treats both as the same.
constexpr double kShared = 0.5;

// Raised cosine: 1 for x <= 0, 0 for x >= 1, (1 + cos(pi x)) / 2 between.
double raised_cosine(double x) {
  if (x <= 0) return 1;
  return x >= 1 ? 0 : (1 + fast_turn(std::numbers::pi * x).cosine) / 2;
}

// Weights of the paths in a modem's window.
class Guard {
 public:
  explicit Guard(const Modem& modem)
      : guard_s_(modem.window_s()),
        taper_s_(modem.window_taper_s()),
        longest_s_(modem.receiver == ReceiverKind::kStrongestPath
                       ? guard_s_ + taper_s_
                       : (modem.guard_time + modem.guard_taper_or_default()).seconds()) {}

  double weight(double after_begin_s) const {
    if (after_begin_s < 0) return 0;
    const double late_s = after_begin_s - guard_s_;
    if (late_s <= 0) return 1;
    return taper_s_ > 0 ? raised_cosine(late_s / taper_s_) : 0;
  }
  double longest_s() const { return longest_s_; }

 private:
  double guard_s_, taper_s_, longest_s_;
};

// An echo that falls on the tones of its own packet as the pattern returns, as white noise over the band: a
// share of its power.
double hop_overlap(const Modem& modem, double apart_s) {
  if (modem.hop_count == 0) return 1;
  const double back_s = apart_s - modem.hop_clearing.seconds(), chip_s = modem.chip.seconds();
  return (1 - raised_cosine(back_s / chip_s)) * modem.bandwidth_hz * chip_s / (2 * modem.hop_count);
}

// Distance of the two tones of a pair, in widths 1 / T of a tone: 2 N tones share the band, and tones of one
// chip do not disturb each other, so it is a whole number.
double tone_distance(const Modem& modem) {
  const double even = modem.bandwidth_hz * modem.chip.seconds() / (2 * modem.hop_count);
  return std::max(std::round(even), 1.0);
}

// Leakage of an echo's chip that ends within the chip that is listened to, into the other tone of its pair, n
// widths away: B T sin^2(pi n d / T) / (pi n)^2 of the echo's power.
double chip_leakage(const Modem& modem, double apart_s) {
  const double chip_s = modem.chip.seconds();
  if (modem.hop_count == 0 || !(apart_s < chip_s)) return 0;
  const double turn = std::numbers::pi * tone_distance(modem);
  const double part = fast_turn(turn * apart_s / chip_s).sine / turn;
  return modem.late_echo_share * modem.bandwidth_hz * chip_s * part * part;
}

// Disturbing share of a late echo's power: kappa (1 - eta rho) of what falls on the tones of its packet.
double disturbing_share(const Modem& modem, const Arrival& path, double apart_s) {
  const double followed = modem.echo_cancelled > 0 ? modem.echo_cancelled * tracked_share(modem, path) : 0;
  return modem.late_echo_share * (1 - followed) * hop_overlap(modem, apart_s);
}

HALOCLINE_VECTOR_CLONES
void replace_by_powers(std::span<double> levels_db) {
  for (double& value : levels_db) value = fast_power(value);
}

// Sum of w^2 P for the window that begins at each path. It is 0 for windows so much weaker than the best that
// likely_windows() ignores them, judged by the unweighted power of their paths.
std::vector<double> window_powers(const std::vector<Arrival>& paths, const std::vector<double>& powers,
                                  const Guard& guard) {
  const double counts = fast_power(-1.01 * kEqualDb);
  std::vector<double> sums(paths.size()), wholes(paths.size());  // wholes: unweighted sums
  double whole = 0;
  for (std::size_t first = 0, end = 0; first < paths.size(); ++first) {
    for (; end < paths.size() && !(paths[end].delay_s - paths[first].delay_s > guard.longest_s()); ++end) {
      whole += powers[end];
    }
    wholes[first] = whole;
    whole -= powers[first];
  }
  const auto sum_from = [&](std::size_t first) {
    double sum = 0;
    for (std::size_t i = first; i < paths.size(); ++i) {
      const double after_s = paths[i].delay_s - paths[first].delay_s;
      if (after_s > guard.longest_s()) break;
      const double w = guard.weight(after_s);
      sum += w * w * powers[i];
    }
    return sum;
  };
  const auto most = static_cast<std::size_t>(std::max_element(wholes.begin(), wholes.end()) - wholes.begin());
  sums[most] = sum_from(most);
  double best = sums[most];
  for (std::size_t first = 0; first < paths.size(); ++first) {
    if (first == most || wholes[first] < counts * best) continue;
    sums[first] = sum_from(first);
    best = std::max(best, sums[first]);
  }
  return sums;
}

// Powers that differ by less than this are equal: the delay windows of turned sound are cut into equal
// powers, and rounding must not choose between them.
constexpr double kEqualPowers = 1 - 1e-6;

// Index of the first of the greatest values, which are not all negative.
std::size_t first_greatest(const std::vector<double>& values) {
  const double least = kEqualPowers * *std::max_element(values.begin(), values.end());
  const auto first = std::find_if(values.begin(), values.end(), [&](double value) { return value >= least; });
  return static_cast<std::size_t>(first - values.begin());
}

GuardWindow window_from(std::size_t first, const std::vector<Arrival>& paths,
                        const std::vector<double>& powers, const Modem& modem, const Guard& guard) {
  GuardWindow window{.first = first, .strongest = first, .shares = {}};
  window.shares.reserve(paths.size());
  double strongest = 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const double after_s = paths[i].delay_s - paths[first].delay_s;
    const double w = i < first ? 0 : guard.weight(after_s);
    const double disturbs = w < 1 ? disturbing_share(modem, paths[i], std::abs(after_s)) : 0;
    window.shares.push_back({w, (1 - w * w) * (disturbs + chip_leakage(modem, std::abs(after_s)))});
    if (kEqualPowers * w * w * powers[i] > strongest) {
      strongest = w * w * powers[i];
      window.strongest = i;
    }
  }
  return window;
}

}  // namespace

std::vector<double> mean_powers(const std::vector<Arrival>& paths) {
  std::vector<double> powers;
  powers.reserve(paths.size());
  for (const Arrival& path : paths) powers.push_back(path.level.value);
  replace_by_powers(powers);
  return powers;
}

const std::vector<Arrival>& without_faint(const std::vector<Arrival>& paths, std::vector<Arrival>& heard) {
  constexpr Decibels kFaint{60};
  Decibels strongest = paths.front().level;
  for (const Arrival& path : paths) strongest = std::max(strongest, path.level);
  const auto is_heard = [&](const Arrival& path) { return !(path.level < strongest - kFaint); };
  if (std::all_of(paths.begin(), paths.end(), is_heard)) return paths;
  heard.reserve(paths.size());
  std::copy_if(paths.begin(), paths.end(), std::back_inserter(heard), is_heard);
  return heard;
}

GuardWindow best_window(const std::vector<Arrival>& paths, const Modem& modem) {
  if (paths.size() == 1) return {.first = 0, .strongest = 0, .shares = {{1, 0}}};
  const Guard guard(modem);
  const std::vector<double> powers = mean_powers(paths), sums = window_powers(paths, powers, guard);
  return window_from(first_greatest(sums), paths, powers, modem, guard);
}

std::vector<LikelyWindow> likely_windows(const std::vector<Arrival>& paths, const Modem& modem) {
  const Guard guard(modem);
  const std::vector<double> powers = mean_powers(paths), sums = window_powers(paths, powers, guard);
  const std::size_t best = first_greatest(sums);
  std::vector<LikelyWindow> windows{{window_from(best, paths, powers, modem, guard), 1}};
  const double strongest_s = paths[windows[0].window.strongest].delay_s;
  std::size_t other = best;
  for (std::size_t first = 0; first < paths.size(); ++first) {
    if (guard.weight(strongest_s - paths[first].delay_s) > kShared) continue;
    if (other == best || kEqualPowers * sums[first] > sums[other]) other = first;
  }
  if (other == best || !(sums[other] > 0)) return windows;
  const double close = 1 - to_decibels({sums[best] / sums[other]}).value / kEqualDb;
  if (!(close > 0)) return windows;
  windows.push_back({window_from(other, paths, powers, modem, guard), close * close / 2});
  windows[0].probability -= windows[1].probability;
  return windows;
}

double mean_signal(const std::vector<Arrival>& paths, const GuardWindow& window) {
  double sum = 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    sum += window.shares[i].weight * window.shares[i].weight * to_power_ratio(paths[i].level).value;
  }
  return sum;
}

}  // namespace halocline::acoustics
