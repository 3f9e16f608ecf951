// SPDX-License-Identifier: BSD-3-Clause
// Sensors that a vehicle carries, and their errors.
//
// Depth sensor, altimeter, speed log, compass and gyro are always present, by default without errors and
// sampled at each SENSORS message; each of the others is present when its period is above 0, the USBL array
// when it is fitted. Angles in radians, positions from CO in the body frame.
#pragma once

#include "core/frames.h"
#include "core/sim_time.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/sensors/sensor_errors.h"

namespace halocline::vehicle_sim {

// Settings of depth sensor (m), altimeter (m), speed log (m/s), compass (rad) or gyro (rad/s).
struct BasicSensor {
  SimDuration period = {};  // 0: at each SENSORS; else at the first SENSORS at or after each multiple
  SensorErrors errors = {};
  bool operator==(const BasicSensor&) const = default;
};

// Doppler log of four beams. Each is inclined by beam_angle from the instrument's down axis, toward 45, 135,
// 225 and 315 degrees from the instrument's forward axis, which is the vehicle's forward axis turned by
// mounting_yaw.
struct DvlSettings {
  SimDuration period = {};                     // 0: no Doppler log
  double beam_angle_rad = 0.5235987755982988;  // above 0, below pi/2
  double range_m = 100;                        // maximum along a beam
  double range_noise_m = 0;                    // standard deviation of a beam's range
  double scale_error = 0;                      // relative error of all speeds: 0.01 measures 1 % too much
  SensorErrors errors = {};                    // error of a beam's speed, m/s
  Vec3 place_m = Vec3::Zero();
  double mounting_yaw_rad = 0;  // known to the instrument, which corrects its velocity by it
  double misalignment_rad = 0;  // unknown to the instrument, in addition to mounting_yaw
  bool operator==(const DvlSettings&) const = default;
};

struct GpsSettings {
  SimDuration period = {};      // 0: no GPS
  double max_depth_m = 0.2;     // maximum depth of the antenna below the surface for a fix
  SensorErrors errors = {};     // m, for north and for east
  Vec3 place_m = Vec3::Zero();  // position of the antenna
  bool operator==(const GpsSettings&) const = default;
};

// Forward-looking sonar: rays over a sector about the forward axis, in a plane tilted down by `tilt`.
struct SonarSettings {
  SimDuration period = {};                 // 0: no sonar
  int rays = 32;                           // 1 to 512
  double sector_rad = 1.5707963267948966;  // from the first ray to the last
  double tilt_rad = 0;                     // below the forward axis
  double range_m = 50;
  SensorErrors errors = {};  // error of a ray's range, m
  Vec3 place_m = Vec3::Zero();
  bool operator==(const SonarSettings&) const = default;
};

// USBL array: bearing and elevation of the sound of received packets.
struct UsblSettings {
  bool fitted = false;
  SensorErrors errors = {};  // error of both angles, rad; no walk
  bool operator==(const UsblSettings&) const = default;
};

struct SensorSettings {
  BasicSensor depth, altimeter, log, compass, gyro;
  double tilt_noise_rad = 0;  // noise of the compass's pitch and roll; its bias and walk apply to the heading
  DvlSettings dvl;
  GpsSettings gps;
  SonarSettings sonar;
  UsblSettings usbl;
  bool operator==(const SensorSettings&) const = default;
};

}  // namespace halocline::vehicle_sim
