// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/prediction/reception_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "acoustics/fading/path_fading.h"
#include "acoustics/math/delay_profile.h"
#include "acoustics/math/fast_functions.h"
#include "acoustics/math/functions.h"
#include "acoustics/prediction/equalizer_statistics.h"
#include "acoustics/prediction/steady_band.h"
#include "acoustics/reception/guard_window.h"
#include "core/elementary.h"
#include "core/units.h"
#include "core/vector_clones.h"

namespace halocline::acoustics {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

constexpr std::size_t kFrequencies = kSignalFrequencies;
constexpr double kNegligible = 1e-12;  // share of the power that has no effect
constexpr double kIncoherent = 1e-5;   // relative to the power of the strongest path

// Complex product without the standard library's tests for infinities.
Complex product(Complex a, Complex b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}
double real_product(Complex a, Complex b) {
  return a.real() * b.real() + a.imag() * b.imag();
}  // real part of a b*

// Adds a path's power times exp(-j 2 pi k spacing delay) for each lag k.
void add_to(BandCorrelation& correlation, double power, const BandTurns& turns) {
  for (std::size_t k = 0; k < kFrequencies; ++k) {
    correlation[k] += Complex(power * turns.re[k], power * turns.im[k]);
  }
}

// Mean of a b* over all pairs of frequencies, by their lag.
double mean_correlation(const BandCorrelation& a, const BandCorrelation& b) {
  double sum = 0;
  for (std::size_t k = 0; k < kFrequencies; ++k) {
    sum += (k == 0 ? 1.0 : 2.0) * static_cast<double>(kFrequencies - k) * real_product(a[k], b[k]);
  }
  return sum / (kFrequencies * kFrequencies);
}

// Product K a of the covariance matrix K_mn = E B_m B_n* with a vector.
BandPressures times(const BandCorrelation& correlation, const BandPressures& a) {
  BandPressures sums{};
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    for (std::size_t n = 0; n < kFrequencies; ++n) {
      sums[m] += product(n > m ? std::conj(correlation[n - m]) : correlation[m - n], a[n]);
    }
  }
  return sums;
}

// Quadratic mean a^H b / 8^2.
double mean_product(const BandPressures& a, const BandPressures& b) {
  double sum = 0;
  for (std::size_t m = 0; m < kFrequencies; ++m) sum += real_product(a[m], b[m]);
  return sum / (kFrequencies * kFrequencies);
}

// Sums over the paths for frequency-shift keying.
class BandSums {
 public:
  BandSums(const Modem& receiver, const Band& band, double strongest, std::size_t paths)
      : band_(band),
        spacing_hz_(band.width_hz() / kFrequencies),
        strongest_(strongest),
        steady_(receiver, band, paths) {}

  void add(const Arrival& path, double power, double turned_share, double fast, double excess_s) {
    const BandTurns turns = band_turns(-spacing_hz_ * excess_s);
    // Paths with little coherent power count it as turned by the medium.
    const bool steadily = power * path.fading.coherent > kIncoherent * strongest_;
    if (steadily) {
      const double coherent = std::sqrt(power * path.fading.coherent);
      const double at_low = path.phase_rad - 2 * pi * turned(band_.low_hz * excess_s, 1);
      const Complex pressure = steady_.add({coherent, at_low, excess_s, fast_turn(path.launch_angle_rad).sine,
                                            fast_turn(path.arrival_angle_rad).sine},
                                           turns);
      for (std::size_t m = 0; m < kFrequencies; ++m) {
        pressures_[m] += product(pressure, {turns.re[m], turns.im[m]});
      }
    }
    add_to(medium_, power * (turned_share + (steadily ? 0 : path.fading.coherent)), turns);
    add_to(scattered_, power * fast, turns);
    // sinc(spacing delay)^2 from the phase change x = pi spacing delay over half a part:
    //   1 - cos(2 x) = 2 sin(x)^2.
    const double x = pi * spacing_hz_ * excess_s;
    add_to(cross_scattered_, power * fast * (std::abs(x) < 1e-4 ? 1 : (1 - turns.re[1]) / (2 * x * x)),
           turns);
  }

