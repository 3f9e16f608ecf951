// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/autopilot_messages.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/elementary.h"
#include "core/state_extrapolation.h"

namespace halocline::clients {
namespace {

// Limits of one vehicle_plan_t message, which then takes 46 kB.
constexpr std::size_t kMaxBehavioursOfPlan = 100, kMaxWaypointsOfPlan = 1200;

// The message constants have the order of the enumerations.
static_assert(static_cast<int>(BehaviourKind::kSeekLink) == plan_behaviour_t::SEEK_LINK);
static_assert(static_cast<int>(AtEnd::kSurface) == vehicle_plan_t::SURFACE);
static_assert(static_cast<int>(Activity::kSeekingLink) == autopilot_status_t::SEEKING_LINK);
static_assert(static_cast<int>(DepthRule::kAvoidingSeabed) == autopilot_status_t::DEPTH_AVOIDING_SEABED);

plan_behaviour_t to_message(const Behaviour& behaviour, double speed_mps) {
  plan_behaviour_t message{};
  message.behaviour_kind = static_cast<std::int8_t>(behaviour.kind);
  message.set_speed_mps = speed_mps;
  message.planned_duration_s = behaviour.duration_s;
  message.planned_altitude_m = behaviour.altitude_m;
  message.planned_z_m = behaviour.depth_m;
  message.heading_rad = wrapped(behaviour.heading_rad);
  message.center_north_m = behaviour.center_north_m;
  message.center_east_m = behaviour.center_east_m;
  message.radius_m = behaviour.radius_m;
  message.is_clockwise = behaviour.sense == Sense::kClockwise ? 1 : 0;
  if (behaviour.kind == BehaviourKind::kSeekLink) message.listener_names = behaviour.search.listeners;
  if (behaviour.kind != BehaviourKind::kFollow) return message;
  message.leader_name = behaviour.formation.leader;
  message.place_ahead_m = behaviour.formation.along_m;
  message.place_starboard_m = behaviour.formation.across_m;
  message.place_below_m = behaviour.formation.below_m;
  return message;
}

}  // namespace

Situation to_situation(const vehicle_state_t& state, SimTime at) {
  const double* q = state.orientation_wxyz;
  const KinematicState now =
      reckoned({{Vec3(state.position_ned_m), Quaternion(q[0], q[1], q[2], q[3]).normalized()},
                Vec3(state.velocity_ned_mps),
                Vec3(state.angular_velocity_body_radps)},
               at - SimTime::from_utime(state.utime));
  Situation situation;
  situation.time_s = at.seconds();
  situation.position_ned_m = now.pose.position_ned_m;
  situation.velocity_ned_mps = now.velocity_ned_mps;
  situation.attitude = to_euler(now.pose.orientation);
  situation.pitch_rate_radps = now.angular_velocity_body_radps.y();
  situation.yaw_rate_radps = now.angular_velocity_body_radps.z();
  situation.water_speed_mps = (now.pose.orientation.conjugate() * now.velocity_ned_mps).x();
  return situation;
}

Situation to_situation(const vehicle_sensors_t& sensors, const Navigator& navigator, double time_s) {
  Situation situation;
  situation.time_s = time_s;
  situation.position_ned_m = navigator.position_ned_m(time_s);
  situation.velocity_ned_mps = navigator.velocity_ned_mps();
  situation.attitude = navigator.has_sample()
                           ? navigator.last().attitude
                           : EulerAngles{sensors.roll_rad, sensors.pitch_rad, sensors.heading_rad};
  situation.pitch_rate_radps = sensors.angular_rate_body_radps[1];
  situation.yaw_rate_radps = sensors.angular_rate_body_radps[2];
  situation.water_speed_mps = sensors.water_speed_mps;
  return situation;
}

AttitudeReading to_attitude_reading(const vehicle_sensors_t& sensors) {
  AttitudeReading reading{.time_s = SimTime::from_utime(sensors.utime).seconds()};
  const double* rates = sensors.angular_rate_body_radps;
  if (sensors.attitude_fresh)
    reading.attitude = EulerAngles{sensors.roll_rad, sensors.pitch_rad, sensors.heading_rad};
  if (sensors.angular_rate_fresh) reading.rates_radps = Vec3(rates[0], rates[1], rates[2]);
  return reading;
}

NavigationSample to_navigation_sample(const vehicle_sensors_t& sensors, const AttitudeKeeper& attitude,
                                      const std::optional<vehicle_dvl_t>& ping) {
  NavigationSample sample{.time_s = SimTime::from_utime(sensors.utime).seconds(),
                          .attitude = attitude.attitude(),
                          .depth_m = sensors.depth_m,
                          .water_speed_mps = sensors.water_speed_mps,
                          .heading_deviation_rad = attitude.heading_deviation_rad()};
  if (ping) {
    const double* v = ping->ground_velocity_body_mps;
    sample.ground_velocity_body_mps = Vec3(v[0], v[1], v[2]);
  }
  return sample;
}

void take_in(const vehicle_gps_t& fix, Navigator& navigator) {
  constexpr double kMinDeviationM = 0.01;
  navigator.fix(fix.fix_north_m, fix.fix_east_m, std::max(fix.fix_deviation_m, kMinDeviationM),
                SimTime::from_utime(fix.utime).seconds());
}

void take_in(const vehicle_usbl_t& bearing, const std::map<std::int32_t, Vec3>& beacons,
             const AcousticFixRules& rules, Navigator& navigator) {
  const double time_s = SimTime::from_utime(bearing.utime).seconds();
  const auto beacon = beacons.find(bearing.peer_id);
  const auto then = navigator.at(time_s);
  if (beacon == beacons.end() || !then || !bearing.travel_time_known) return;
  const BeaconMeasurement measured{bearing.peer_bearing_rad, bearing.peer_elevation_rad,
                                   bearing.angle_deviation_rad, bearing.one_way_travel_time_s};
  const auto fix = place_by_beacon(rules, beacon->second, measured, then->attitude, then->position_ned_m.z());
  if (fix) navigator.fix(fix->north_m, fix->east_m, fix->deviation_m, time_s);
}

void take_in(const position_estimate_t& estimate, Navigator& navigator) {
  if (estimate.estimate_status != position_estimate_t::UNIQUE || !navigator.has_sample()) return;
  const double age_s = navigator.last().time_s - SimTime::from_utime(estimate.utime).seconds();
  const Vec3 way = age_s * navigator.velocity_ned_mps();
  const double variance_m2 = 0.5 * (estimate.covariance_ned_m2[0] + estimate.covariance_ned_m2[4]);
  navigator.replace(estimate.position_ned_m[0] + way.x(), estimate.position_ned_m[1] + way.y(),
                    std::sqrt(std::max(variance_m2, 0.0)));
}

LeaderReport to_report(const Situation& situation) {
  const Vec3& velocity = situation.velocity_ned_mps;
  const double speed = velocity.head<2>().norm();
  // The course over ground is undefined at rest; the heading is reported instead.
  const double course = speed > 0.05 ? elementary::atan2(velocity.y(), velocity.x()) : situation.attitude.yaw;
  return {situation.position_ned_m, course, speed, situation.time_s};
}

AltimeterSample to_altimeter_sample(const vehicle_sensors_t& sensors, const Situation& situation) {
  const double time_s = SimTime::from_utime(sensors.utime).seconds();
  return {
      .time_s = time_s,
      .position_ned_m = situation.position_ned_m + (time_s - situation.time_s) * situation.velocity_ned_mps,
      .attitude = situation.attitude,
      .has_echo = sensors.altitude_status == vehicle_sensors_t::ALTITUDE_MEASURED,
      .altitude_m = sensors.altitude_m};
}

vehicle_command_t to_message(const std::array<double, 4>& thruster_rpm) {
  vehicle_command_t message{};
  std::copy(thruster_rpm.begin(), thruster_rpm.end(), message.thruster_rpm);
  return message;
}

vehicle_command_t to_message(const ActuatorCommand& command) {
  vehicle_command_t message{};
  message.propeller_rpm = command.propeller_rpm;
  message.rudder_rad = command.rudder_rad;
  message.stern_plane_rad = command.stern_plane_rad;
  message.buoyancy_m3 = command.buoyancy_m3;
  message.moving_mass_m = command.moving_mass_m;
  return message;
}

vehicle_plan_t to_message(const Plan& plan, const PlanProgress& progress, const PilotConfig& config) {
  vehicle_plan_t message{};
  message.at_end = static_cast<std::int8_t>(plan.at_end);
  message.by_thrusters = config.steering == Steering::kThrusters ? 1 : 0;
  message.acceptance_radius_m = config.mission.acceptance_radius_m;
  message.hold_radius_m = plan.hold_radius_m;
  message.min_altitude_m = config.mission.min_altitude_m;
  message.behaviour_index = static_cast<std::int32_t>(progress.index);
  message.waypoint_index = static_cast<std::int32_t>(progress.route.target);
  message.plan_ended = progress.ended || progress.route.at_end ? 1 : 0;
  for (std::size_t i = 0; i < plan.behaviours.size(); ++i) {
    if (i >= kMaxBehavioursOfPlan) {
      ++message.behaviours_left_out;
    } else {
      message.behaviours.push_back(to_message(plan.behaviours[i], plan.routes[i].speed_mps));
    }
    for (const Vec3& waypoint : plan.routes[i].waypoints) {
      if (i >= kMaxBehavioursOfPlan || message.waypoint_ned_m.size() >= kMaxWaypointsOfPlan) {
        ++message.waypoints_left_out;
        continue;
      }
      message.waypoint_behaviour.push_back(static_cast<std::int32_t>(i));
      message.waypoint_ned_m.push_back({waypoint.x(), waypoint.y(), waypoint.z()});
    }
  }
  message.num_behaviours = static_cast<std::int32_t>(message.behaviours.size());
  message.num_waypoints = static_cast<std::int32_t>(message.waypoint_ned_m.size());
  return message;
}

autopilot_status_t to_message(Activity activity, const PlanProgress& progress,
                              const std::optional<SetPoints>& points) {
  autopilot_status_t message{};
  message.autopilot_activity = static_cast<std::int8_t>(activity);
  message.behaviour_index = static_cast<std::int32_t>(progress.index);
  message.waypoint_index = static_cast<std::int32_t>(progress.route.target);
  if (!points) return message;
  message.depth_rule = static_cast<std::int8_t>(points->depth_rule);
  message.is_propelled = points->propel ? 1 : 0;
  message.commanded_z_m = points->z_ned_m;
  message.commanded_course_rad = wrapped(points->course_rad);
  message.commanded_speed_mps = points->speed_mps;
  return message;
}

}  // namespace halocline::clients
