// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/sensors/sensors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"
#include "core/random.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"

namespace halocline::vehicle_sim {
namespace {

using std::numbers::pi;

std::size_t index_of(SensorKind kind) { return static_cast<std::size_t>(kind); }

}  // namespace

SensorReading measure_fixed(const VehicleState& state, const Water& water) {
  SensorReading reading;
  reading.depth_m = depth_below_surface_m(state.position_ned_m, water.sea_surface_z_m);
  reading.water_speed_mps =
      state.velocity_body[0] - (state.orientation.conjugate() * water.current_ned_mps).x();
  reading.attitude = to_euler(state.orientation);
  reading.angular_velocity_body_radps = state.angular_velocity_body_radps();
  reading.actuators = state.actuators;
  return reading;
}

SensorReading measure(const Model& model, const VehicleState& state, const Water& water) {
  SensorReading reading = measure_fixed(state, water);
  reading.water_speed_mps = relative_flow(model, state, water).nu_r.u;
  return reading;
}

Vec3 altimeter_direction(const VehicleState& state) { return state.orientation * Vec3::UnitZ(); }

SensorSuite::SensorSuite(const SensorSettings& settings, std::uint64_t seed, std::int32_t vehicle_id,
                         SimDuration period)
    : settings_(settings), seed_(seed), vehicle_id_(vehicle_id), period_(period) {
  last_sample_.fill(-1);
  for (std::size_t i = 0; i < kWalks; ++i) {
    const auto kind = std::min(static_cast<SensorKind>(i), SensorKind::kGyro);
    walks_.emplace_back(identity(kind), static_cast<int>(i));
  }
  held_.depth_fresh = held_.water_speed_fresh = held_.attitude_fresh = held_.angular_rate_fresh = false;
}

const BasicSensor& SensorSuite::sensor(SensorKind kind) const {
  const BasicSensor* const all[kBasic] = {&settings_.depth, &settings_.altimeter, &settings_.log,
                                          &settings_.compass, &settings_.gyro};
  return *all[index_of(kind)];
}

std::int64_t SensorSuite::sample(SensorKind kind, SimTime when) const {
  const SimDuration own = sensor(kind).period;
  return sample_at(when, own > SimDuration() ? own : period_);
}

bool SensorSuite::fires(SensorKind kind, SimTime when, bool dead) {
  const std::int64_t now = sample(kind, when);
  const bool is_due = now != last_sample_[index_of(kind)];
  last_sample_[index_of(kind)] = now;
  const bool fires = is_due && !dead && !drops_out(identity(kind), now, sensor(kind).errors.dropout);
  fires_[index_of(kind)] = fires;
  return fires;
}

double SensorSuite::error(SensorKind kind, SimTime when, int axis) {
  const SensorErrors& e = sensor(kind).errors;
  double error = e.bias;
  if (e.walk > 0) error += e.walk * walks_[index_of(kind) + static_cast<std::size_t>(axis)].at(when);
  if (e.noise > 0) error += e.noise * noise_draw(identity(kind), sample(kind, when), axis);
  return error;
}

SensorReading SensorSuite::read(const SensorReading& truth, SimTime when, const Dead& dead) {
  const auto is_fresh = [&](SensorKind kind) { return fires(kind, when, dead[index_of(kind)]); };
  SensorReading r = truth;
  r.altitude = {};
  is_fresh(SensorKind::kAltimeter);
  r.depth_fresh = is_fresh(SensorKind::kDepth);
  r.depth_m = r.depth_fresh ? truth.depth_m + error(SensorKind::kDepth, when) : held_.depth_m;
  r.water_speed_fresh = is_fresh(SensorKind::kSpeedLog);
  r.water_speed_mps = r.water_speed_fresh ? truth.water_speed_mps + error(SensorKind::kSpeedLog, when)
                                          : held_.water_speed_mps;
  r.attitude_fresh = is_fresh(SensorKind::kCompass);
  r.attitude = held_.attitude;
  if (r.attitude_fresh) {
    const auto tilt_error = [&](int axis) {
      if (settings_.tilt_noise_rad == 0) return 0.0;
      return settings_.tilt_noise_rad *
             noise_draw(identity(SensorKind::kCompass), sample(SensorKind::kCompass, when), axis);
    };
    r.attitude = {truth.attitude.roll + tilt_error(1), truth.attitude.pitch + tilt_error(2),
                  std::remainder(truth.attitude.yaw + error(SensorKind::kCompass, when), 2 * pi)};
  }
  r.angular_rate_fresh = is_fresh(SensorKind::kGyro);
  for (int axis = 0; axis < 3; ++axis) {
    double& rate = r.angular_velocity_body_radps[axis];
    rate = r.angular_rate_fresh ? rate + error(SensorKind::kGyro, when, axis)
                                : held_.angular_velocity_body_radps[axis];
  }
  held_ = r;
  return r;
}

Echo SensorSuite::read_altitude(const Echo& echo, SimTime when) {
  if (echo.status != AltitudeStatus::kMeasured) return {echo.status, 0};
  return {echo.status, std::max(0.0, echo.range_m + error(SensorKind::kAltimeter, when))};
}

bool gps_sees_sky(const GpsSettings& gps, const VehicleState& state, double sea_surface_z_m) {
  const Vec3 antenna = state.position_ned_m + state.orientation * gps.place_m;
  return depth_below_surface_m(antenna, sea_surface_z_m) <= gps.max_depth_m;
}

Eigen::Vector2d read_gps(const GpsSettings& gps, const SensorIdentity& sensor, std::int64_t sample,
                         const VehicleState& state) {
  Eigen::Vector2d fix = (state.position_ned_m + state.orientation * gps.place_m).head<2>();
  for (int axis = 0; axis < 2; ++axis)
    fix[axis] += gps.errors.bias + gps.errors.noise * noise_draw(sensor, sample, axis);
  return fix;
}

SoundDirection read_usbl(const UsblSettings& usbl, const SensorIdentity& sensor, std::uint64_t draw,
                         double azimuth_rad, double elevation_rad, const Quaternion& orientation) {
  const double level = elementary::cos(elevation_rad);
  const Vec3 towards =
      orientation.conjugate() * Vec3(level * elementary::cos(azimuth_rad),
                                     level * elementary::sin(azimuth_rad), -elementary::sin(elevation_rad));
  const auto error = [&](std::uint64_t axis) {
    return usbl.errors.bias +
           usbl.errors.noise * normal_at({.seed = sensor.seed,
                                          .purpose = purpose_of("usbl-noise"),
                                          .who = static_cast<std::uint32_t>(sensor.vehicle_id),
                                          .which = identity_of({draw, axis})});
  };
  const double bearing = elementary::atan2(towards.y(), towards.x()) + error(0);
  const double elevation = elementary::asin(std::clamp(-towards.z(), -1.0, 1.0)) + error(1);
  return {std::remainder(bearing, 2 * pi), std::clamp(elevation, -pi / 2, pi / 2)};
}

}  // namespace halocline::vehicle_sim
