// The node on memq: grids, commands, time-out, sensors with and without a bathymetry service.
#include "vehicle_sim/vehicle_sim_node.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <gtest/gtest.h>

#include "bus/event_log.h"
#include "bus/runtime/lockstep_runner.h"
#include "tests/bus/runtime/journal_files.h"
#include "tests/support/tolerance.h"
#include "tests/vehicle_sim/world/grounds.h"
#include "vehicle_sim/dynamics/currents.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/sensors/sensor_errors.h"
#include "vehicle_sim/vehicle_sim_messages.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;

SimTime at_ms(std::int64_t ms) { return SimTime::from_utime(ms * 1000); }

bus::Scenario scenario_of_two() {
  bus::Scenario scenario;
  scenario.vehicles = {{.name = "sub", .id = 3, .start_ned_m = {0, 0, 20}},
                       {.name = "buoy", .id = 9, .model = "fixed", .start_ned_m = {50, 0, 5}},
                       {.name = "guest", .id = 4, .model = "external"}};
  return scenario;
}

// The bus, the node and what it published.
class VehicleSimNodeTest : public ::testing::Test {
 protected:
  VehicleSimNodeTest() {
    bus::set_log_level(bus::LogLevel::kSilent);
    ear_.subscribe<vehicle_state_t>(
        bus::channels::kState,
        [this](std::string_view name, const vehicle_state_t& m) { states_[std::string(name)].push_back(m); });
    ear_.subscribe<vehicle_sensors_t>(bus::channels::kSensors,
                                      [this](std::string_view name, const vehicle_sensors_t& m) {
                                        sensors_[std::string(name)].push_back(m);
                                      });
    ear_.subscribe<vehicle_dvl_t>(bus::channels::kDvl.of("sub"),
                                  [this](const vehicle_dvl_t& m) { pings_.push_back(m); });
    ear_.subscribe<vehicle_gps_t>(bus::channels::kGps, [this](std::string_view name, const vehicle_gps_t& m) {
      fixes_[std::string(name)].push_back(m);
    });
    ear_.subscribe<vehicle_sonar_t>(bus::channels::kSonar.of("sub"),
                                    [this](const vehicle_sonar_t& m) { fans_.push_back(m); });
    ear_.subscribe<vehicle_usbl_t>(bus::channels::kUsbl.of("sub"),
                                   [this](const vehicle_usbl_t& m) { bearings_.push_back(m); });
    ear_.subscribe<ray_query_t>(bus::channels::kRayQuery, [this](const ray_query_t& q) { on_query(q); });
  }

  void make_node(std::shared_ptr<const Seabed> seabed = nullptr) {
    node_ = std::make_unique<VehicleSimNode>(lcm_, bus::NodeIdentity{"vehicle-sim", 77}, scenario_of_two(),
                                             config_, std::move(seabed));
  }

  // As the runner of a process does it: dispatch, then step at the instants at which the node is due.
  void run_until(SimTime end) {
    drain();
    for (;;) {
      const bus::Due due = node_->due();
      const SimTime next = std::max(std::min(due.sim, due.steady), now_);
      if (next > end) break;
      now_ = next;
      node_->step({now_, now_});
      drain();
    }
    now_ = end;
  }
  void drain() {
    while (lcm_.handleTimeout(0) > 0) {
    }
  }

  void command(SimTime from, const ActuatorValues& actuators) {
    ear_.publish(bus::channels::kCommand.of("sub"), to_command_message({from, actuators}));
    drain();
  }

  // A service whose bottom lies at bottom_z_, straight below.
  void on_query(const ray_query_t& q) {
    ++queries_;
    last_client_ = q.client_name;
    if (!service_answers_) return;
    ray_reply_t reply{};
    reply.utime = q.utime;
    reply.session = 5;
    reply.request_id = q.request_id;
    reply.reply_status = ray_reply_t::OK;
    reply.num_rays = q.num_rays;
    for (int i = 0; i < q.num_rays; ++i) {
      const double altitude = (bottom_z_ - q.offset_m[i][2]) / q.direction[i][2];
      const bool hit = altitude <= q.max_range_m[i];
      reply.ray_status.push_back(hit ? ray_reply_t::HIT : ray_reply_t::MISS);
      reply.result_m.push_back(hit ? altitude : 0);
    }
    ear_.publish(bus::channels::kRayReply.of(q.client_name), reply);
  }

