#include "acoustics/reception/steady_band.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

std::size_t samples_for(const Modem& receiver, double part_hz, std::size_t most) {
  const double longest_s = (receiver.guard_time + receiver.guard_taper_or_default()).seconds();
  return static_cast<std::size_t>(
      std::clamp(std::ceil(2 * part_hz * longest_s), 1.0, static_cast<double>(most)));
}

}  // namespace

SteadyBand::SteadyBand(const Modem& receiver, const Band& band)
    : spacing_hz_(band.width_hz() / kSignalFrequencies),
      samples_(samples_for(receiver, spacing_hz_, kMaxSamples)) {
  spacing_hz_ /= static_cast<double>(samples_);
}

// The phase falls by 2 pi f delay. Samples of a part turn together from part to part.
void SteadyBand::add(double pressure, double phase_rad, double excess_s) {
  Samples re{}, im{};
  const double half_step = pi * std::fmod(spacing_hz_ * excess_s, 2.0);
  const std::complex<double> turn = std::polar(1.0, -2 * half_step);
  std::complex<double> sample = std::polar(pressure, phase_rad - half_step);
  for (std::size_t k = 0; k < samples_; ++k, sample *= turn) {
    re[k] = sample.real();
    im[k] = sample.imag();
  }
  const double turned = 2 * pi * std::fmod(spacing_hz_ * static_cast<double>(samples_) * excess_s, 1.0);
  const double c = std::cos(turned), s = -std::sin(turned);
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

std::array<SteadyBand::Part, kSignalFrequencies> SteadyBand::parts() const {
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
  return parts;
}

}  // namespace halocline::acoustics
