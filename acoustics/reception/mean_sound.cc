#include "acoustics/reception/mean_sound.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <Eigen/Dense>

#include "acoustics/math/fast_functions.h"
#include "acoustics/math/functions.h"
#include "acoustics/reception/steady_band.h"
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

void add_to(SharedFading& shared, double x, double y, double squared_spread) {
  shared.y += y;
  shared.xy += x * y;
  shared.yy += y * y;
  shared.xy_spread += x * y * squared_spread;
  shared.yy_spread += y * y * squared_spread;
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

// A path whose untracked part interferes: its turn of phase from frequency to frequency, and the product of both powers.
struct SharedPath {
  Complex turn;
  double xy;
};

// E_j = sum of x y |v^H w_j|^2 / (8 lambda_j) over paths of steering vectors v, for modes K w_j = 8 lambda_j w_j.
void add_modes(const std::vector<SharedPath>& paths, MeanSound& sound) {
  using Matrix = Eigen::Matrix<Complex, kFrequencies, kFrequencies>;
  Matrix scattered;
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    for (std::size_t n = 0; n <= m; ++n) {
      scattered(static_cast<Eigen::Index>(m), static_cast<Eigen::Index>(n)) = sound.scattered[m - n];
    }
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(scattered);
  sound.apart = sound.shared.y;
  for (Eigen::Index j = 0; j < static_cast<Eigen::Index>(kFrequencies); ++j) {
    BandMode mode{.scattered = solver.eigenvalues()(j) / kFrequencies};
    if (!(mode.scattered > 1e-4 * sound.scattered_power())) continue;
    BandPressures w{};
    for (std::size_t m = 0; m < kFrequencies; ++m)
      w[m] = solver.eigenvectors()(static_cast<Eigen::Index>(m), j);
    for (const SharedPath& path : paths) {
      if (!(path.xy > 0)) continue;
      Complex sum = 0, turn = 1;
      for (std::size_t m = 0; m < kFrequencies; ++m, turn = product(turn, path.turn)) {
        sum += product(std::conj(turn), w[m]);
      }
      mode.interference += path.xy * std::norm(sum) / (kFrequencies * mode.scattered);
    }
    Complex steady = 0;
    for (std::size_t m = 0; m < kFrequencies; ++m) steady += product(std::conj(w[m]), sound.steady[m]);
    const double medium = mean_product(w, times(sound.medium, w)) * kFrequencies;
    mode.rest = std::norm(steady) / kFrequencies + medium;
    sound.apart -= mode.interference;
    sound.modes.push_back(mode);
  }
  sound.apart = std::max(sound.apart, 0.0);
}

double share_within(double begin_s, double end_s, double from_s, double to_s) {
  return to_s > from_s
             ? std::clamp((std::min(end_s, to_s) - std::max(begin_s, from_s)) / (to_s - from_s), 0.0, 1.0)
             : 0;
}

}  // namespace

double kept_variance(double x) { return 1 / std::sqrt(1 + x * x / pi); }

double kept_of_longer(double kept) { return kept / std::sqrt(kept * kept + (1 - kept * kept) / 2); }
double third_share(double kept) { return kept > 0.5 ? (3 * kept - 1) / 2 : kept * kept; }
double kept_of_part(double kept, double part) {
  return kept / std::sqrt(kept * kept + part * part * (1 - kept * kept));
}