  void finish(ReceptionStatistics& sound) {
    const SteadyBand::JitterEffect jitter = steady_.jitter();
    const auto parts = steady_.parts(jitter);
    double coherent = 0;
    for (std::size_t m = 0; m < kFrequencies; ++m) {
      const double middle = elementary::hypot(pressures_[m].real(), pressures_[m].imag());
      pressures_[m] *= middle > 0 ? std::sqrt(parts[m].constant) / middle : 0;
      sound.varying[m] = parts[m].varying;
      coherent += (std::norm(pressures_[m]) + parts[m].varying) / kFrequencies;
    }
    sound.steady = pressures_;
    sound.medium = medium_;
    sound.fast = scattered_[0].real();
    const double others = coherent + medium_[0].real(), mean = others + sound.fast;
    if (mean > 0) sound.jitter_variance = jitter.variance / squared(mean);
    sound.block_fading = block_power(coherent);
    sound.own = mean_correlation(scattered_, scattered_);
    if (others > 0 && sound.fast > 0) {
      sound.cross_terms = 2 *
                          (mean_product(pressures_, times(cross_scattered_, pressures_)) +
                           mean_correlation(scattered_, medium_)) /
                          others;
    }
  }

 private:
  GammaPower block_power(double coherent) const {
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
  BandCorrelation medium_{}, scattered_{}, cross_scattered_{};
};

// Fading quantities of all paths that are slow to compute one by one, evaluated together.
struct PathRates {
  std::vector<double> rates;        // 1 / L of the power (reception_statistics.h), 1/s
  std::vector<double> block_share;  // share of the scattered power that is constant through the bits
  std::vector<double> preamble_reduction, bits_reduction;
};
HALOCLINE_VECTOR_CLONES
void compute(double preamble_s, double bits_s, PathRates& paths) {
  const std::size_t count = paths.rates.size();
  const double* rates = paths.rates.data();
  double *block_share = paths.block_share.data(), *preambles = paths.preamble_reduction.data(),
         *bits = paths.bits_reduction.data();
  for (std::size_t p = 0; p < count; ++p) {
    block_share[p] = 1 / (1 + squared(rates[p] * bits_s));
    preambles[p] = variance_reduction(rates[p] * preamble_s);
    bits[p] = variance_reduction(rates[p] * bits_s);
  }
}
PathRates rates_of(const std::vector<Arrival>& paths, double preamble_s, double bits_s) {
  const std::size_t count = paths.size();
  PathRates made;
  made.rates.reserve(count);
  for (const Arrival& path : paths) made.rates.push_back(2 * pi * path.fading.doppler_spread_hz);
  made.block_share.resize(count);
  made.preamble_reduction.resize(count);
  made.bits_reduction.resize(count);
  compute(preamble_s, bits_s, made);
  return made;
}

// Share of the interval from `from_s` to `to_s` that lies within `begin_s`..`end_s`, 0..1.
double share_within(double begin_s, double end_s, double from_s, double to_s) {
  return to_s > from_s
             ? std::clamp((std::min(end_s, to_s) - std::max(begin_s, from_s)) / (to_s - from_s), 0.0, 1.0)
             : 0;
}

// Share of the bits during which late echoes are present, weighted by their power.
double late_share(const std::vector<Arrival>& paths, const std::vector<double>& powers,
                  const GuardWindow& window, double preamble_s, double end_s) {
  double all = 0, shared = 0;
  for (std::size_t p = 0; p < paths.size(); ++p) {
    if (!(window.shares[p].interference > 0)) continue;
    const double begin_s = paths[p].delay_s - paths[window.first].delay_s,
                 share = share_within(begin_s, begin_s + end_s, preamble_s, end_s),
                 power = window.shares[p].interference * powers[p] * share;
    all += power;
    shared += share * power;
  }
  return all > 0 ? shared / all : 1;
}

}  // namespace

// kept(x) = 1 / sqrt(1 + x^2 / pi) at x / sqrt(2), and at `part` of x.
double reduction_of_longer(double kept) { return kept / std::sqrt(kept * kept + (1 - kept * kept) / 2); }
double reduction_of_part(double kept, double part) {
  return kept / std::sqrt(kept * kept + part * part * (1 - kept * kept));
}

