// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/prediction/steady_band.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>

#include "acoustics/math/fast_functions.h"
#include "acoustics/math/functions.h"
#include "acoustics/modem/receiver_kind.h"
#include "acoustics/prediction/platform_jitter.h"
#include "core/vector_clones.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

// Samples in each part of the band: at intervals of at most half of 1 / (guard time + taper), at most `most`.
std::size_t samples_for(const Modem& receiver, double part_hz, std::size_t most) {
  const double longest_s = receiver.receiver == ReceiverKind::kStrongestPath
                               ? receiver.window_s() + receiver.window_taper_s()
                               : (receiver.guard_time + receiver.guard_taper_or_default()).seconds();
  return static_cast<std::size_t>(
      std::clamp(std::ceil(2 * part_hz * longest_s), 1.0, static_cast<double>(most)));
}

constexpr double kSoundSpeedMps = 1500;  // for the wave number
constexpr double kNegligible = 1e-5;     // share of the power below which interference has no effect

using Frequencies = std::array<double, kSignalFrequencies>;
using Complex = std::complex<double>;

Complex product(Complex a, Complex b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

Complex unit(double phase_rad) {
  const FastTurn turn = fast_turn(phase_rad);
  return {turn.cosine, turn.sine};
}

// Four parts of the band in one vector: loops over eight would be unrolled before compilers vectorise them.
using Four = double __attribute__((vector_size(4 * sizeof(double)), aligned(sizeof(double)), may_alias));
constexpr std::size_t kFours = kSignalFrequencies / 4;
Four* fours(Frequencies& values) { return reinterpret_cast<Four*>(values.data()); }
const Four* fours(const Frequencies& values) { return reinterpret_cast<const Four*>(values.data()); }

// Adds the pressures of a path, which turn by `step` from sample to sample.
using Samples = std::array<Frequencies, 32>;
HALOCLINE_VECTOR_CLONES
void add_samples(std::size_t samples, Complex step, const Frequencies& first_re, const Frequencies& first_im,
                 Samples& sum_re, Samples& sum_im) {
  const double c = step.real(), s = step.imag();
  for (std::size_t i = 0; i < kFours; ++i) {
    Four re = fours(first_re)[i], im = fours(first_im)[i];
    for (std::size_t k = 0; k < samples; ++k) {
      fours(sum_re[k])[i] += re;
      fours(sum_im[k])[i] += im;
      const Four turned = re * c - im * s;
      im = re * s + im * c;
      re = turned;
    }
  }
}

// Accumulates the effect of jitter on a path's pairs with the paths before it; returns the change of the
// mean, -I cos(phase) (1 - g). Pairs whose product is below `least` do not count.
double add_pairs(const SteadyBand::Member& p, std::span<const SteadyBand::Member> before, double least,
                 JitterVariance& variance) {
  double change = 0;
  for (const SteadyBand::Member& q : before) {
    if (2 * p.pressure * q.pressure < least) continue;
    const double x = p.half - q.half,
                 sinc = std::abs(x) < 1e-6 ? 1 : (p.sine * q.cosine - p.cosine * q.sine) / x;
    const double cosine_part = 2 * (p.re * q.re + p.im * q.im) * sinc,
                 sine_part = 2 * (p.im * q.re - p.re * q.im) * sinc;
    const double kept =
        variance.add(cosine_part, sine_part, p.launch_sine - q.launch_sine, p.arrival_sine - q.arrival_sine);
    change -= cosine_part * (1 - kept);
  }
  return change;
}

// Sums over the samples of each part, of the power and of its square.
HALOCLINE_VECTOR_CLONES
void sum_powers(std::size_t samples, const Samples& re, const Samples& im, Frequencies& means,
                Frequencies& squares) {
  for (std::size_t i = 0; i < kFours; ++i) {
    Four mean{}, square{};
    for (std::size_t k = 0; k < samples; ++k) {
      const Four power = fours(re[k])[i] * fours(re[k])[i] + fours(im[k])[i] * fours(im[k])[i];
      mean += power;
      square += power * power;
    }
    fours(means)[i] = mean;
    fours(squares)[i] = square;
  }
}

}  // namespace

