#include "acoustics/reception/mean_sound.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "acoustics/fading/path_fading.h"
#include "acoustics/math/fast_functions.h"
#include "acoustics/math/functions.h"
#include "acoustics/reception/collected_sound.h"
#include "acoustics/reception/guard_window.h"
#include "acoustics/reception/steady_band.h"
#include "core/elementary.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

constexpr std::size_t kFrequencies = kSignalFrequencies;
constexpr double kNegligible = 1e-12;  // of the power: of no effect
constexpr double kIncoherent = 1e-5;   // of the power of the strongest path

// Without the library's look for infinities.
Complex product(Complex a, Complex b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}
double real_product(Complex a, Complex b) { return a.real() * b.real() + a.imag() * b.imag(); }  // of a b*

void add_to(BandCorrelation& correlation, double power, Complex turn) {
  Complex term = power;
  for (Complex& value : correlation) {
    value += term;
    term = product(term, turn);
  }
}

// Mean over all pairs of frequencies of a b*.
double mean_correlation(const BandCorrelation& a, const BandCorrelation& b) {
  double sum = 0;
  for (std::size_t k = 0; k < kFrequencies; ++k) {
    sum += (k == 0 ? 1.0 : 2.0) * static_cast<double>(kFrequencies - k) * real_product(a[k], b[k]);
  }
  return sum / (kFrequencies * kFrequencies);
}

// K a, K_mn = E B_m B_n*.
BandPressures times(const BandCorrelation& correlation, const BandPressures& a) {
  BandPressures sums{};
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    for (std::size_t n = 0; n < kFrequencies; ++n) {
      sums[m] += product(n > m ? std::conj(correlation[n - m]) : correlation[m - n], a[n]);
    }
  }
  return sums;
}

// a^H b / 8^2.
double mean_product(const BandPressures& a, const BandPressures& b) {
  double sum = 0;
  for (std::size_t m = 0; m < kFrequencies; ++m) sum += real_product(a[m], b[m]);
  return sum / (kFrequencies * kFrequencies);
}

// Sums over the paths of frequency-shift keying.
class BandSums {
 public:
  BandSums(const Modem& receiver, const Band& band, double strongest)
      : band_(band),
        spacing_hz_(band.width_hz() / kFrequencies),
        strongest_(strongest),
        steady_(receiver, band) {}

  void add(const SoundPath& path, double power, double turned_share, double fast, double excess_s) {
    const Complex turn = elementary::polar(1.0, -2 * pi * turned(spacing_hz_ * excess_s, 1));
    // What is hardly coherent turns as the medium does.
    const bool steadily = power * path.fading.coherent > kIncoherent * strongest_;
    if (steadily) {
      const double coherent = std::sqrt(power * path.fading.coherent);
      const double at_low = path.phase_rad - 2 * pi * turned(band_.low_hz * excess_s, 1);
      steady_.add({coherent, at_low, excess_s, elementary::sin(path.launch_angle_rad),
                   elementary::sin(path.arrival_angle_rad)});
      Complex pressure = elementary::polar(coherent, at_low - pi * turned(spacing_hz_ * excess_s, 2));
      for (Complex& sum : pressures_) {
        sum += pressure;
        pressure = product(pressure, turn);
      }
    }
    add_to(medium_, power * (turned_share + (steadily ? 0 : path.fading.coherent)), turn);
    add_to(scattered_, power * fast, turn);
    add_to(beating_, power * fast * squared(sinc(spacing_hz_ * excess_s)), turn);
  }

  void finish(MeanSound& sound) {
    const SteadyBand::Sway sway = steady_.sway();
    const auto parts = steady_.parts(sway);
    double coherent = 0;
    for (std::size_t m = 0; m < kFrequencies; ++m) {
      const double middle = std::abs(pressures_[m]);
      pressures_[m] *= middle > 0 ? std::sqrt(parts[m].constant) / middle : 0;
      sound.varying[m] = parts[m].varying;
      coherent += (std::norm(pressures_[m]) + parts[m].varying) / kFrequencies;
    }
    sound.steady = pressures_;
    sound.medium = medium_;
    sound.fast = scattered_[0].real();
    const double others = coherent + medium_[0].real(), mean = others + sound.fast;
    if (mean > 0) sound.sway_variance = sway.variance / squared(mean);
    sound.slow = slow_power(coherent);
    sound.own = mean_correlation(scattered_, scattered_);
    if (others > 0 && sound.fast > 0) {
      sound.beats =
          2 *
          (mean_product(pressures_, times(beating_, pressures_)) + mean_correlation(scattered_, medium_)) /
          others;
    }
  }

