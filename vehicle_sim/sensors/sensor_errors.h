// SPDX-License-Identifier: BSD-3-Clause
// What a sensor gets wrong, as draws that are addressed: noise, bias that wanders, drop-outs.
//
// Model: reading = truth + bias + walk + noise. Noise is normal and independent from sample to sample and
// from axis to axis. The walk is a Wiener process (random walk of the bias), of which the standard deviation
// after t seconds is walk sqrt(t); built from one step a second of simulation time and linear between, so it
// is the same whatever the sensor's rate. A sample drops out with a probability of its own. Every draw is a
// function of (seed, vehicle, sensor, sample, axis) alone (core/random.h): neither the order, nor the thread,
// nor the process matters. Samples are counted from simulation time 0 on. Left out: correlated noise,
// quantisation, outliers, scale errors (but the Doppler log's).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/sim_time.h"

namespace halocline::vehicle_sim {

// In the order of vehicle_fault_t's DEPTH, ALTIMETER, ...
enum class SensorKind { kDepth, kAltimeter, kSpeedLog, kCompass, kGyro, kDvl, kGps, kSonar, kUsbl };

inline constexpr std::array kSensorKinds{SensorKind::kDepth,   SensorKind::kAltimeter, SensorKind::kSpeedLog,
                                         SensorKind::kCompass, SensorKind::kGyro,      SensorKind::kDvl,
                                         SensorKind::kGps,     SensorKind::kSonar,     SensorKind::kUsbl};

// "depth", "altimeter", "log", "compass", "gyro", "dvl", "gps", "sonar", "usbl": as scenarios spell them.
std::string_view to_name(SensorKind kind);

// In the sensor's own unit.
struct SensorErrors {
  double noise = 0;    // standard deviation, 0 or above
  double bias = 0;     // constant
  double walk = 0;     // of the bias, unit / sqrt(s), 0 or above
  double dropout = 0;  // probability that a sample is missing, 0 to 1

  bool operator==(const SensorErrors&) const = default;
};

// Whose sensor.
struct SensorIdentity {
  std::uint64_t seed = 1;
  std::int32_t vehicle_id = 1;
  SensorKind kind = SensorKind::kDepth;
};

// How many whole periods (above 0) lie before `when`: what a sample of a sensor with this period is addressed
// by.
std::int64_t sample_at(SimTime when, SimDuration period);

// Standard normal; `axis` 0 to 1023 (axes, beams, rays).
double noise_draw(const SensorIdentity& sensor, std::int64_t sample, int axis);
// `part` 0 to 1023: beams and rays drop out one by one.
bool drops_out(const SensorIdentity& sensor, std::int64_t sample, double probability, int part = 0);

// The walk of one axis of a sensor, for a step of 1 a second. Keeps its sum: times out of order cost time,
// nothing else.
class BiasWalk {
 public:
  BiasWalk(const SensorIdentity& sensor, int axis) : sensor_(sensor), axis_(axis) {}
  double at(SimTime when);

 private:
  double sum_to(std::int64_t second);

  SensorIdentity sensor_;
  int axis_;
  std::int64_t second_ = 0;
  double sum_ = 0;  // of the steps before second_
};

}  // namespace halocline::vehicle_sim
