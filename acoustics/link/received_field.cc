// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/received_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "acoustics/math/delay_profile.h"
#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kEchoRange = 1e-3;  // relative to the strongest power: 30 dB

Decibels level_of(double power, const FieldOptions& options) {
  const Decibels level = to_decibels({power});
  return options.floor ? std::max(level, *options.floor) : level;
}

// Phasor of a path at f, e^(i (phi - 2 pi f t)): t the delay, phi the phase, which grows as the delay
// shrinks.
std::complex<double> phasor(const Eigenray& path, double pressure, double frequency_hz) {
  const double cycles = std::fmod(frequency_hz * path.delay_s, 1.0);
  return elementary::polar(pressure, path.phase_rad - 2 * std::numbers::pi * cycles);
}

std::vector<WeightedDelay> weighted_delays(const Eigenrays& eigenrays, const Transducers& transducers) {
  std::vector<WeightedDelay> delays;
  for (const Eigenray& path : eigenrays.paths) {
    const double pressure = weighted_pressure(path, transducers);
    delays.push_back({path.delay_s, pressure * pressure});
  }
  return delays;
}

// Delay from the first to the last path within kEchoRange of the strongest.
double longest_echo_s(const std::vector<WeightedDelay>& delays) {
  double strongest = 0, first = std::numeric_limits<double>::infinity(), last = 0;
  for (const WeightedDelay& path : delays) strongest = std::max(strongest, path.power);
  for (const auto& [delay, power] : delays) {
    if (power < kEchoRange * strongest) continue;
    first = std::min(first, delay);
    last = std::max(last, delay);
  }
  return std::max(0.0, last - first);
}

}  // namespace

double weighted_pressure(const Eigenray& path, const Transducers& transducers) {
  // A ray that travels downwards arrives from above, hence the negative angle. The beams are multiplied
  // first, so that the reverse direction gives the same bits.
  return path.received_pressure() * (transducers.source.factor(path.launch_angle_rad) *
                                     transducers.receiver.factor(-path.arrival_angle_rad));
}

ReceivedField received_field(const Eigenrays& eigenrays, const FieldOptions& options) {
  ReceivedField field;
  field.silent = eigenrays.silent();
  const std::vector<WeightedDelay> delays = weighted_delays(eigenrays, options.transducers);
  double power = 0;
  for (const WeightedDelay& path : delays) power += path.power;
  field.level = level_of(power, options);
  if (delays.empty()) return field;
  field.first_delay_s = eigenrays.paths.front().delay_s;
  const DelayMoments moments = delay_moments(delays);
  field.mean_delay_s = moments.mean_s;
  field.delay_spread_s = moments.spread_s;
  field.longest_echo_s = longest_echo_s(delays);
  return field;
}

Decibels coherent_level(const Eigenrays& eigenrays, double frequency_hz, const FieldOptions& options) {
  require_in_range(frequency_hz, 10, 1e6, "frequency of a coherent level", "Hz");
  // p = sum over eigenrays of their phasors (Jensen and others 2011, section 3.3).
  std::complex<double> sum = 0;
  // Diffuse paths have no defined phase: their powers add.
  double diffuse = 0;
  for (const Eigenray& path : eigenrays.paths) {
    const double pressure = weighted_pressure(path, options.transducers);
    if (path.diffuse) {
      diffuse += pressure * pressure;
    } else {
      sum += phasor(path, pressure, frequency_hz);
    }
  }
  return level_of(std::norm(sum) + diffuse, options);
}

std::vector<std::complex<double>> impulse_response(const Eigenrays& eigenrays, double carrier_hz,
                                                   double rate_hz, double from_s, std::size_t count,
                                                   const Transducers& transducers) {
  require_in_range(carrier_hz, 0, 1e6, "carrier of an impulse response", "Hz");
  require_in_range(rate_hz, 1e-6, 1e7, "sampling rate of an impulse response", "Hz");
  require_in_range(static_cast<double>(count), 1, 1e7, "samples of an impulse response");
  std::vector<std::complex<double>> taps(count);
  for (const Eigenray& path : eigenrays.paths) {
    if (path.diffuse) continue;
    const double place = std::round((path.delay_s - from_s) * rate_hz);
    if (place < 0 || place >= static_cast<double>(count)) continue;
    taps[static_cast<std::size_t>(place)] += phasor(path, weighted_pressure(path, transducers), carrier_hz);
  }
  return taps;
}

}  // namespace halocline::acoustics
