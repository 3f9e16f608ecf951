// SPDX-License-Identifier: BSD-3-Clause
// Errors of a sensor as addressed random draws: noise, a wandering bias, drop-outs.
//
// Model:
//
//   reading = truth + bias + walk + noise
//
// Noise is normal and independent between samples and between axes. The walk is a Wiener process (random walk
// of the bias) with the standard deviation walk sqrt(t) after t seconds. It has one step a second of
// simulation time and is linear between steps, so it does not depend on the sensor's rate. A sample drops out
// with a given probability. Every draw is a function of (seed, vehicle, sensor, sample, axis) alone
// (core/random.h), so it depends on neither order nor thread nor process. Samples are counted from simulation
// time 0 on. Left out: correlated noise, quantisation, outliers, scale errors (except that of the Doppler
// log).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/sim_time.h"

namespace halocline::vehicle_sim {

// The order is that of the constants in vehicle_fault_t: DEPTH, ALTIMETER, ...
enum class SensorKind { kDepth, kAltimeter, kSpeedLog, kCompass, kGyro, kDvl, kGps, kSonar, kUsbl };

inline constexpr std::array kSensorKinds{SensorKind::kDepth,   SensorKind::kAltimeter, SensorKind::kSpeedLog,
                                         SensorKind::kCompass, SensorKind::kGyro,      SensorKind::kDvl,
                                         SensorKind::kGps,     SensorKind::kSonar,     SensorKind::kUsbl};

// Returns the name in scenarios: "depth", "altimeter", "log", "compass", "gyro", "dvl", "gps", "sonar",
// "usbl".
std::string_view to_name(SensorKind kind);

// Errors in the sensor's own unit.
struct SensorErrors {
  double noise = 0;    // standard deviation, 0 or above
  double bias = 0;     // constant
  double walk = 0;     // random walk of the bias, unit / sqrt(s), 0 or above
  double dropout = 0;  // probability that a sample is missing, 0 to 1

  bool operator==(const SensorErrors&) const = default;
};

// Identity of one sensor of one vehicle, which addresses its draws.
struct SensorIdentity {
  std::uint64_t seed = 1;
  std::int32_t vehicle_id = 1;
  SensorKind kind = SensorKind::kDepth;
};

// Returns the number of whole periods (above 0) before `when`, which addresses the sample of a sensor with
// this period.
std::int64_t sample_at(SimTime when, SimDuration period);

// Returns a standard normal draw; `axis` 0 to 1023 (axes, beams, rays).
double noise_draw(const SensorIdentity& sensor, std::int64_t sample, int axis);
// Returns true when the sample drops out. `part` 0 to 1023: beams and rays drop out independently.
bool drops_out(const SensorIdentity& sensor, std::int64_t sample, double probability, int part = 0);

// Bias walk of one axis of a sensor, with a step of standard deviation 1 each second. It keeps the latest
// sum, so times in descending order are slower but give the same values.
class BiasWalk {
 public:
  BiasWalk(const SensorIdentity& sensor, int axis) : sensor_(sensor), axis_(axis) {}
  double at(SimTime when);

 private:
  double sum_to(std::int64_t second);

  SensorIdentity sensor_;
  int axis_;
  std::int64_t second_ = 0;
  double sum_ = 0;  // sum of the steps before second_
};

}  // namespace halocline::vehicle_sim
