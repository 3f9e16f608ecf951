// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/vehicle_sim_messages.h"

#include <utility>

#include <gtest/gtest.h>

#include "bus/messages/message_checks.h"
#include "tests/support/tolerance.h"
#include "tests/vehicle_sim/client_messages.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/sensors/sensor_errors.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;

const SimTime kWhen = SimTime::from_utime(123'456'789);

TEST(VehicleSimMessages, AStateSurvivesTheRoundTrip) {
  KinematicState state;
  state.pose = {{1, -2, 3}, to_quaternion({0.1, 0.2, 0.3})};
  state.velocity_ned_mps = {0.4, 0.5, -0.6};
  state.angular_velocity_body_radps = {0.01, 0.02, 0.03};
  const vehicle_state_t message = to_state_message(kWhen, 7, state);
  EXPECT_EQ(bus::problem_in(message), "");
  EXPECT_EQ(message.utime, 123'456'789);
  EXPECT_EQ(message.vehicle_id, 7);
  EXPECT_EQ(message.orientation_wxyz[0], state.pose.orientation.w());
  const KinematicState back = kinematics_in(message);
  EXPECT_EQ(back.pose.position_ned_m, state.pose.position_ned_m);
  EXPECT_EQ(back.pose.orientation.coeffs(), state.pose.orientation.coeffs());
  EXPECT_EQ(back.velocity_ned_mps, state.velocity_ned_mps);
  EXPECT_EQ(back.angular_velocity_body_radps, state.angular_velocity_body_radps);
}

TEST(VehicleSimMessages, ACommandSurvivesTheRoundTrip) {
  const TimedCommand command{kWhen,
                             {0.1, -0.2, 25, {10, -20, 30, -40}, 2e-4, -0.03, DropWeightState::kReleased}};
  const vehicle_command_t message = to_command_message(command);
  EXPECT_EQ(bus::problem_in(message), "");
  EXPECT_EQ(message.propeller_rpm, 1500);
  const TimedCommand back = from_message(message);
  EXPECT_EQ(back.from, kWhen);
  EXPECT_EQ(back.actuators, command.actuators);
}

TEST(VehicleSimMessages, ACurrentSurvivesTheRoundTrip) {
  CurrentSettings current;
  current.uniform_ned_mps = {0.1, 0.2, -0.05};
  current.by_depth = {{0, 0.5, 0}, {50, 0, 0.1}};
  current.tide = {0.3, 600, 1, 2};
  current.random = {0.1, 30};
  const current_change_t message = to_current_message(kWhen, current);
  EXPECT_EQ(SimTime::from_utime(message.utime), kWhen);
  EXPECT_EQ(bus::problem_in(message), "");
  const CurrentSettings back = from_message(message);
  EXPECT_EQ(back.uniform_ned_mps, current.uniform_ned_mps);
  ASSERT_EQ(back.by_depth.size(), 2u);
  EXPECT_EQ(back.by_depth[1].depth_m, 50);
  EXPECT_EQ(back.by_depth[1].east_mps, 0.1);
  EXPECT_EQ(back.tide.period_s, 600);
  EXPECT_EQ(back.tide.toward_rad, 2);
  EXPECT_EQ(back.random.time_s, 30);
}

TEST(VehicleSimMessages, SensorsAreThoseOfTheReading) {
  SensorReading r;
  r.depth_m = 12;
  r.altitude = {AltitudeStatus::kNoBottom, 0};
  r.depth_fresh = false;
  r.water_speed_mps = 1.5;
  r.attitude = {0.1, 0.2, -3};
  r.angular_velocity_body_radps = {0.1, 0.2, 0.3};
  r.actuators = {0.05, -0.05, 20};
  r.safe_state = true;
  const vehicle_sensors_t message = to_sensors_message(kWhen, r);
  EXPECT_EQ(bus::problem_in(message), "");
  EXPECT_EQ(message.depth_m, 12);
  EXPECT_EQ(message.altitude_status, vehicle_sensors_t::ALTITUDE_NO_BOTTOM);
  EXPECT_FALSE(message.depth_fresh);
  EXPECT_TRUE(message.water_speed_fresh && message.attitude_fresh && message.angular_rate_fresh);
  EXPECT_EQ(message.water_speed_mps, 1.5);
  EXPECT_EQ(message.roll_rad, 0.1);
  EXPECT_EQ(message.pitch_rad, 0.2);
  EXPECT_EQ(message.heading_rad, -3);
  EXPECT_EQ(Vec3(message.angular_rate_body_radps), r.angular_velocity_body_radps);
  EXPECT_NEAR(message.shaft_rpm, 1200, tolerance(1e-9));
  EXPECT_EQ(message.rudder_angle_rad, 0.05);
  EXPECT_TRUE(message.safe_state);
  EXPECT_FALSE(message.on_seabed);
}

TEST(VehicleSimMessages, AltitudeStatusesAreThoseOfTheWire) {
  EXPECT_EQ(static_cast<int>(AltitudeStatus::kMeasured), vehicle_sensors_t::ALTITUDE_MEASURED);
  EXPECT_EQ(static_cast<int>(AltitudeStatus::kNoBottom), vehicle_sensors_t::ALTITUDE_NO_BOTTOM);
  EXPECT_EQ(static_cast<int>(AltitudeStatus::kUnavailable), vehicle_sensors_t::ALTITUDE_UNAVAILABLE);
}

