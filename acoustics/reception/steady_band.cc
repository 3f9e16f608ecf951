#include "acoustics/reception/steady_band.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "acoustics/math/functions.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

// Twice as many for chips at single frequencies, of which the square counts, as for an equaliser that collects the band.
std::size_t samples_for(const Modem& receiver, double part_hz, std::size_t most) {
  const double longest_s = (receiver.guard_time + receiver.guard_taper_or_default()).seconds();
  const double apart = is_frequency_shift_keying(receiver.error_model) ? 0.5 : 1;
  return static_cast<std::size_t>(
      std::clamp(std::ceil(part_hz * longest_s / apart), 1.0, static_cast<double>(most)));
}

constexpr double kSoundSpeedMps = 1500;  // of the wave number

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
  add_sway(parts);
  return parts;
}

// Pairs that interfere few enough times over the band.
template <typename Take>
void SteadyBand::for_near_pairs(Take take) const {
  const double wave_number = 2 * pi * band_.centre_hz() / kSoundSpeedMps;
  for (std::size_t p = 0; p < paths_.size(); ++p) {
    for (std::size_t q = 0; q < p; ++q) {
      const Path &one = paths_[p], &other = paths_[q];
      const double apart_s = one.excess_s - other.excess_s;
      if (std::abs(apart_s) * band_.width_hz() >= kNearCycles) continue;
      const double sines =
          squared(one.launch_sine - other.launch_sine) + squared(one.arrival_sine - other.arrival_sine);
      take(Pair{2 * one.pressure * other.pressure,
                one.phase_rad - other.phase_rad - pi * band_.width_hz() * apart_s, apart_s,
                std::exp(-squared(wave_number * kSwayM) * sines / 2)});
    }
  }
}

// What sway takes of the interference over the whole band: where it comes and goes over the band, sway moves it only from part
// to part.
void SteadyBand::add_sway(std::array<Part, kSignalFrequencies>& parts) const {
  double change = 0;
  for_near_pairs([&](const Pair& pair) {
    change -= pair.interference * (1 - pair.kept) * sinc(band_.width_hz() * pair.apart_s) *
              std::cos(pair.phase_rad);
  });
  for (Part& part : parts) {
    const double power = part.constant + part.varying;
    if (change >= 0) {
      part.constant += change;
    } else if (power > 0) {
      const double left = std::max(power + change, 0.0) / power;
      part.constant *= left;
      part.varying *= left;
    }
  }
}

double SteadyBand::sway_variance() const {
  double sum = 0;
  for_near_pairs([&](const Pair& pair) {
    const double kept = squared(pair.kept);
    sum += squared(pair.interference * sinc(band_.width_hz() * pair.apart_s)) * (1 - kept) *
           (1 - kept * std::cos(2 * pair.phase_rad)) / 2;
  });
  return sum;
}

}  // namespace halocline::acoustics
