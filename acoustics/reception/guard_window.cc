#include "acoustics/reception/guard_window.h"

#include <cmath>
#include <numbers>

#include "core/units.h"

namespace halocline::acoustics {
namespace {

// 1 before 0, 0 after 1, half a cosine between.
double raised_cosine(double x) {
  if (x <= 0) return 1;
  return x >= 1 ? 0 : (1 + std::cos(std::numbers::pi * x)) / 2;
}

double weight(const Modem& modem, double after_begin_s) {
  if (after_begin_s < 0) return 0;
  const double late_s = after_begin_s - modem.guard_time.seconds();
  if (late_s <= 0) return 1;
  const double taper_s = modem.guard_taper_or_default().seconds();
  return taper_s > 0 ? raised_cosine(late_s / taper_s) : 0;
}

// Share of the power of an echo that meets the tones of its own packet.
double hop_overlap(const Modem& modem, double apart_s) {
  if (modem.hop_count == 0) return 1;
  const double back_s = apart_s - modem.hop_clearing.seconds();
  return (1 - raised_cosine(back_s / modem.chip.seconds())) / modem.hop_count;
}

std::vector<double> powers_of(const std::vector<SoundPath>& paths) {
  std::vector<double> powers;
  powers.reserve(paths.size());
  for (const SoundPath& path : paths) powers.push_back(to_power_ratio(path.level).value);
  return powers;
}

}  // namespace

GuardWindow best_window(const std::vector<SoundPath>& paths, const Modem& modem) {
  const std::vector<double> powers = powers_of(paths);
  const double longest_s = (modem.guard_time + modem.guard_taper_or_default()).seconds();
  GuardWindow window;
  double most = -1;
  for (std::size_t first = 0; first < paths.size(); ++first) {
    double sum = 0;
    for (std::size_t i = first; i < paths.size(); ++i) {
      const double after_s = paths[i].delay_s - paths[first].delay_s;
      if (after_s > longest_s) break;
      const double w = weight(modem, after_s);
      sum += w * w * powers[i];
    }
    if (sum > most) {
      most = sum;
      window.first = first;
    }
  }
  window.strongest = window.first;
  double strongest = 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const double after_s = paths[i].delay_s - paths[window.first].delay_s;
    const double w = i < window.first ? 0 : weight(modem, after_s);
    window.weights.push_back(w);
    window.interference.push_back((1 - w * w) * (w < 1 ? hop_overlap(modem, std::abs(after_s)) : 0));
    if (w * w * powers[i] > strongest) {
      strongest = w * w * powers[i];
      window.strongest = i;
    }
  }
  return window;
}

double mean_signal(const std::vector<SoundPath>& paths, const GuardWindow& window) {
  double sum = 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    sum += window.weights[i] * window.weights[i] * to_power_ratio(paths[i].level).value;
  }
  return sum;
}

double mean_interference(const std::vector<SoundPath>& paths, const GuardWindow& window) {
  double sum = 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    sum += window.interference[i] * to_power_ratio(paths[i].level).value;
  }
  return sum;
}

}  // namespace halocline::acoustics
