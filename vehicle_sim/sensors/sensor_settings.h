// SPDX-License-Identifier: BSD-3-Clause
// What sensors a vehicle carries, and how good each is.
//
// Depth, altimeter, speed log, compass and gyro are always there, by default without errors and measured at
// each SENSORS; the others are there when their period is above 0. Angles in radians, places from CO in the
// body frame.
#pragma once

#include "core/frames.h"
#include "core/sim_time.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/sensors/sensor_errors.h"

namespace halocline::vehicle_sim {

// Depth (m), altimeter (m), speed log (m/s), compass (rad), gyro (rad/s).
struct BasicSensor {
  SimDuration period = {};  // 0: at each SENSORS; else at the first SENSORS at or after its multiples
  SensorErrors errors = {};
  bool operator==(const BasicSensor&) const = default;
};

// Four beams, each leaning out of the instrument's down axis by beam_angle, towards 45, 135, 225 and 315
// degrees of the instrument's forward axis, which is the vehicle's turned by mounting_yaw.
struct DvlSettings {
  SimDuration period = {};                     // 0: none
  double beam_angle_rad = 0.5235987755982988;  // above 0, below pi/2
  double range_m = 100;                        // greatest along a beam
  double range_noise_m = 0;                    // standard deviation of a beam's range
  double scale_error = 0;                      // of all speeds: 0.01 measures 1 % too much
  SensorErrors errors = {};                    // of a beam's speed, m/s
  Vec3 place_m = Vec3::Zero();
  double mounting_yaw_rad = 0;  // known to the instrument, which turns its velocity back
  double misalignment_rad = 0;  // and not known: an error of the same kind
  bool operator==(const DvlSettings&) const = default;
};

struct GpsSettings {
  SimDuration period = {};      // 0: none
  double max_depth_m = 0.2;     // of the antenna below the surface at which it still has a fix
  SensorErrors errors = {};     // m, north and east each
  Vec3 place_m = Vec3::Zero();  // of the antenna
  bool operator==(const GpsSettings&) const = default;
};

// Rays over a sector about the forward axis, in a plane tilted down by `tilt`.
struct SonarSettings {
  SimDuration period = {};                 // 0: none
  int rays = 32;                           // 1 to 512
  double sector_rad = 1.5707963267948966;  // from the first ray to the last
  double tilt_rad = 0;                     // below the forward axis
  double range_m = 50;
  SensorErrors errors = {};  // of a ray's range, m
  Vec3 place_m = Vec3::Zero();
  bool operator==(const SonarSettings&) const = default;
};

// Bearing and elevation of the sound of received packets.
struct UsblSettings {
  bool fitted = false;
  SensorErrors errors = {};  // of both angles, rad; no walk
  bool operator==(const UsblSettings&) const = default;
};

struct SensorSettings {
  BasicSensor depth, altimeter, log, compass, gyro;
  double tilt_noise_rad = 0;  // of the compass's pitch and roll; bias and walk are the heading's alone
  DvlSettings dvl;
  GpsSettings gps;
  SonarSettings sonar;
  UsblSettings usbl;
  bool operator==(const SensorSettings&) const = default;
};

}  // namespace halocline::vehicle_sim
