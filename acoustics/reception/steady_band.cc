#include "acoustics/reception/steady_band.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "acoustics/math/fast_functions.h"
#include "acoustics/math/functions.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

std::size_t samples_for(const Modem& receiver, double part_hz, std::size_t most) {
  const double longest_s = (receiver.guard_time + receiver.guard_taper_or_default()).seconds();
  return static_cast<std::size_t>(
      std::clamp(std::ceil(2 * part_hz * longest_s), 1.0, static_cast<double>(most)));
}

constexpr double kSoundSpeedMps = 1500;  // of the wave number
constexpr double kNegligible = 1e-5;     // of the power: interference of no effect

}  // namespace

SteadyBand::SteadyBand(const Modem& receiver, const Band& band)
    : band_(band),
      spacing_hz_(band.width_hz() / kSignalFrequencies),
      samples_(samples_for(receiver, spacing_hz_, kMaxSamples)) {
  spacing_hz_ /= static_cast<double>(samples_);
}

// The phase falls by 2 pi f delay. Samples of a part turn together from part to part.
void SteadyBand::add(const Path& path) {
  paths_.push_back(path);
  const auto& [pressure, phase_rad, excess_s, launch_sine, arrival_sine] = path;
  Samples re{}, im{};
  const double half_step = pi * turned(spacing_hz_ * excess_s, 2);
  const std::complex<double> turn = elementary::polar(1.0, -2 * half_step);
  std::complex<double> sample = elementary::polar(pressure, phase_rad - half_step);
  for (std::size_t k = 0; k < samples_; ++k) {
    re[k] = sample.real();
    im[k] = sample.imag();
    sample = {sample.real() * turn.real() - sample.imag() * turn.imag(),
              sample.real() * turn.imag() + sample.imag() * turn.real()};
  }
  const double angle = 2 * pi * turned(spacing_hz_ * static_cast<double>(samples_) * excess_s, 1);
  const double c = elementary::cos(angle), s = -elementary::sin(angle);
  for (std::size_t m = 0; m < kSignalFrequencies; ++m) {
    for (std::size_t k = 0; k < samples_; ++k) {
      re_[m][k] += re[k];
      im_[m][k] += im[k];
      const double next = re[k] * c - im[k] * s;
      im[k] = re[k] * s + im[k] * c;
      re[k] = next;
    }
  }
}

std::array<SteadyBand::Part, kSignalFrequencies> SteadyBand::parts(const Sway& sway) const {
  std::array<Part, kSignalFrequencies> parts;
  const auto count = static_cast<double>(samples_);
  for (std::size_t m = 0; m < kSignalFrequencies; ++m) {
    double mean = 0, squares = 0;
    for (std::size_t k = 0; k < samples_; ++k) {
      const double power = re_[m][k] * re_[m][k] + im_[m][k] * im_[m][k];
      mean += power / count;
      squares += power * power / count;
    }
    // S^2 - V = 2 S^2 - mean of the squares.
    parts[m].constant = std::sqrt(std::max(2 * mean * mean - squares, 0.0));
    parts[m].varying = mean - parts[m].constant;
  }
  add(sway, parts);
  return parts;
}

// By pairs that interfere few enough times over the band: a product of 2 a_p a_q, kept to g, its phase at the middle of the
// band.
SteadyBand::Sway SteadyBand::sway() const {
  const double wave_number = 2 * pi * band_.centre_hz() / kSoundSpeedMps,
               exponent = -squared(wave_number * kSwayM) / 2;
  double power = 0;
  for (const Path& path : paths_) power += squared(path.pressure);
  Sway sway;
  for (std::size_t p = 0; p < paths_.size(); ++p) {
    for (std::size_t q = 0; q < p; ++q) {
      const Path &one = paths_[p], &other = paths_[q];
      const double apart_s = one.excess_s - other.excess_s, cycles = apart_s * band_.width_hz();
      if (std::abs(cycles) >= kNearCycles) continue;
      const double product = 2 * one.pressure * other.pressure;
      if (product < kNegligible * power) continue;
      const double sines =
          squared(one.launch_sine - other.launch_sine) + squared(one.arrival_sine - other.arrival_sine);
      const double kept = fast_exp(exponent * sines), interference = product * sinc(cycles),
                   cosine = elementary::cos(one.phase_rad - other.phase_rad - pi * cycles);
      sway.change -= interference * (1 - kept) * cosine;
      // cos(2 phase) = 2 cos(phase)^2 - 1
      sway.variance +=
          squared(interference) * (1 - squared(kept)) * (1 - squared(kept) * (2 * squared(cosine) - 1)) / 2;
    }
  }
  return sway;
}

// What sway takes of the interference over the whole band: where it comes and goes over the band, sway moves it only from part
// to part.
void SteadyBand::add(const Sway& sway, std::array<Part, kSignalFrequencies>& parts) {
  for (Part& part : parts) {
    const double power = part.constant + part.varying;
    if (sway.change >= 0) {
      part.constant += sway.change;
    } else if (power > 0) {
      const double left = std::max(power + sway.change, 0.0) / power;
      part.constant *= left;
      part.varying *= left;
    }
  }
}

}  // namespace halocline::acoustics