TEST(VehicleSimMessages, ARayQueryIsForTheFirstHitOfEachBeam) {
  const ray_query_t query =
      to_ray_query(kWhen, "sim-1", 42, {{{1, 2, 3}, {0, 0, 1}, 80}, {{4, 5, 6}, {0, 1, 0}, 50}});
  EXPECT_EQ(bus::problem_in(query), "");
  EXPECT_EQ(query.num_rays, 2);
  EXPECT_EQ(query.request_id, 42);
  EXPECT_EQ(query.query_mode, ray_query_t::CLOSEST_HIT);
  EXPECT_EQ(query.offset_m[1], (std::vector<double>{4, 5, 6}));
  EXPECT_EQ(query.direction[1], (std::vector<double>{0, 1, 0}));
  EXPECT_EQ(query.max_range_m, (std::vector<double>{80, 50}));
}

ray_reply_t reply_of(std::vector<std::int8_t> statuses, std::vector<double> results) {
  ray_reply_t reply{};
  reply.reply_status = ray_reply_t::OK;
  reply.num_rays = static_cast<std::int32_t>(statuses.size());
  reply.ray_status = std::move(statuses);
  reply.result_m = std::move(results);
  return reply;
}

TEST(VehicleSimMessages, EachRaysStatusBecomesAnEchosStatus) {
  const auto a =
      echoes_from(reply_of({ray_reply_t::HIT, ray_reply_t::MISS, ray_reply_t::OUTSIDE, ray_reply_t::NO_DATA,
                            ray_reply_t::BELOW_BOTTOM, ray_reply_t::BAD_INPUT},
                           {12, 0, 0, 0, 0, 0}),
                  6);
  EXPECT_EQ(a[0].status, AltitudeStatus::kMeasured);
  EXPECT_EQ(a[0].range_m, 12);
  for (const int beyond : {1, 2, 3}) EXPECT_EQ(a[beyond].status, AltitudeStatus::kNoBottom);
  EXPECT_EQ(a[4].status, AltitudeStatus::kMeasured);
  EXPECT_EQ(a[4].range_m, 0);
  EXPECT_EQ(a[5].status, AltitudeStatus::kUnavailable);
}

TEST(VehicleSimMessages, ARefusedOrShortReplyGivesNoEchoes) {
  ray_reply_t refused = reply_of({}, {});
  refused.reply_status = ray_reply_t::REFUSED_TOO_MANY;
  EXPECT_EQ(echoes_from(refused, 2)[1].status, AltitudeStatus::kUnavailable);
  EXPECT_EQ(echoes_from(reply_of({ray_reply_t::HIT}, {1}), 2)[0].status, AltitudeStatus::kUnavailable);
}

TEST(VehicleSimMessages, AFaultSurvivesTheRoundTrip) {
  const Fault fault{.from = kWhen,
                    .kind = FaultKind::kDeadSensor,
                    .mended = true,
                    .angle_rad = -0.1,
                    .leak_rate_kg_s = 0.5,
                    .leak_volume_m3 = 0.01,
                    .sensor = SensorKind::kUsbl};
  const vehicle_fault_t message = to_fault_message(fault, false);
  EXPECT_EQ(bus::problem_in(message), "");
  const Fault back = from_message(message);
  EXPECT_EQ(back.from, fault.from);
  EXPECT_EQ(back.kind, fault.kind);
  EXPECT_TRUE(back.mended);
  EXPECT_EQ(back.angle_rad, fault.angle_rad);
  EXPECT_EQ(back.leak_rate_kg_s, 0.5);
  EXPECT_EQ(back.leak_volume_m3, 0.01);
  EXPECT_EQ(back.sensor, fault.sensor);
}

TEST(VehicleSimMessages, FaultsAndSensorsAreThoseOfTheWire) {
  EXPECT_EQ(static_cast<int>(FaultKind::kStuckRudder), vehicle_fault_t::STUCK_RUDDER);
  EXPECT_EQ(static_cast<int>(FaultKind::kLeak), vehicle_fault_t::LEAK);
  EXPECT_EQ(static_cast<int>(FaultKind::kDeadSensor), vehicle_fault_t::DEAD_SENSOR);
  EXPECT_EQ(static_cast<int>(SensorKind::kDepth), vehicle_fault_t::DEPTH);
  EXPECT_EQ(static_cast<int>(SensorKind::kSpeedLog), vehicle_fault_t::WATER_SPEED_LOG);
  EXPECT_EQ(static_cast<int>(SensorKind::kUsbl), vehicle_fault_t::USBL);
  EXPECT_EQ(static_cast<int>(AltitudeStatus::kNoBottom), vehicle_dvl_t::BEAM_NO_BOTTOM);
  EXPECT_EQ(static_cast<int>(AltitudeStatus::kNoBottom), vehicle_sonar_t::ECHO_NONE);
}

TEST(VehicleSimMessages, AnArrayTakesTheTravelTimeFromWhatTheVehicleCanKnow) {
  modem_receive_t packet{};
  packet.packet_kind = modem_receive_t::PING_REPLY;
  packet.two_way_travel_time_s = 0.8;
  EXPECT_EQ(travel_time_of(packet), 0.4);
  packet.packet_kind = modem_receive_t::DATA;
  EXPECT_EQ(travel_time_of(packet), std::nullopt);
  packet.stamped = 1;
  packet.travel_time_s = 0.3;
  EXPECT_EQ(travel_time_of(packet), 0.3);
}

}  // namespace
}  // namespace halocline::vehicle_sim