  lcm::LCM lcm_{"memq://"};
  bus::Bus ear_{lcm_, {"ear", 1}};
  VehicleSimConfig config_;
  std::unique_ptr<VehicleSimNode> node_;
  SimTime now_;
  std::map<std::string, std::vector<vehicle_state_t>> states_;
  std::map<std::string, std::vector<vehicle_sensors_t>> sensors_;
  std::vector<vehicle_dvl_t> pings_;
  std::map<std::string, std::vector<vehicle_gps_t>> fixes_;
  std::vector<vehicle_sonar_t> fans_;
  std::vector<vehicle_usbl_t> bearings_;
  bool service_answers_ = true;
  double bottom_z_ = 60;
  int queries_ = 0;
  std::string last_client_;
};

TEST_F(VehicleSimNodeTest, StatesComeExactlyOnTheGridFromTimeZero) {
  make_node();
  run_until(at_ms(1000));
  ASSERT_EQ(states_["sub"].size(), 11u);
  for (std::size_t k = 0; k < states_["sub"].size(); ++k) {
    EXPECT_EQ(states_["sub"][k].utime, static_cast<std::int64_t>(k) * 100'000);
    EXPECT_EQ(states_["sub"][k].sequence, static_cast<std::int64_t>(k));
    EXPECT_EQ(states_["sub"][k].session, 77);
    EXPECT_EQ(states_["sub"][k].vehicle_id, 3);
  }
}

TEST_F(VehicleSimNodeTest, FixedVehiclesArePublishedAndExternalOnesAreNot) {
  make_node();
  run_until(at_ms(500));
  ASSERT_EQ(states_["buoy"].size(), 6u);
  EXPECT_EQ(states_["buoy"].back().position_ned_m[0], 50);
  EXPECT_EQ(sensors_["buoy"].back().depth_m, 5);
  EXPECT_TRUE(states_["guest"].empty());
}

TEST_F(VehicleSimNodeTest, TheMotionDoesNotDependOnTheRateOfPublishing) {
  config_.state_period = SimDuration::from_milliseconds(33);
  make_node();
  run_until(at_ms(0));
  command(at_ms(0), {0.1, 0, 20});
  run_until(at_ms(990));
  const vehicle_state_t often = states_["sub"].back();
  states_.clear();
  now_ = SimTime();
  config_.state_period = SimDuration::from_milliseconds(990);
  make_node();
  run_until(at_ms(0));
  command(at_ms(0), {0.1, 0, 20});
  run_until(at_ms(990));
  const vehicle_state_t seldom = states_["sub"].back();
  ASSERT_EQ(often.utime, seldom.utime);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(often.position_ned_m[k], seldom.position_ned_m[k]);
}

TEST_F(VehicleSimNodeTest, ACommandMovesTheVehicleAndItsAbsenceStopsThePropeller) {
  make_node();
  run_until(at_ms(0));
  command(at_ms(0), {0, 0, 20});
  run_until(at_ms(2000));
  EXPECT_GT(states_["sub"].back().velocity_ned_mps[0], 0.5);
  EXPECT_FALSE(sensors_["sub"].back().safe_state);
  EXPECT_GT(sensors_["sub"].back().shaft_rpm, 1000);
  run_until(at_ms(12'000));
  EXPECT_TRUE(sensors_["sub"].back().safe_state);
  EXPECT_LT(sensors_["sub"].back().shaft_rpm, 1);
}

TEST_F(VehicleSimNodeTest, ACommandForLaterWaitsForItsTime) {
  make_node();
  run_until(at_ms(0));
  command(at_ms(500), {0, 0, 20});
  run_until(at_ms(500));
  EXPECT_EQ(states_["sub"].back().velocity_ned_mps[0], 0);
  run_until(at_ms(1000));
  EXPECT_GT(states_["sub"].back().velocity_ned_mps[0], 0);
}

TEST_F(VehicleSimNodeTest, ACommandTooOldIsCountedAndIgnored) {
  make_node();
  run_until(at_ms(5000));
  command(at_ms(1000), {0, 0, 20});
  run_until(at_ms(6000));
  EXPECT_EQ(states_["sub"].back().velocity_ned_mps[0], 0);
  EXPECT_EQ(node_->counters().late, 1);
}

TEST_F(VehicleSimNodeTest, AnImpossibleCommandIsRefused) {
  make_node();
  run_until(at_ms(0));
  command(at_ms(0), {std::nan(""), 0, 20});
  run_until(at_ms(1000));
  EXPECT_EQ(node_->counters().refused, 1);
  EXPECT_EQ(states_["sub"].back().velocity_ned_mps[0], 0);
}

TEST_F(VehicleSimNodeTest, ACurrentReceivedOnTheBusMovesTheVehicles) {
  make_node();
  run_until(at_ms(500));
  CurrentSettings east;
  east.uniform_ned_mps = {0, 0.5, 0};
  ear_.publish(bus::channels::kSetCurrent, to_current_message(at_ms(1000), east));
  drain();
  run_until(at_ms(30'000));
  EXPECT_EQ(states_["sub"][10].velocity_ned_mps[1], 0);
  EXPECT_GT(states_["sub"].back().velocity_ned_mps[1], 0.1);
}

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

TEST_F(VehicleSimNodeTest, TheRayClientNameHoldsTheSession) {
  make_node();
  run_until(at_ms(0));
  const std::string first = last_client_;
  EXPECT_TRUE(is_valid_name(first));
  node_ = std::make_unique<VehicleSimNode>(lcm_, bus::NodeIdentity{"vehicle-sim", 78}, scenario_of_two(),
                                           config_, nullptr);
  now_ = SimTime();
  run_until(at_ms(0));
  EXPECT_NE(last_client_, first);
}

TEST_F(VehicleSimNodeTest, TheSeabedIsFelt) {
  config_.buoyancy_over_weight = 0.95;
  make_node(testing::flat(21));
  run_until(at_ms(30'000));
  EXPECT_TRUE(sensors_["sub"].back().on_seabed);
  EXPECT_NEAR(states_["sub"].back().position_ned_m[2], 21 - 0.095, tolerance(2e-3));
}

TEST_F(VehicleSimNodeTest, StartedIntoARunningSimulationItJoinsOnTheGrid) {
  make_node();
  now_ = SimTime::from_utime(50'013'300);
  run_until(at_ms(51'000));
  EXPECT_EQ(states_["sub"].front().utime, 50'100'000);
  EXPECT_EQ(states_["sub"].front().position_ned_m[2], 20);
}

TEST_F(VehicleSimNodeTest, AnotherRunStartsFromTheBeginning) {
  make_node();
  run_until(at_ms(0));
  command(at_ms(0), {0, 0, 20});
  run_until(at_ms(1500));
  now_ = SimTime();
  node_->restart({now_, now_});
  states_.clear();
  node_->step({now_, at_ms(1500)});
  drain();
  ASSERT_FALSE(states_["sub"].empty());
  EXPECT_EQ(states_["sub"].front().utime, 0);
  EXPECT_EQ(states_["sub"].front().position_ned_m[0], 0);
  EXPECT_EQ(states_["sub"].front().velocity_ned_mps[0], 0);
}

TEST_F(VehicleSimNodeTest, AfterALongHaltOldStatesAreCountedNotPublished) {
  make_node();
  run_until(at_ms(100));
  states_.clear();
  node_->step({at_ms(20'000), at_ms(20'000)});
  drain();
  EXPECT_EQ(states_["sub"].front().utime, 18'000'000);
  EXPECT_EQ(states_["sub"].back().utime, 20'000'000);
  EXPECT_GT(node_->counters().late, 100);
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

TEST_F(VehicleSimNodeTest, AFaultOnTheBusBreaksAndMends) {
  make_node();
  run_until(at_ms(0));
  command(at_ms(0), {0.1, 0, 20});
  const auto publish_fault = [&](Fault fault) {
    ear_.publish(bus::channels::kFault.of("sub"), to_fault_message(fault));
    drain();
  };
  publish_fault({.from = SimTime(), .kind = FaultKind::kStuckRudder, .angle_rad = -0.05});
  publish_fault({.from = at_ms(500), .kind = FaultKind::kDeadSensor, .sensor = SensorKind::kDepth});
  run_until(at_ms(1000));
  EXPECT_NEAR(sensors_["sub"].back().rudder_angle_rad, -0.05, tolerance(1e-4));
  EXPECT_TRUE(sensors_["sub"][2].depth_fresh);
  EXPECT_FALSE(sensors_["sub"].back().depth_fresh);
  publish_fault({.from = SimTime(), .kind = FaultKind::kStuckRudder, .mended = true});
  command(at_ms(1000), {0.1, 0, 20});
  run_until(at_ms(2000));
  EXPECT_NEAR(sensors_["sub"].back().rudder_angle_rad, 0.1, tolerance(1e-4));
}

TEST_F(VehicleSimNodeTest, AFaultOfTheScenarioHoldsForItsTime) {
  Fault dead{.from = at_ms(400), .kind = FaultKind::kDeadSensor, .sensor = SensorKind::kAltimeter};
  config_.faults = {{"sub", dead, at_ms(800)}};
  make_node();
  run_until(at_ms(1000));
  const std::vector<int> measured{0, 0, 2, 2, 0, 0};
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(sensors_["sub"][k].altitude_status, measured[k]) << k;
}

TEST_F(VehicleSimNodeTest, ThePublishedBytesAreTheSameForAnyNumberOfThreads) {
  config_.buoyancy_over_weight = 0.97;
  config_.sensors.dvl.period = SimDuration::from_milliseconds(250);
  config_.sensors.dvl.errors = {.noise = 0.01, .bias = 0, .walk = 0.001, .dropout = 0.1};
  config_.sensors.gyro.errors = {.noise = 0.01, .bias = 0, .walk = 0.001, .dropout = 0.1};
  bus::Scenario crowd = scenario_of_two();
  for (int i = 0; i < 150; ++i) {
    crowd.vehicles.push_back({.name = "v" + std::to_string(i),
                              .id = 100 + i,
                              .start_ned_m = {0.5 * i, 0.3 * (i % 7), 20},
                              .heading_rad = 0.5 * i,
                              .speed_mps = 2});
  }
  config_.tethers = {{.vehicle = "v1", .to_vehicle = "v9", .length_m = 3}};
  const auto bytes_with = [&](int threads) {
    config_.threads = threads;
    states_.clear();
    pings_.clear();
    sensors_.clear();
    now_ = SimTime();
    node_ = std::make_unique<VehicleSimNode>(lcm_, bus::NodeIdentity{"vehicle-sim", 77}, crowd, config_,
                                             testing::ridge(21, 0.2));
    run_until(at_ms(5000));
    std::string bytes;
    const auto add = [&](const auto& message) {
      std::vector<char> encoded(static_cast<std::size_t>(message.getEncodedSize()));
      message.encode(encoded.data(), 0, message.getEncodedSize());
      bytes.append(encoded.begin(), encoded.end());
    };
    for (const auto& [name, states] : states_) std::for_each(states.begin(), states.end(), add);
    for (const auto& [name, sensors] : sensors_) std::for_each(sensors.begin(), sensors.end(), add);
    std::for_each(pings_.begin(), pings_.end(), add);
    return bytes;
  };
  const std::string alone = bytes_with(1);
  EXPECT_GT(alone.size(), 1'000'000u);
  EXPECT_TRUE(bytes_with(2) == alone);
  EXPECT_TRUE(bytes_with(4) == alone);
}

TEST_F(VehicleSimNodeTest, TwoRunsInLockstepPublishTheSame) {
  const auto run = [&] {
    states_.clear();
    make_node(testing::ridge(25, 0.5));
    bus::LockstepRunner runner(lcm_, {node_.get()});
    runner.run_until(at_ms(500));
    command(at_ms(600), {0.1, 0.2, 25});
    runner.run_until(at_ms(5000));
    return states_["sub"];
  };
  const auto first = run(), second = run();
  ASSERT_EQ(first.size(), 51u);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t k = 0; k < first.size(); ++k) {
    for (int c = 0; c < 3; ++c) EXPECT_EQ(first[k].position_ned_m[c], second[k].position_ned_m[c]);
  }
}

// Turns in a changed current with a leak, is killed after 3 s and comes back after `gap_ms`; 0: is never killed.
class KilledVehicleSim : public VehicleSimNodeTest {
 protected:
  void run(std::int64_t gap_ms) {
    states_.clear();
    now_ = SimTime();
    const bus::testing::JournalFiles files;
    start(files);
    run_until(at_ms(100));
    current_change_t current{};
    current.utime = 1'000'000;
    current.uniform_ned_mps[1] = 0.3;
    current.tide_period_s = 40'000;
    current.random_time_s = 600;
    ear_.publish(std::string(bus::channels::kSetCurrent), current);
    vehicle_fault_t leak{};
    leak.utime = 3'500'000;
    leak.fault_kind = vehicle_fault_t::LEAK;
    leak.leak_rate_kg_s = 0.5;
    leak.leak_volume_m3 = 0.01;
    ear_.publish(bus::channels::kFault.of("sub"), leak);
    for (const int ms : {100, 2900}) {
      run_until(at_ms(ms));
      command(at_ms(ms), {0.1, 0.05, 20});
    }
    run_until(at_ms(3000));
    if (gap_ms > 0) {
      node_.reset();
      now_ = at_ms(3000 + gap_ms);
      start(files);
    }
    run_until(at_ms(9000));
  }
  void start(const bus::testing::JournalFiles& files) {
    make_node();
    node_->enable_repair();
    node_->keep_state_in(files.open());
  }
};

// To the last bit: the time of its absence is integrated as if it had been there.
TEST_F(KilledVehicleSim, MovesAsOneThatWasNotKilled) {
  run(0);
  const auto whole = states_["sub"];
  ASSERT_EQ(whole.size(), 91u);
  EXPECT_EQ(node_->counters().refused, 0);
  run(1500);
  const auto& killed = states_["sub"];
  ASSERT_EQ(killed.size(), whole.size());
  for (std::size_t k = 0; k < whole.size(); ++k) {
    EXPECT_EQ(killed[k].utime, whole[k].utime);
    EXPECT_EQ(killed[k].sequence, whole[k].sequence);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(killed[k].position_ned_m[axis], whole[k].position_ned_m[axis]) << k;
      EXPECT_EQ(killed[k].velocity_ned_mps[axis], whole[k].velocity_ned_mps[axis]) << k;
    }
  }
}

TEST_F(KilledVehicleSim, PublishesOnlyTheLatestOfALongAbsence) {
  run(4000);
  const auto& states = states_["sub"];
  const auto after =
      std::find_if(states.begin(), states.end(), [](const auto& s) { return s.utime > 3'000'000; });
  ASSERT_NE(after, states.end());
  EXPECT_EQ(after->utime, 5'000'000);
  EXPECT_EQ(after->sequence, (after - 1)->sequence + 1);
}

TEST_F(KilledVehicleSim, ItsSensorsMeasureOnWithTheSameErrors) {
  config_.sensors.depth.errors = {.noise = 0.1, .walk = 0.1};
  const auto depths_after = [&](std::int64_t gap_ms) {
    sensors_.clear();
    run(gap_ms);
    std::vector<std::pair<std::int64_t, double>> depths;
    for (const auto& s : sensors_["sub"]) {
      if (s.utime > 5'000'000) depths.emplace_back(s.utime, s.depth_m);
    }
    return depths;
  };
  const auto whole = depths_after(0);
  EXPECT_EQ(whole.size(), 20u);
  EXPECT_EQ(depths_after(1500), whole);
}

}  // namespace
}  // namespace halocline::vehicle_sim