 private:
  PowerLaw slow_power(double coherent) const {
    const double medium = medium_[0].real();
    if (!(medium > kNegligible * coherent)) return {coherent + medium};
    const double own = mean_correlation(medium_, medium_),
                 mixed = 2 * mean_product(pressures_, times(medium_, pressures_));
    const double kept = own / squared(medium), share = third_share(kept);
    return {coherent + medium, own + mixed, medium * share * (2 * medium * medium + 3 * mixed / kept)};
  }

  Band band_;
  double spacing_hz_, strongest_;
  SteadyBand steady_;
  BandPressures pressures_{};
  BandCorrelation medium_{}, scattered_{}, beating_{};
};

double share_within(double begin_s, double end_s, double from_s, double to_s) {
  return to_s > from_s
             ? std::clamp((std::min(end_s, to_s) - std::max(begin_s, from_s)) / (to_s - from_s), 0.0, 1.0)
             : 0;
}

// Of the bits, by the power that sounds in them.
double late_share(const std::vector<SoundPath>& paths, const GuardWindow& window, double preamble_s,
                  double end_s) {
  double all = 0, shared = 0;
  for (std::size_t p = 0; p < paths.size(); ++p) {
    if (!(window.interference[p] > 0)) continue;
    const double begin_s = paths[p].delay_s - paths[window.first].delay_s,
                 share = share_within(begin_s, begin_s + end_s, preamble_s, end_s),
                 power = window.interference[p] * fast_power(paths[p].level.value) * share;
    all += power;
    shared += share * power;
  }
  return all > 0 ? shared / all : 1;
}

}  // namespace

double kept_variance(double x) { return 1 / std::sqrt(1 + x * x / pi); }

double kept_of_longer(double kept) { return kept / std::sqrt(kept * kept + (1 - kept * kept) / 2); }
double kept_of_part(double kept, double part) {
  return kept / std::sqrt(kept * kept + part * part * (1 - kept * kept));
}