MeanSound mean_sound(const std::vector<SoundPath>& paths, const Lock& lock, const Band& band,
                     const PacketTiming& timing) {
  const SoundPath &first = paths[lock.window.first], &strongest = paths[lock.window.strongest];
  const double spacing_hz = band.width_hz() / kFrequencies;
  const double kept = doppler_share(*lock.modem, strongest, band.centre_hz());
  const double preamble_s = timing.preamble.seconds(), end_s = timing.duration.seconds();
  MeanSound sound;
  const double strongest_power = fast_power(strongest.level.value);
  SteadyBand steady(*lock.modem, band);
  double signal = 0, untracked = 0, spread = 0, all = 0, all_spread = 0, preamble_root = 0, bits_root = 0;
  std::vector<SharedPath> shares;
  shares.reserve(paths.size());
  for (std::size_t p = 0; p < paths.size(); ++p) {
    const SoundPath& path = paths[p];
    const double power = fast_power(path.level.value), begin_s = path.delay_s - first.delay_s;
    const double rate = 2 * pi * path.fading.doppler_spread_hz;  // 1 / L of its power
    // What is scattered so slowly that it holds through a packet fades as the medium does.
    const double holds = 1 / (1 + squared(rate * (end_s - preamble_s)));
    const double fast = path.fading.scattered * (1 - holds), within = squared(lock.window.weights[p]) * power;
    const double of_path = within * kept * tracked_share(*lock.modem, path), rest = within - of_path;
    double interference = rest;
    if (const double late = lock.window.interference[p] * power; late > 0) {
      const double of_bits = late * share_within(begin_s, begin_s + end_s, preamble_s, end_s);
      const double of_preamble = late * share_within(begin_s, begin_s + end_s, 0, preamble_s);
      const double fades = 1 - squared(path.fading.coherent);
      sound.preamble_echoes += of_preamble;
      sound.bits_echoes += of_bits;
      sound.preamble_echo_variance += squared(of_preamble) * fades * kept_variance(rate * preamble_s);
      sound.bits_echo_variance += squared(of_bits) * fades * kept_variance(rate * (end_s - preamble_s));
      interference += of_bits;
    }
    add_to(sound.shared, of_path * fast, interference * fast, squared(path.fading.doppler_spread_hz));
    if (!(within > 0)) continue;
    shares.push_back({Complex{}, of_path * interference * fast * fast});
    signal += of_path;
    untracked += rest;
    all += within;
    all_spread += within * squared(path.fading.doppler_spread_hz);
    const double excess_s = path.delay_s - strongest.delay_s;
    const Complex turn = std::polar(1.0, -2 * pi * turned(spacing_hz * excess_s, 1));
    shares.back().turn = turn;
    // What is hardly coherent turns as the medium does.
    const bool steadily = of_path * path.fading.coherent > kIncoherent * strongest_power;
    const double coherent = steadily ? std::sqrt(of_path * path.fading.coherent) : 0;
    const double at_low = path.phase_rad - 2 * pi * turned(band.low_hz * excess_s, 1);
    if (steadily) {
      steady.add(
          {coherent, at_low, excess_s, std::sin(path.launch_angle_rad), std::sin(path.arrival_angle_rad)});
      Complex pressure = std::polar(coherent, at_low - pi * turned(spacing_hz * excess_s, 2));
      for (Complex& sum : sound.steady) {
        sum += pressure;
        pressure = product(pressure, turn);
      }
    }
    const double scattered = of_path * fast;
    add_to(sound.medium,
           of_path *
               (path.fading.medium + path.fading.scattered * holds + (steadily ? 0 : path.fading.coherent)),
           turn);
    add_to(sound.scattered, scattered, turn);
    add_to(sound.beating, scattered * squared(sinc(spacing_hz * excess_s)), turn);
    spread += scattered * squared(path.fading.doppler_spread_hz);
    preamble_root += scattered * std::sqrt(kept_variance(rate * preamble_s));
    bits_root += scattered * std::sqrt(kept_variance(rate * (end_s - preamble_s)));
  }
  const SteadyBand::Sway sway = steady.sway();
  const auto parts = steady.parts(sway);
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    const double middle = std::abs(sound.steady[m]);
    sound.steady[m] *= middle > 0 ? std::sqrt(parts[m].constant) / middle : 0;
    sound.varying[m] = parts[m].varying;
  }
  const double mean = sound.coherent_power() + sound.medium[0].real() + sound.scattered_power();
  if (mean > 0) sound.sway_variance = sway.variance / squared(mean);
  if (untracked > kNegligible * signal) sound.untracked = untracked / signal;
  sound.window_spread_hz = all > 0 ? std::sqrt(all_spread / all) : 0;
  if (const double scattered = sound.scattered_power(); scattered > kNegligible * signal) {
    sound.spread_hz = std::sqrt(spread / scattered);
    sound.preamble_variance = squared(preamble_root / scattered);
    sound.bits_variance = squared(bits_root / scattered);
    sound.shared.own = mean_correlation(sound.scattered, sound.scattered);
    const double others = sound.medium[0].real() + sound.coherent_power();
    if (!is_frequency_shift_keying(lock.modem->error_model)) add_modes(shares, sound);
    if (others > 0) {
      sound.beats = 2 *
                    (mean_product(sound.steady, times(sound.beating, sound.steady)) +
                     mean_correlation(sound.scattered, sound.medium)) /
                    others;
    }
  }
  if (sound.preamble_echoes > 0) sound.preamble_echo_variance /= squared(sound.preamble_echoes);
  if (sound.bits_echoes > 0) sound.bits_echo_variance /= squared(sound.bits_echoes);
  return sound;
}

double MeanSound::coherent_power() const {
  double sum = 0;
  for (std::size_t m = 0; m < kFrequencies; ++m) sum += (std::norm(steady[m]) + varying[m]) / kFrequencies;
  return sum;
}

PowerLaw MeanSound::slow_power() const {
  const double turned = medium[0].real(), coherent = coherent_power();
  if (!(turned > kNegligible * coherent)) return {coherent + turned};
  const double own = mean_correlation(medium, medium),
               mixed = 2 * mean_product(steady, times(medium, steady));
  const double kept = own / squared(turned), share = third_share(kept);
  return {coherent + turned, own + mixed, turned * share * (2 * turned * turned + 3 * mixed / kept)};
}

PowerLaw MeanSound::power(double slow_power, double kept) const {
  const double fast = scattered_power();
  if (!(fast > kNegligible * slow_power)) return {slow_power + fast};
  const double own = shared.own, mixed = beats * slow_power;
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
