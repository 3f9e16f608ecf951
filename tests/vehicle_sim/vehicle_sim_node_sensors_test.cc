// SPDX-License-Identifier: BSD-3-Clause
// The sensors of the node on memq, with and without a bathymetry service.
#include <cmath>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "core/sim_time.h"
#include "tests/support/tolerance.h"
#include "tests/vehicle_sim/vehicle_sim_node_fixture.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;

TEST_F(VehicleSimNodeTest, SensorsHoldTheAltitudeOfTheirOwnInstant) {
  make_node();
  run_until(at_ms(1000));
  ASSERT_EQ(sensors_["sub"].size(), 6u);
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_EQ(sensors_["sub"][k].utime, static_cast<std::int64_t>(k) * 200'000);
  EXPECT_EQ(sensors_["sub"].back().altitude_status, vehicle_sensors_t::ALTITUDE_MEASURED);
  EXPECT_NEAR(sensors_["sub"].back().altitude_m, 40, tolerance(1e-9));
  EXPECT_NEAR(sensors_["buoy"].back().altitude_m, 55, tolerance(1e-9));
  EXPECT_EQ(queries_, 6);  // one for all vehicles
}

TEST_F(VehicleSimNodeTest, ABottomBeyondTheRangeIsNoBottom) {
  bottom_z_ = 500;
  make_node();
  run_until(at_ms(0));
  EXPECT_EQ(sensors_["sub"].back().altitude_status, vehicle_sensors_t::ALTITUDE_NO_BOTTOM);
  EXPECT_EQ(sensors_["sub"].back().altitude_m, 0);
}

TEST_F(VehicleSimNodeTest, WithoutTheServiceSensorsGoOutAtTheDeadlineAndItRecovers) {
  service_answers_ = false;
  make_node();
  run_until(at_ms(249));
  EXPECT_TRUE(sensors_["sub"].empty());
  run_until(at_ms(250));
  ASSERT_EQ(sensors_["sub"].size(), 1u);
  EXPECT_EQ(sensors_["sub"][0].utime, 0);
  EXPECT_EQ(sensors_["sub"][0].altitude_status, vehicle_sensors_t::ALTITUDE_UNAVAILABLE);
  EXPECT_EQ(sensors_["sub"][0].depth_m, 20);
  service_answers_ = true;
  run_until(at_ms(1000));
  EXPECT_EQ(sensors_["sub"].back().utime, 1'000'000);
  EXPECT_EQ(sensors_["sub"].back().altitude_status, vehicle_sensors_t::ALTITUDE_MEASURED);
}

TEST_F(VehicleSimNodeTest, AnsweredOrNotSensorsAreSentOnceAndInOrder) {
  service_answers_ = false;
  make_node();
  run_until(at_ms(2000));
  for (std::size_t k = 0; k < sensors_["sub"].size(); ++k) {
    EXPECT_EQ(sensors_["sub"][k].sequence, static_cast<std::int64_t>(k));
    EXPECT_EQ(sensors_["sub"][k].utime, static_cast<std::int64_t>(k) * 200'000);
  }
}

TEST_F(VehicleSimNodeTest, ADopplerLogPingsOnItsOwnGrid) {
  config_.sensors.dvl.period = SimDuration::from_milliseconds(250);
  make_node();
  run_until(at_ms(0));
  command(at_ms(0), {0, 0, 20});
  run_until(at_ms(1000));
  ASSERT_EQ(pings_.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(pings_[k].utime, static_cast<std::int64_t>(k) * 250'000);
    EXPECT_EQ(pings_[k].sequence, static_cast<std::int64_t>(k));
    EXPECT_EQ(pings_[k].session, 77);
  }
  const vehicle_dvl_t& ping = pings_[4];
  EXPECT_TRUE(ping.ground_velocity_valid);
  EXPECT_NEAR(pings_[0].beam_range_m[0], 40 / std::cos(0.5235987755982988), tolerance(1e-9));  // level
  EXPECT_NEAR(ping.ground_velocity_body_mps[0], states_["sub"][10].velocity_ned_mps[0], tolerance(2e-3));
}

TEST_F(VehicleSimNodeTest, APingWithoutAnswerGoesOutUnavailable) {
  config_.sensors.dvl.period = SimDuration::from_milliseconds(1000);
  service_answers_ = false;
  make_node();
  run_until(at_ms(900));
  ASSERT_EQ(pings_.size(), 1u);
  EXPECT_EQ(pings_[0].beam_status[0], vehicle_dvl_t::BEAM_UNAVAILABLE);
  EXPECT_FALSE(pings_[0].ground_velocity_valid);
}

TEST_F(VehicleSimNodeTest, OnlyVehiclesAtTheSurfaceHaveAFix) {
  config_.sensors.gps.period = SimDuration::from_milliseconds(500);
  config_.sensors.gps.max_depth_m = 6;  // the buoy's antenna on a mast
  make_node();
  run_until(at_ms(1000));
  EXPECT_TRUE(fixes_["sub"].empty());
  ASSERT_EQ(fixes_["buoy"].size(), 3u);
  EXPECT_EQ(fixes_["buoy"][1].utime, 500'000);
  EXPECT_EQ(fixes_["buoy"][1].fix_north_m, 50);
}

TEST_F(VehicleSimNodeTest, AForwardSonarSendsItsFan) {
  config_.sensors.sonar.period = SimDuration::from_milliseconds(1000);
  config_.sensors.sonar.rays = 3;
  config_.sensors.sonar.tilt_rad = 1.5;
  make_node();
  run_until(at_ms(0));
  ASSERT_EQ(fans_.size(), 1u);
  EXPECT_EQ(fans_[0].num_fan_rays, 3);
  EXPECT_EQ(fans_[0].echo_status[1], vehicle_sonar_t::ECHO);
  EXPECT_NEAR(fans_[0].echo_range_m[1], 40 / std::sin(1.5), tolerance(1e-9));
}

TEST_F(VehicleSimNodeTest, ABearingComesOfOutcomeAndReceive) {
  config_.sensors.usbl.fitted = true;
  make_node();
  run_until(at_ms(1000));
  packet_outcome_t outcome{};
  outcome.num_receivers = 1;
  outcome.utime = 900'000;
  outcome.source_id = 9;
  outcome.receiver_id = outcome.destination_id = 3;
  outcome.packet_sequence = 4;
  outcome.departure_utime = 300'000;
  outcome.travel_time_s = 0.25;
  outcome.arrival_azimuth_rad = 0.5;
  outcome.arrival_elevation_rad = 0.25;
  modem_receive_t packet{};
  packet.utime = 900'000;
  packet.source_id = 9;
  packet.receiver_id = packet.destination_id = 3;
  packet.packet_sequence = 4;
  packet.stamped = 1;
  packet.travel_time_s = 0.25;
  ear_.publish(std::string(bus::channels::kOutcome), outcome);
  drain();
  node_->step({now_, now_});
  EXPECT_TRUE(bearings_.empty());  // the packet was not received on board
  ear_.publish(bus::channels::kReceive.of("sub"), packet);
  drain();
  node_->step({now_, now_});
  drain();
  ASSERT_EQ(bearings_.size(), 1u);
  EXPECT_EQ(bearings_[0].utime, 550'000);
  EXPECT_EQ(bearings_[0].peer_id, 9);
  EXPECT_EQ(bearings_[0].packet_sequence, 4);
  EXPECT_NEAR(bearings_[0].peer_bearing_rad, 0.5, tolerance(1e-6));  // it rests, but for its trim
  EXPECT_EQ(bearings_[0].one_way_travel_time_s, 0.25);
}

}  // namespace
}  // namespace halocline::vehicle_sim
