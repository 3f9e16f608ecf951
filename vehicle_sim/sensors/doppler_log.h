// SPDX-License-Identifier: BSD-3-Clause
// Sensors that send rays to the seabed: a Doppler velocity log of four beams in bottom track, and a
// forward-looking sonar.
//
// Doppler log: beam k points along b_k (unit vector, body frame) and measures the instrument's velocity over
// ground along it, s_k. The velocity is the least-squares solution over the locked beams, three or four
// (Brokloff 1994, "Matrix algorithm for Doppler sonar navigation", for the Janus geometry):
//
//   s_k = b_k . (v + omega x r) (1 + scale) + bias + noise
//   b_k . v = s_k,  least squares over k
//
// With four beams at the angle J from the instrument's axis and the noise sigma of each beam, the standard
// deviations of the velocity are
//
//   forward, starboard    sigma / (sqrt(2) sin J)
//   down                  sigma / (2 cos J)
//
// A beam is a thin ray: no footprint, no side lobes, no water track, no duration of the ping. Sonar: the echo
// of a ray is the first hit of the seabed; other hulls are not seen, and loss and clutter are not modelled.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/frames.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/sensors/sensor_errors.h"
#include "vehicle_sim/sensors/sensor_settings.h"
#include "vehicle_sim/sensors/sensors.h"

namespace halocline::vehicle_sim {

// Ray to the first hit of the seabed.
struct EchoBeam {
  Vec3 origin_ned_m = Vec3::Zero();
  Vec3 direction_ned = Vec3::UnitZ();  // unit
  double range_m = 0;                  // maximum range
};

// Beam directions, unit vectors in the body frame: those that the instrument assumes, and the actual ones.
// They differ by the misalignment.
std::array<Vec3, 4> believed_dvl_beams(const DvlSettings& dvl);
std::array<Vec3, 4> true_dvl_beams(const DvlSettings& dvl);

std::array<EchoBeam, 4> dvl_beams(const DvlSettings& dvl, const VehicleState& state);

// Returns `rays` azimuths, evenly over the sector, in ascending order; a single ray points ahead.
std::vector<double> sonar_azimuths_rad(const SonarSettings& sonar);
std::vector<EchoBeam> sonar_beams(const SonarSettings& sonar, const VehicleState& state);

struct DvlReading {
  std::array<Echo, 4> beams;  // ranges along the beams
  std::array<double, 4> beam_speed_mps = {};
  bool valid = false;                            // at least three beams are locked
  Vec3 ground_velocity_body_mps = Vec3::Zero();  // velocity of the instrument
};

// `echoes`: of the four beams, without errors. `state`: at the measurement.
DvlReading read_dvl(const DvlSettings& dvl, const SensorIdentity& sensor, std::int64_t sample,
                    const VehicleState& state, std::span<const Echo> echoes, double bias_walk_mps);

// Returns the echoes with the sonar's errors.
std::vector<Echo> read_sonar(const SonarSettings& sonar, const SensorIdentity& sensor, std::int64_t sample,
                             std::span<const Echo> echoes);

}  // namespace halocline::vehicle_sim