MeanSound mean_sound(const std::vector<SoundPath>& paths, const Lock& lock, const Band& band,
                     const PacketTiming& timing) {
  const SoundPath &first = paths[lock.window.first], &strongest = paths[lock.window.strongest];
  const bool collects = !is_frequency_shift_keying(lock.modem->error_model);
  const double kept = doppler_share(*lock.modem, strongest, band.centre_hz());
  const double preamble_s = timing.preamble.seconds(), end_s = timing.duration.seconds(),
               bits_s = end_s - preamble_s;
  MeanSound sound;
  if (collects) sound.late_share = late_share(paths, lock.window, preamble_s, end_s);
  BandSums sums(*lock.modem, band, fast_power(strongest.level.value));
  std::vector<CollectedPath> collected;
  if (collects) collected.reserve(paths.size());
  double signal = 0, untracked = 0, spread = 0, all = 0, all_spread = 0, preamble_root = 0, bits_root = 0;
  for (std::size_t p = 0; p < paths.size(); ++p) {
    const SoundPath& path = paths[p];
    const PathFading& fading = path.fading;
    const double power = fast_power(path.level.value), begin_s = path.delay_s - first.delay_s;
    const double rate = 2 * pi * fading.doppler_spread_hz;  // 1 / L of its power
    // What is scattered so slowly that it holds through a packet fades as the medium does.
    const double holds = 1 / (1 + squared(rate * bits_s));
    const double fast = fading.scattered * (1 - holds),
                 turned_share = fading.medium + fading.scattered * holds,
                 within = squared(lock.window.weights[p]) * power;
    const double of_path = within * kept * tracked_share(*lock.modem, path), rest = within - of_path;
    double interference = rest;
    if (const double late = lock.window.interference[p] * power; late > 0) {
      const double of_bits = late * share_within(begin_s, begin_s + end_s, preamble_s, end_s);
      const double of_preamble = late * share_within(begin_s, begin_s + end_s, 0, preamble_s);
      const double fades = 1 - squared(fading.coherent);
      sound.preamble_echoes += of_preamble;
      const double sounding =
          collects && sound.late_share > 0 ? std::min(of_bits / sound.late_share, late) : of_bits;
      sound.bits_echoes += of_bits;
      sound.late_echoes += sounding;
      sound.fading_echoes += sounding * (collects ? 1 - fast : 1);
      sound.preamble_echo_variance += squared(of_preamble) * fades * kept_variance(rate * preamble_s);
      // What fades within a packet does so with the signal of phase-shift keying.
      sound.bits_echo_variance +=
          squared(sounding) * (collects ? turned_share * (turned_share + 2 * fading.coherent)
                                        : fades * kept_variance(rate * bits_s));
      interference += sounding;
    }
    const double excess_s = path.delay_s - strongest.delay_s;
    if (collects) {
      collected.push_back({.signal = of_path,
                           .interference = interference,
                           .steady = fading.coherent,
                           .turned = turned_share,
                           .scattered = fast,
                           .delay_s = excess_s,
                           .phase_rad = path.phase_rad - 2 * pi * turned(band.centre_hz() * excess_s, 1),
                           .launch_angle_rad = path.launch_angle_rad,
                           .arrival_angle_rad = path.arrival_angle_rad,
                           .spread_hz = fading.doppler_spread_hz});
    }
    if (!(within > 0)) continue;
    signal += of_path;
    untracked += rest;
    all += within;
    all_spread += within * squared(fading.doppler_spread_hz);
    if (!collects) sums.add(path, of_path, turned_share, fast, excess_s);
    const double scattered = of_path * fast;
    spread += scattered * squared(fading.doppler_spread_hz);
    preamble_root += scattered * std::sqrt(kept_variance(rate * preamble_s));
    bits_root += scattered * std::sqrt(kept_variance(rate * bits_s));
  }
  if (collects) {
    sound.collected = collected_sound(collected, band);
    sound.slow = sound.collected.slow;
    sound.fast = sound.collected.fast;
    sound.own = sound.collected.own;
    sound.beats = sound.collected.beats;
  } else {
    sums.finish(sound);
  }
  if (untracked > kNegligible * signal) sound.untracked = untracked / signal;
  sound.window_spread_hz = all > 0 ? std::sqrt(all_spread / all) : 0;
  if (sound.fast > kNegligible * signal) {
    sound.spread_hz = std::sqrt(spread / sound.fast);
    sound.preamble_variance = squared(preamble_root / sound.fast);
    sound.bits_variance = squared(bits_root / sound.fast);
  }
  if (sound.preamble_echoes > 0) sound.preamble_echo_variance /= squared(sound.preamble_echoes);
  if (sound.fading_echoes > 0) sound.bits_echo_variance /= squared(sound.fading_echoes);
  return sound;
}

PowerLaw MeanSound::power(double slow_power, double kept) const {
  if (!(fast > kNegligible * slow_power)) return {slow_power + fast};
  const double mixed = beats * slow_power;
  const double over_band = own / squared(fast), longer = kept_of_longer(kept);
  return {slow_power + fast, kept * own + longer * mixed,
          fast * third_share(over_band) *
              (2 * fast * fast * third_share(kept) + 3 * mixed / over_band * third_share(longer))};
}

void SlowSound::scale(double factor) {
  for (double& power : steady) power *= factor;
  for (double& power : varying) power *= factor;
  slow_power *= factor;
}

MediumStates::MediumStates(const MeanSound& sound) : sound_(sound) {
  // Cholesky's root. Few paths leave the correlation without full rank: pivots of rounding's size count as none.
  const auto& correlation = sound.medium;
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    for (std::size_t n = 0; n <= m; ++n) {
      Complex rest = correlation[m - n];
      for (std::size_t k = 0; k < n; ++k) rest -= product(rows_[m][k], std::conj(rows_[n][k]));
      const double pivot = rows_[n][n].real();
      if (n < m) {
        rows_[m][n] = pivot > 0 ? rest / pivot : 0;
      } else {
        rows_[m][m] = rest.real() > 1e-9 * correlation[0].real() ? std::sqrt(rest.real()) : 0;
      }
    }
  }
}

SlowSound MediumStates::state(const BandPressures& normals) const {
  SlowSound slow;
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    Complex pressure = sound_.steady[m];
    for (std::size_t k = 0; k <= m; ++k) pressure += product(rows_[m][k], normals[k]);
    slow.steady[m] = std::norm(pressure);
    slow.varying[m] = sound_.varying[m];
    slow.slow_power += (slow.steady[m] + slow.varying[m]) / kFrequencies;
  }
  return slow;
}

}  // namespace halocline::acoustics