BandTurns band_turns(double turns) {
  BandTurns all;
  all.half = unit(pi * turned(turns, 2));
  const Complex one = product(all.half, all.half), two = product(one, one), four = product(two, two);
  const std::array<Complex, 4> low{1, one, two, product(two, one)};
  for (std::size_t m = 0; m < low.size(); ++m) {
    const Complex high = product(low[m], four);
    all.re[m] = low[m].real();
    all.im[m] = low[m].imag();
    all.re[m + 4] = high.real();
    all.im[m + 4] = high.imag();
  }
  return all;
}

SteadyBand::SteadyBand(const Modem& receiver, const Band& band, std::size_t paths)
    : band_(band),
      part_hz_(band.width_hz() / kSignalFrequencies),
      samples_(samples_for(receiver, part_hz_, kMaxSamples)) {
  members_.reserve(paths);
}

// The phase falls by 2 pi f delay. The pressures of all parts turn by the same factor from sample to sample.
Complex SteadyBand::add(const Path& path, const BandTurns& turns) {
  const double half_step = pi * turned(part_hz_ / static_cast<double>(samples_) * path.excess_s, 2);
  const Complex low = path.pressure * unit(path.phase_rad), half = unit(-half_step),
                first = product(low, half), step = product(half, half);
  Frequencies re, im;
  for (std::size_t m = 0; m < kSignalFrequencies; ++m) {
    re[m] = turns.re[m] * first.real() - turns.im[m] * first.imag();
    im[m] = turns.re[m] * first.imag() + turns.im[m] * first.real();
  }
  add_samples(samples_, step, re, im, re_, im_);
  const Complex over_half_of_band(turns.re[4], turns.im[4]), middle = product(low, over_half_of_band);
  members_.push_back({.re = middle.real(),
                      .im = middle.imag(),
                      .half = pi * band_.width_hz() * path.excess_s,
                      .sine = -over_half_of_band.imag(),
                      .cosine = over_half_of_band.real(),
                      .launch_sine = path.launch_sine,
                      .arrival_sine = path.arrival_sine,
                      .pressure = path.pressure});
  return product(low, turns.half);
}

std::array<SteadyBand::Part, kSignalFrequencies> SteadyBand::parts(const JitterEffect& jitter) const {
  std::array<Part, kSignalFrequencies> parts;
  const auto count = static_cast<double>(samples_);
  Frequencies means{}, squares{};
  sum_powers(samples_, re_, im_, means, squares);
  for (std::size_t m = 0; m < kSignalFrequencies; ++m) {
    const double mean = means[m] / count;
    // constant^2 = S^2 - V = 2 S^2 - mean of the squared power.
    parts[m].constant = std::sqrt(std::max(2 * mean * mean - squares[m] / count, 0.0));
    parts[m].varying = mean - parts[m].constant;
  }
  add(jitter, parts);
  return parts;
}

// Sums over the pairs that interfere less than kNearCycles times over the band; each has its phase at the
// middle of the band. The wave number k is that at the centre.
SteadyBand::JitterEffect SteadyBand::jitter() const {
  const double wave_number = 2 * pi * band_.centre_hz() / kSoundSpeedMps;
  double least = 0;
  for (const Member& member : members_) least += kNegligible * squared(member.pressure);
  JitterEffect jitter;
  JitterVariance variance(wave_number);
  std::size_t from = 0;  // first path that is near enough
  for (std::size_t p = 0; p < members_.size(); ++p) {
    while (members_[p].half - members_[from].half >= pi * kNearCycles) ++from;
    jitter.change += add_pairs(members_[p], std::span(members_).subspan(from, p - from), least, variance);
  }
  jitter.variance = variance.variance();
  return jitter;
}

// Distributes the change of the mean over the band to its parts. Jitter moves interference that alternates
// over the band only between parts, so all parts change alike.
void SteadyBand::add(const JitterEffect& jitter, std::array<Part, kSignalFrequencies>& parts) {
  for (Part& part : parts) {
    const double power = part.constant + part.varying;
    if (jitter.change >= 0) {
      part.constant += jitter.change;
    } else if (power > 0) {
      const double left = std::max(power + jitter.change, 0.0) / power;
      part.constant *= left;
      part.varying *= left;
    }
  }
}

}  // namespace halocline::acoustics
