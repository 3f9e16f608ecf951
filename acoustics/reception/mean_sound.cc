#include "acoustics/reception/mean_sound.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acoustics/reception/steady_band.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

constexpr std::size_t kFrequencies = kSignalFrequencies;
constexpr double kNegligible = 1e-12;  // of the power: of no effect
constexpr double kIncoherent = 1e-6;   // of the power of a path

double squared(double x) { return x * x; }

// sin(pi x) / (pi x).
double sinc(double x) { return std::abs(x) < 1e-9 ? 1 : std::sin(pi * x) / (pi * x); }

void add_to(BandCorrelation& correlation, double power, Complex turn) {
  Complex term = power;
  for (Complex& value : correlation) {
    value += term;
    term *= turn;
  }
}

// Mean over all pairs of frequencies of |correlation|^2.
double mean_square(const BandCorrelation& correlation) {
  double sum = 0;
  for (std::size_t k = 0; k < kFrequencies; ++k) {
    sum += (k == 0 ? 1.0 : 2.0) * static_cast<double>(kFrequencies - k) * std::norm(correlation[k]);
  }
  return sum / (kFrequencies * kFrequencies);
}

// K a, K_mn = E B_m B_n*.
BandPressures times(const BandCorrelation& correlation, const BandPressures& a) {
  BandPressures product{};
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    for (std::size_t n = 0; n < kFrequencies; ++n) {
      product[m] += (n > m ? std::conj(correlation[n - m]) : correlation[m - n]) * a[n];
    }
  }
  return product;
}

// a^H b / 8^2.
double mean_product(const BandPressures& a, const BandPressures& b) {
  double sum = 0;
  for (std::size_t m = 0; m < kFrequencies; ++m) sum += (std::conj(a[m]) * b[m]).real();
  return sum / (kFrequencies * kFrequencies);
}

double share_within(double begin_s, double end_s, double from_s, double to_s) {
  return to_s > from_s
             ? std::clamp((std::min(end_s, to_s) - std::max(begin_s, from_s)) / (to_s - from_s), 0.0, 1.0)
             : 0;
}

}  // namespace

double kept_variance(double x) { return 1 / std::sqrt(1 + x * x / pi); }

double kept_of_longer(double kept) { return kept / std::sqrt(kept * kept + (1 - kept * kept) / 2); }
double kept_of_part(double kept, double part) {
  return kept / std::sqrt(kept * kept + part * part * (1 - kept * kept));
}

BandPressures MeanSound::medium_direction() const {
  BandPressures direction = times(medium, steady);
  const double along = mean_product(steady, direction) * kFrequencies * kFrequencies;
  for (Complex& value : direction) value *= along > 0 ? 1 / std::sqrt(along) : 0;
  return direction;
}

