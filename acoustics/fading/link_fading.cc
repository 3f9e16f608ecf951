// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/fading/link_fading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string_view>

#include "acoustics/math/functions.h"
#include "core/elementary.h"
#include "core/random.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;
constexpr std::size_t kSines = ComplexNoise::kSines;

constexpr double kAngleScale = to_radians(4);  // rad: paths within 2 degrees cross the same water
// Share of the mean power below which a component of a path is left out of the sum, an error of 1e-5 dB.
constexpr double kSoundSpeedMps = 1500;  // for the wave number
constexpr double kNegligible = 1e-6;
constexpr double kFarApart = 60;  // squared distance beyond which paths share nothing: e^-30

std::uint64_t pair_of(const FadingLink& link) { return std::uint64_t{link.lower_id} << 32 | link.higher_id; }

DrawAddress address_of(const FadingLink& link, std::string_view purpose, std::uint64_t path = 0) {
  // The pair and the path do not fit into `who`, so they become part of the seed.
  return {.seed = identity_of({link.seed, pair_of(link), path}), .purpose = purpose_of(purpose)};
}

// Coordinates of a path in the random field of the medium, in the field's correlation lengths.
struct MediumPlace {
  double delay, launch, arrival;
};

// Mean of the delays, weighted by power.
double mean_delay_s(const std::vector<Arrival>& paths) {
  double sum = 0, weight = 0;
  for (const Arrival& path : paths) {
    const double power = to_power_ratio(path.level).value;
    sum += power * (path.delay_s - paths.front().delay_s);
    weight += power;
  }
  return paths.front().delay_s + (weight > 0 ? sum / weight : 0);
}

MediumPlace place_of(const Arrival& path, double mean_delay_s, const Band& band, bool reversed) {
  const double launch = reversed ? -path.arrival_angle_rad : path.launch_angle_rad;
  const double arrival = reversed ? -path.launch_angle_rad : path.arrival_angle_rad;
  return {2 * band.width_hz() * (path.delay_s - mean_delay_s), launch / kAngleScale, arrival / kAngleScale};
}

// A sum of complex exponentials that steps from instant to instant, each rotating by a constant factor.
class TurningSines {
 public:
  // Sets term `k`: its phase in cycles, and the cycles by which it rotates per step.
  void set(std::size_t k, double phase, double cycles_per_step) {
    const double at = 2 * pi * (phase - std::floor(phase)), turn = 2 * pi * cycles_per_step;
    re_[k] = elementary::cos(at);
    im_[k] = elementary::sin(at);
    turn_re_[k] = elementary::cos(turn);
    turn_im_[k] = elementary::sin(turn);
  }
  Complex sum() const {
    double re = 0, im = 0;
    for (std::size_t k = 0; k < kSines; ++k) {
      re += re_[k];
      im += im_[k];
    }
    return Complex(re, im) / std::sqrt(static_cast<double>(kSines));
  }
  void step() {
    for (std::size_t k = 0; k < kSines; ++k) {
      const double re = re_[k] * turn_re_[k] - im_[k] * turn_im_[k];
      im_[k] = re_[k] * turn_im_[k] + im_[k] * turn_re_[k];
      re_[k] = re;
    }
  }

 private:
  std::array<double, kSines> re_{}, im_{}, turn_re_{}, turn_im_{};
};

// The random field of the medium: a sum of complex exponentials over time and coordinates.
struct MediumField {
  ComplexNoise noise;
  std::array<std::array<double, 3>, kSines> wave_numbers;  // rad per unit of each coordinate

  explicit MediumField(const FadingLink& link) : noise(address_of(link, "fading-medium")) {
    DrawAddress address = address_of(link, "fading-medium-place");
    for (std::size_t k = 0; k < kSines; ++k) {
      for (std::size_t i = 0; i < 3; ++i) {
        address.which = 3 * k + i;
        wave_numbers[k][i] = normal_at(address);
      }
    }
  }
  TurningSines at(const MediumPlace& place, double time_s, double step_s, double spread_hz) const {
    TurningSines sines;
    for (std::size_t k = 0; k < kSines; ++k) {
      const auto& w = wave_numbers[k];
      const double rate_hz = noise.frequencies()[k] * spread_hz;
      const double turned = (w[0] * place.delay + w[1] * place.launch + w[2] * place.arrival) / (2 * pi);
      sines.set(k, noise.phases()[k] + rate_hz * time_s + turned, rate_hz * step_s);
    }
    return sines;
  }
};

