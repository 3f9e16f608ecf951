// SPDX-License-Identifier: BSD-3-Clause
// Readings of a vehicle's sensors, without errors (measure) and with them (SensorSuite).
//
// The error model is that of sensor_errors.h. Left out: the positions of depth sensor, compass and altimeter
// on the hull (all measure at CO), the altimeter's beam width.
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
  kNoBottom,     // the seabed is beyond the range or the known terrain
  kUnavailable,  // not measured at this instant, or the bathymetry service did not answer
};

// Echo of a ray from the seabed.
struct Echo {
  AltitudeStatus status = AltitudeStatus::kUnavailable;
  double range_m = 0;  // 0 unless measured
};

// Readings for SENSORS. A reading that is not fresh is the last one measured.
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
  ActuatorValues actuators;  // actual positions and speeds
  bool safe_state = false;   // commands have timed out
  bool on_seabed = false;    // the hull touches the seabed

  void archive(Archive& a) {
    a(depth_fresh, depth_m, altitude, water_speed_fresh, water_speed_mps, attitude_fresh, attitude);
    a(angular_rate_fresh, angular_velocity_body_radps, actuators, safe_state, on_seabed);
  }
};

// Returns all readings except altitude, safe state and contact, which do not follow from the vehicle's state.
// `water`: the water at the vehicle, with a finite sea surface.
SensorReading measure(const Model& model, const VehicleState& state, const Water& water);

// Returns the same readings for a moored node: its pose is fixed in a current, and it has no actuators.
SensorReading measure_fixed(const VehicleState& state, const Water& water);

// Direction of the altimeter's beam: the body's down axis in the world frame, unit.
Vec3 altimeter_direction(const VehicleState& state);

// The sensors of SENSORS with their errors. It keeps the latest measurements and the bias walks. Its results
// depend on the instants of read(), in ascending order, and on nothing else.
class SensorSuite {
 public:
  using Dead = std::array<bool, kSensorKinds.size()>;  // index: SensorKind; true: measures nothing

  // `period`: interval between SENSORS messages, above 0.
  SensorSuite(const SensorSettings& settings, std::uint64_t seed, std::int32_t vehicle_id,
              SimDuration period);

  // Returns the readings with errors at `when`, given those without; the altitude is left unavailable.
  SensorReading read(const SensorReading& truth, SimTime when, const Dead& dead);

  // True when the altimeter measures at the instant of the last read(); read_altitude then returns its echo
  // with errors.
  bool altimeter_fires() const { return fires_[static_cast<std::size_t>(SensorKind::kAltimeter)]; }
  Echo read_altitude(const Echo& echo, SimTime when);

  // The bias walks are functions of time alone and need not be archived.
  void archive(Archive& a) { a(last_sample_, fires_, held_); }

 private:
  static constexpr std::size_t kBasic = 5, kWalks = 7;  // the gyro's three axes have one walk each

  const BasicSensor& sensor(SensorKind kind) const;
  SensorIdentity identity(SensorKind kind) const { return {seed_, vehicle_id_, kind}; }
  std::int64_t sample(SensorKind kind, SimTime when) const;
  [[nodiscard]] bool fires(SensorKind kind, SimTime when, bool dead);
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

// Returns true when the antenna's depth is at most `max_depth_m`, so that GPS has a fix.
bool gps_sees_sky(const GpsSettings& gps, const VehicleState& state, double sea_surface_z_m);
Eigen::Vector2d read_gps(const GpsSettings& gps, const SensorIdentity& sensor, std::int64_t sample,
                         const VehicleState& state);

// Direction from the vehicle toward a source of sound.
struct SoundDirection {
  double bearing_rad = 0;    // from the bow towards starboard about the down axis, -pi to pi
  double elevation_rad = 0;  // above the plane of the forward and starboard axes
};

// Returns the measured direction. `azimuth_rad`: true one, clockwise from north; `elevation_rad`: above the
// horizontal; `orientation`: rotation from body to world; `draw`: identity of the measurement, which
// addresses its noise.
SoundDirection read_usbl(const UsblSettings& usbl, const SensorIdentity& sensor, std::uint64_t draw,
                         double azimuth_rad, double elevation_rad, const Quaternion& orientation);

}  // namespace halocline::vehicle_sim