MeanSound mean_sound(const std::vector<SoundPath>& paths, const Lock& lock, const Band& band,
                     const PacketTiming& timing) {
  const SoundPath &first = paths[lock.window.first], &strongest = paths[lock.window.strongest];
  const double spacing_hz = band.width_hz() / kFrequencies;
  const double kept = doppler_share(*lock.modem, strongest, band.centre_hz());
  const double preamble_s = timing.preamble.seconds(), end_s = timing.duration.seconds();
  MeanSound sound;
  SteadyBand steady(*lock.modem, band);
  double signal = 0, untracked = 0, squares = 0, products = 0, untracked_squares = 0, spread = 0,
         preamble_root = 0, bits_root = 0;
  for (std::size_t p = 0; p < paths.size(); ++p) {
    const SoundPath& path = paths[p];
    const double power = to_power_ratio(path.level).value, begin_s = path.delay_s - first.delay_s;
    if (const double late = lock.window.interference[p] * power; late > 0) {
      sound.preamble_echoes += late * share_within(begin_s, begin_s + end_s, 0, preamble_s);
      sound.bits_echoes += late * share_within(begin_s, begin_s + end_s, preamble_s, end_s);
    }
    const double within = squared(lock.window.weights[p]) * power;
    if (!(within > 0)) continue;
    const double of_path = within * kept * tracked_share(*lock.modem, path), rest = within - of_path;
    signal += of_path;
    untracked += rest;
    squares += of_path * of_path;
    products += of_path * rest;
    untracked_squares += rest * rest;
    const double excess_s = path.delay_s - strongest.delay_s;
    const Complex turn = std::polar(1.0, -2 * pi * std::fmod(spacing_hz * excess_s, 1.0));
    const double coherent = std::sqrt(of_path * path.fading.coherent);
    const double at_low = path.phase_rad - 2 * pi * std::fmod(band.low_hz * excess_s, 1.0);
    if (path.fading.coherent > kIncoherent)
      steady.add(
          {coherent, at_low, excess_s, std::sin(path.launch_angle_rad), std::sin(path.arrival_angle_rad)});
    Complex pressure = std::polar(coherent, at_low - pi * std::fmod(spacing_hz * excess_s, 2.0));
    for (Complex& sum : sound.steady) {
      sum += pressure;
      pressure *= turn;
    }
    // What is scattered so slowly that it holds through a packet fades as the medium does.
    const double rate = 2 * pi * path.fading.doppler_spread_hz;  // 1 / L of its power
    const double holds = 1 / (1 + squared(rate * (end_s - preamble_s)));
    const double scattered = of_path * path.fading.scattered * (1 - holds);
    add_to(sound.medium, of_path * (path.fading.medium + path.fading.scattered * holds), turn);
    add_to(sound.scattered, scattered, turn);
    add_to(sound.beating, scattered * squared(sinc(spacing_hz * excess_s)), turn);
    spread += scattered * squared(path.fading.doppler_spread_hz);
    preamble_root += scattered * std::sqrt(kept_variance(rate * preamble_s));
    bits_root += scattered * std::sqrt(kept_variance(rate * (end_s - preamble_s)));
  }
  const auto parts = steady.parts();
  double mean = sound.medium[0].real() + sound.scattered_power();
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    const double middle = std::abs(sound.steady[m]);
    sound.steady[m] *= middle > 0 ? std::sqrt(parts[m].constant) / middle : 0;
    sound.varying[m] = parts[m].varying;
    mean += (parts[m].constant + parts[m].varying) / kFrequencies;
  }
  if (mean > 0) sound.sway_variance = steady.sway_variance() / squared(mean);
  if (untracked > kNegligible * signal) {
    sound.untracked = untracked / signal;
    sound.shared_fading = products / squares / sound.untracked;
    sound.own_fading = untracked_squares / squares / squared(sound.untracked);
  }
  if (const double scattered = sound.scattered_power(); scattered > kNegligible * signal) {
    sound.spread_hz = std::sqrt(spread / scattered);
    sound.preamble_variance = squared(preamble_root / scattered);
    sound.bits_variance = squared(bits_root / scattered);
  }
  return sound;
}

SlowSound slow_sound(const MeanSound& sound, const BandPressures& direction, Complex state) {
  SlowSound slow;
  BandPressures steady{};
  const double medium = sound.medium[0].real(), scattered = sound.scattered_power();
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    steady[m] = sound.steady[m] + state * direction[m];
    slow.steady[m] = std::norm(steady[m]);
    slow.diffuse[m] = std::max(medium - std::norm(direction[m]), 0.0) + scattered + sound.varying[m];
    slow.mean += (slow.steady[m] + slow.diffuse[m]) / kFrequencies;
  }
  slow.own = mean_square(sound.scattered);
  slow.mixed = scattered > 0 ? 2 * mean_product(steady, times(sound.beating, steady)) : 0;
  if (scattered > 0) slow.constant = std::max(slow.mean - scattered - slow.mixed / (2 * scattered), 0.0);
  return slow;
}

}  // namespace halocline::acoustics