// The scattered component of a path as a sum of complex exponentials.
TurningSines scattered_sines(const FadingLink& link, const Arrival& path, double time_s, double step_s) {
  const ComplexNoise noise(address_of(link, "fading-scattered", path.identity.number()));
  TurningSines sines;
  for (std::size_t k = 0; k < kSines; ++k) {
    const double rate_hz = noise.frequencies()[k] * path.fading.doppler_spread_hz;
    sines.set(k, noise.phases()[k] + rate_hz * time_s, rate_hz * step_s);
  }
  return sines;
}

// The quantities of one path that the cross terms of the mean power depend on. Products of sines and cosines
// of single paths replace the sines of differences.
struct CrossingPath {
  double coherent, medium;      // pressures: sqrt(P c) and sqrt(P m)
  double cos_phase, sin_phase;  // at the centre of the band
  double turns;                 // W (delay - mean delay), with W the band's width
  double cos_half, sin_half;    // cosine and sine of pi times `turns`
  MediumPlace place;
  double launch_sine = 0, arrival_sine = 0;  // used while the ends move
};

CrossingPath crossing_path(const Arrival& path, double mean_delay_s, const Band& band) {
  const double power = to_power_ratio(path.level).value;
  const double phase = path.phase_rad - 2 * pi * std::fmod(band.centre_hz() * path.delay_s, 1.0);
  const double turns = band.width_hz() * (path.delay_s - mean_delay_s);
  return {std::sqrt(power * path.fading.coherent),
          std::sqrt(power * path.fading.medium),
          elementary::cos(phase),
          elementary::sin(phase),
          turns,
          elementary::cos(pi * turns),
          elementary::sin(pi * turns),
          place_of(path, mean_delay_s, band, false),
          elementary::sin(path.launch_angle_rad),
          elementary::sin(path.arrival_angle_rad)};
}

// Share of a cross term that is left in its mean over vertical movements of both ends by J rms:
//   exp(-(k J)^2 ((sin launch_p - sin launch_q)^2 + (sin arrival_p - sin arrival_q)^2) / 2);
// `exponent` is -(k J)^2 / 2.
double left_by_jitter(const CrossingPath& p, const CrossingPath& q, double exponent) {
  return elementary::exp(exponent *
                         (squared(p.launch_sine - q.launch_sine) + squared(p.arrival_sine - q.arrival_sine)));
}

// Cross term of two paths: the real part of the mean of h_p h_q* over the band,
//   sqrt(P_p P_q) (sqrt(c_p c_q) + sqrt(m_p m_q) e^(-apart^2 / 2))
//   cos(phase difference) sinc(W (delay_p - delay_q));
// 0 where it is at most `negligible`.
double cross_power(const CrossingPath& p, const CrossingPath& q, double negligible) {
  const double coherent = p.coherent * q.coherent, medium = p.medium * q.medium;
  if (coherent + medium < negligible) return 0;
  const double apart = squared(p.place.delay - q.place.delay) + squared(p.place.launch - q.place.launch) +
                       squared(p.place.arrival - q.place.arrival);
  const double shared = apart < kFarApart ? medium * elementary::exp(-apart / 2) : 0;
  const double x = pi * (p.turns - q.turns);
  const double sinc = std::abs(x) < 1e-9 ? 1 : (p.sin_half * q.cos_half - p.cos_half * q.sin_half) / x;
  return (coherent + shared) * (p.cos_phase * q.cos_phase + p.sin_phase * q.sin_phase) * sinc;
}

}  // namespace

