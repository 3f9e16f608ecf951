// SPDX-License-Identifier: BSD-3-Clause
// What a vehicle measures of itself: the readings of its sensors, without errors (measure) and with them
// (SensorSuite).
//
// The errors are those of sensor_errors.h. Left out: the places of depth sensor, compass and altimeter on the
// hull (all measure at CO), the altimeter's beam width.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/archive.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/sensors/sensor_errors.h"
#include "vehicle_sim/sensors/sensor_settings.h"

namespace halocline::vehicle_sim {

enum class AltitudeStatus {
  kMeasured,
  kNoBottom,     // none within range, or beyond the known terrain
  kUnavailable,  // not measured at this instant, or the bathymetry service did not answer
};

// A ray's way to the seabed.
struct Echo {
  AltitudeStatus status = AltitudeStatus::kUnavailable;
  double range_m = 0;  // 0 unless measured
};

// A reading that is not fresh is the last one measured.
struct SensorReading {
  bool depth_fresh = true;
  double depth_m = 0;  // below the sea surface, positive down
  Echo altitude;       // along the body's down axis to the seabed
  bool water_speed_fresh = true;
  double water_speed_mps = 0;  // along the body's forward axis, relative to the water
  bool attitude_fresh = true;
  EulerAngles attitude;  // rad; yaw is the heading, clockwise from north, -pi to pi
  bool angular_rate_fresh = true;
  Vec3 angular_velocity_body_radps = Vec3::Zero();
  ActuatorValues actuators;  // actual
  bool safe_state = false;   // commands have timed out
  bool on_seabed = false;    // the hull touches the ground

  void archive(Archive& a) {
    a(depth_fresh, depth_m, altitude, water_speed_fresh, water_speed_mps, attitude_fresh, attitude);
    a(angular_rate_fresh, angular_velocity_body_radps, actuators, safe_state, on_seabed);
  }
};

// Everything but altitude, safe state and contact, which are not the vehicle's own to know. `water` as the
// vehicle has it; its sea surface finite.
SensorReading measure(const Model& model, const VehicleState& state, const Water& water);

// The same for a node that is moored: a pose that never changes in a current, without actuators.
SensorReading measure_fixed(const VehicleState& state, const Water& water);

// The altimeter's beam: the body's down axis in the world frame, unit.
Vec3 altimeter_direction(const VehicleState& state);

// The sensors of SENSORS with their errors. Holds what was measured last and the wandering biases; what it
// returns depends on the instants of read(), in ascending order, and on nothing else.
class SensorSuite {
 public:
  using Dead = std::array<bool, kSensorKinds.size()>;  // by SensorKind: true measures nothing

  // `period`: between SENSORS, above 0.
  SensorSuite(const SensorSettings& settings, std::uint64_t seed, std::int32_t vehicle_id,
              SimDuration period);

  // Readings with errors of the `truth` at `when`; the altitude is left unavailable.
  SensorReading read(const SensorReading& truth, SimTime when, const Dead& dead);

  // True when the altimeter measures at the instant of the last read(); and its echo then, with its errors.
  bool altimeter_fires() const { return fires_[static_cast<std::size_t>(SensorKind::kAltimeter)]; }
  Echo read_altitude(const Echo& echo, SimTime when);

  // The walks are functions of time, and not part of it.
  void archive(Archive& a) { a(last_sample_, fires_, held_); }

 private:
  static constexpr std::size_t kBasic = 5, kWalks = 7;  // the gyro's three axes have one each

  const BasicSensor& sensor(SensorKind kind) const;
  SensorIdentity identity(SensorKind kind) const { return {seed_, vehicle_id_, kind}; }
  std::int64_t sample(SensorKind kind, SimTime when) const;
  [[nodiscard]] bool fires(SensorKind kind, SimTime when, bool dead);
  // Of one axis at `when`.
  double error(SensorKind kind, SimTime when, int axis = 0);

  SensorSettings settings_;
  std::uint64_t seed_;
  std::int32_t vehicle_id_;
  SimDuration period_;
  std::array<std::int64_t, kBasic> last_sample_;
  std::array<bool, kBasic> fires_ = {};
  std::vector<BiasWalk> walks_;
  SensorReading held_;
};

// A fix of the antenna's place, north and east, with errors; the antenna at a depth of `max_depth_m` at most.
bool gps_sees_sky(const GpsSettings& gps, const VehicleState& state, double sea_surface_z_m);
Eigen::Vector2d read_gps(const GpsSettings& gps, const SensorIdentity& sensor, std::int64_t sample,
                         const VehicleState& state);

// Towards where a sound came from, seen by the vehicle.
struct SoundDirection {
  double bearing_rad = 0;    // from the bow by starboard about the down axis, -pi to pi
  double elevation_rad = 0;  // above the plane of forward and starboard
};

// `azimuth_rad` from north by east, `elevation_rad` above the horizontal; `orientation` body to world. `draw`
// names the measurement: noise is a function of it.
SoundDirection read_usbl(const UsblSettings& usbl, const SensorIdentity& sensor, std::uint64_t draw,
                         double azimuth_rad, double elevation_rad, const Quaternion& orientation);

}  // namespace halocline::vehicle_sim
