// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/sensors/sensor_errors.h"

#include <cmath>

#include "core/check.h"
#include "core/random.h"

namespace halocline::vehicle_sim {
namespace {

// The fields of `which`: sample (48 bits), sensor (6) and axis (10), without hashing.
DrawAddress address_of(const SensorIdentity& sensor, std::uint32_t purpose, std::int64_t sample, int part) {
  const auto which = static_cast<std::uint64_t>(sample) << 16 |
                     static_cast<std::uint64_t>(sensor.kind) << 10 | static_cast<std::uint64_t>(part);
  return {.seed = sensor.seed,
          .purpose = purpose,
          .who = static_cast<std::uint32_t>(sensor.vehicle_id),
          .which = which};
}

}  // namespace

std::string_view to_name(SensorKind kind) {
  constexpr std::array<std::string_view, kSensorKinds.size()> kNames{
      "depth", "altimeter", "log", "compass", "gyro", "dvl", "gps", "sonar", "usbl"};
  return kNames.at(static_cast<std::size_t>(kind));
}

std::int64_t sample_at(SimTime when, SimDuration period) {
  require(period > SimDuration(), "a sensor's period must be above 0");
  return (when - SimTime()).nanoseconds() / period.nanoseconds();
}

double noise_draw(const SensorIdentity& sensor, std::int64_t sample, int axis) {
  return normal_at(address_of(sensor, purpose_of("sensor-noise"), sample, axis));
}

bool drops_out(const SensorIdentity& sensor, std::int64_t sample, double probability, int part) {
  return probability > 0 &&
         uniform_at(address_of(sensor, purpose_of("sensor-dropout"), sample, part)) < probability;
}

// Wiener process W sampled once a second, linear between samples, with n = floor(t) and z_i the standard
// normal steps:
//
//   W(t) = sum over i < n of z_i + (t - n) z_n
double BiasWalk::at(SimTime when) {
  const double seconds = (when - SimTime()).seconds(), whole = std::floor(seconds);
  const auto second = static_cast<std::int64_t>(whole);
  const double here = sum_to(second);
  return here + (seconds - whole) * normal_at(address_of(sensor_, purpose_of("sensor-walk"), second, axis_));
}

double BiasWalk::sum_to(std::int64_t second) {
  if (second < second_) {
    second_ = 0;
    sum_ = 0;
  }
  for (; second_ < second; ++second_)
    sum_ += normal_at(address_of(sensor_, purpose_of("sensor-walk"), second_, axis_));
  return sum_;
}

}  // namespace halocline::vehicle_sim
