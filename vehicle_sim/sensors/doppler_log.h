// SPDX-License-Identifier: BSD-3-Clause
// A Doppler velocity log of four beams in bottom track, and a forward sonar: sensors that send rays to the
// seabed.
//
// Doppler log: beam k points along b_k (unit, body frame); its speed is the instrument's velocity over ground
// along it, s_k = b_k . (v + omega x r) (1 + scale) + bias + noise; the velocity is the least-squares
// solution of b_k . v = s_k over the locked beams, three or four (Brokloff 1994, "Matrix algorithm for
// Doppler sonar navigation", for the Janus geometry). With four beams at the angle J and noise sigma of each,
// forward and starboard have sigma / (sqrt(2) sin J), down sigma / (2 cos J). A beam is a thin ray: no
// footprint, no side lobes, no water track, no ping time. Sonar: each ray's echo is the seabed's first hit;
// other hulls are not seen, loss and clutter are not modelled.
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

// A ray to the first hit of the seabed.
struct EchoBeam {
  Vec3 origin_ned_m = Vec3::Zero();
  Vec3 direction_ned = Vec3::UnitZ();  // unit
  double range_m = 0;                  // greatest
};

// The instrument's beams, unit, body frame, by what it believes of its mounting and as they are.
std::array<Vec3, 4> believed_dvl_beams(const DvlSettings& dvl);
std::array<Vec3, 4> true_dvl_beams(const DvlSettings& dvl);

std::array<EchoBeam, 4> dvl_beams(const DvlSettings& dvl, const VehicleState& state);

// `rays` azimuths, evenly over the sector, ascending; one ray points ahead.
std::vector<double> sonar_azimuths_rad(const SonarSettings& sonar);
std::vector<EchoBeam> sonar_beams(const SonarSettings& sonar, const VehicleState& state);

struct DvlReading {
  std::array<Echo, 4> beams;  // ranges
  std::array<double, 4> beam_speed_mps = {};
  bool valid = false;                            // three beams or four
  Vec3 ground_velocity_body_mps = Vec3::Zero();  // of the instrument
};

// `echoes`: of the four beams, without errors. `state`: at the measurement.
DvlReading read_dvl(const DvlSettings& dvl, const SensorIdentity& sensor, std::int64_t sample,
                    const VehicleState& state, std::span<const Echo> echoes, double bias_walk_mps);

// Echoes with the sonar's errors.
std::vector<Echo> read_sonar(const SonarSettings& sonar, const SensorIdentity& sensor, std::int64_t sample,
                             std::span<const Echo> echoes);

}  // namespace halocline::vehicle_sim