ReceptionStatistics reception_statistics(const std::vector<Arrival>& paths, const Synchronisation& sync,
                                         const Band& band, const PacketTiming& timing) {
  const Arrival &first = paths[sync.window.first], &strongest = paths[sync.window.strongest];
  const bool collects = !is_frequency_shift_keying(sync.modem->error_model);
  const double kept = doppler_share(*sync.modem, strongest, band.centre_hz());
  const double per_channel = 1.0 / sync.modem->receiver_channels;
  const double preamble_s = timing.preamble.seconds(), end_s = timing.duration.seconds(),
               bits_s = end_s - preamble_s;
  const std::vector<double> powers = mean_powers(paths);
  const PathRates rates = rates_of(paths, preamble_s, bits_s);
  ReceptionStatistics sound;
  if (collects) sound.late_share = late_share(paths, powers, sync.window, preamble_s, end_s);
  std::optional<BandSums> sums;
  if (!collects) sums.emplace(*sync.modem, band, powers[sync.window.strongest], paths.size());
  std::vector<EqualizerPath> equalizer_paths;
  if (collects) equalizer_paths.reserve(paths.size());
  double signal = 0, untracked = 0, spread = 0, all = 0, all_spread = 0, preamble_root = 0, bits_root = 0;
  for (std::size_t p = 0; p < paths.size(); ++p) {
    const Arrival& path = paths[p];
    const PathFading& fading = path.fading;
    const double power = powers[p], begin_s = path.delay_s - first.delay_s;
    const double preamble_reduction = rates.preamble_reduction[p], bits_reduction = rates.bits_reduction[p];
    // Scattering so slow that it stays constant through a packet fades as the medium does.
    const double block_share = rates.block_share[p];
    const double fast = fading.scattered * (1 - block_share),
                 turned_share = fading.medium + fading.scattered * block_share,
                 within = squared(sync.window.shares[p].weight) * power;
    const double of_path = within * kept * tracked_share(*sync.modem, path),
                 rest = per_channel * (within - of_path);
    double interference = rest;
    if (const double late = per_channel * sync.window.shares[p].interference * power; late > 0) {
      const double of_bits = late * share_within(begin_s, begin_s + end_s, preamble_s, end_s);
      const double of_preamble = late * share_within(begin_s, begin_s + end_s, 0, preamble_s);
      const double fades = 1 - squared(fading.coherent);
      sound.preamble_echoes += of_preamble;
      const double sounding =
          collects && sound.late_share > 0 ? std::min(of_bits / sound.late_share, late) : of_bits;
      sound.bits_echoes += of_bits;
      sound.late_echoes += sounding;
      sound.fading_echoes += sounding * (collects ? 1 - fast : 1);
      sound.preamble_echo_variance += squared(of_preamble) * fades * preamble_reduction;
      // Phase-shift keying: echoes that fade within a packet are part of the fast fading of the signal.
      sound.bits_echo_variance +=
          squared(sounding) *
          (collects ? turned_share * (turned_share + 2 * fading.coherent) : fades * bits_reduction);
      interference += sounding;
    }
    const double excess_s = path.delay_s - strongest.delay_s;
    if (collects) {
      equalizer_paths.push_back(
          {.signal = of_path,
           .interference = interference,
           .steady = fading.coherent,
           .turned = turned_share,
           .scattered = fast,
           .medium = fading.medium,
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
    if (!collects) sums->add(path, of_path, turned_share, fast, excess_s);
    const double scattered = of_path * fast;
    spread += scattered * squared(fading.doppler_spread_hz);
    preamble_root += scattered * std::sqrt(preamble_reduction);
    bits_root += scattered * std::sqrt(bits_reduction);
  }
  if (collects) {
    sound.equalizer = equalizer_statistics(equalizer_paths, band);
    sound.block_fading = sound.equalizer.block_fading;
    sound.fast = sound.equalizer.fast;
    sound.own = sound.equalizer.own;
    sound.cross_terms = sound.equalizer.cross_terms;
  } else {
    sums->finish(sound);
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

GammaPower ReceptionStatistics::power(double block_power, double kept) const {
  if (!(fast > kNegligible * block_power)) return {block_power + fast};
  const double mixed = cross_terms * block_power;
  const double over_band = own / squared(fast), longer = reduction_of_longer(kept);
  return {block_power + fast, kept * own + longer * mixed,
          fast * third_share(over_band) *
              (2 * fast * fast * third_share(kept) + 3 * mixed / over_band * third_share(longer))};
}

double sinr_of(const ReceptionStatistics& sound, double noise) {
  const double signal = sound.block_fading.mean + sound.fast;
  return signal / (noise + sound.bits_echoes + sound.untracked * signal);
}

DisturbingPowers disturbances_of(const ReceptionStatistics& sound, double noise) {
  const double signal = sound.block_fading.mean + sound.fast;
  if (!(signal > 0)) return {};
  return {.noise = noise / signal, .late_echoes = sound.bits_echoes / signal, .fast_fading = sound.untracked};
}

double rms_delay_spread_s(const std::vector<Arrival>& paths) {
  std::vector<WeightedDelay> delays;
  delays.reserve(paths.size());
  for (const Arrival& path : paths) delays.push_back({path.delay_s, fast_power(path.level.value)});
  return delay_moments(delays).spread_s;
}

}  // namespace halocline::acoustics