LinkFading::LinkFading(const FadingModel& model, const FadingLink& link) : model_(model), link_(link) {
  validate(model);
}

// 10^((X + Y)/20); the mean -sigma^2 ln(10) / 20 of X makes the mean power 1.
double LinkFading::large_scale(SimTime time) const {
  if (!model_.enabled) return 1;
  const double slow_db = slow_level(model_.slow, {link_.seed, link_.lower_id, link_.higher_id}, time).value;
  if (model_.large_scale_db == 0) return slow_db == 0 ? 1 : elementary::exp10(slow_db / 20);
  const bool is_still = link_.at_rest && model_.large_scale_still_s > 0;
  const GaussMarkovProcess process(model_.large_scale_db,
                                   is_still ? model_.large_scale_still_s : model_.large_scale_time_s,
                                   address_of(link_, "fading-large-scale"));
  const double sigma = model_.large_scale_db;
  const double level_db = process.at(time) - sigma * sigma * std::numbers::ln10 / 20 + slow_db;
  return elementary::exp10(level_db / 20);
}

std::vector<Complex> LinkFading::responses(const std::vector<Arrival>& paths, const Band& band, SimTime start,
                                           const FadingTimes& times, double large_scale) const {
  std::vector<Complex> all;
  all.reserve(paths.size() * static_cast<std::size_t>(times.count));
  if (paths.empty()) return all;
  const double time_s = start.seconds() + times.begin_s, mean_s = mean_delay_s(paths);
  const double medium_spread_hz = doppler_spread_of(model_.medium_coherence_s);
  std::optional<MediumField> medium;
  for (const Arrival& path : paths) {
    // The medium modulates the coherent component:
    //   h = sqrt(P) 10^(X/20) (sqrt(c) e^(j phi) + e^(j phi) sqrt(m) g_m + sqrt(s) g_s)
    const PathFading& shares = path.fading;
    const double pressure = std::sqrt(to_power_ratio(path.level).value) * large_scale;
    const Complex phase = elementary::polar(1.0, path.phase_rad);
    const Complex steady = pressure * std::sqrt(shares.coherent) * phase;
    const bool turns = shares.medium > kNegligible, scatters = shares.scattered > kNegligible;
    TurningSines in_medium, scattered;
    if (turns) {
      if (!medium) medium.emplace(link_);
      in_medium =
          medium->at(place_of(path, mean_s, band, link_.reversed), time_s, times.step_s, medium_spread_hz);
    }
    if (scatters) scattered = scattered_sines(link_, path, time_s, times.step_s);
    for (int i = 0; i < times.count; ++i) {
      Complex h = steady;
      if (turns) {
        h += pressure * std::sqrt(shares.medium) * phase * in_medium.sum();
        in_medium.step();
      }
      if (scatters) {
        h += pressure * std::sqrt(shares.scattered) * scattered.sum();
        scattered.step();
      }
      all.push_back(h);
    }
  }
  return all;
}

double mean_power(const FadingModel& model, const std::vector<Arrival>& paths, const Band& band) {
  double total = 0;
  for (const Arrival& path : paths) total += to_power_ratio(path.level).value;
  if (!model.enabled || paths.size() < 2) return total;
  const double mean_s = mean_delay_s(paths);
  std::vector<CrossingPath> crossing;
  crossing.reserve(paths.size());
  for (const Arrival& path : paths) crossing.push_back(crossing_path(path, mean_s, band));
  const double wave_number = 2 * pi * band.centre_hz() / kSoundSpeedMps;
  const double exponent = -squared(wave_number * model.platform_jitter_m) / 2;
  double crossed = 0;
  for (std::size_t p = 1; p < crossing.size(); ++p) {
    for (std::size_t q = 0; q < p; ++q) {
      const double cross = cross_power(crossing[p], crossing[q], kNegligible * total);
      crossed +=
          exponent == 0 || cross == 0 ? cross : cross * left_by_jitter(crossing[p], crossing[q], exponent);
    }
  }
  return std::max(total + 2 * crossed, 0.0);
}

}  // namespace halocline::acoustics
