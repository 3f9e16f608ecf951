// The node on memq: grids, commands, time-out, sensors with and without a bathymetry service.
#include "vehicle_sim/vehicle_sim_node.h"

#include <gtest/gtest.h>

#include "bus/lockstep_runner.h"
#include "tests/support/tolerance.h"
#include "tests/vehicle_sim/grounds.h"
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

// The bus, the node and what was heard of it.
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
    ear_.subscribe<ray_query_t>(bus::channels::kRayQuery, [this](const ray_query_t& q) { on_query(q); });
  }

  void make_node(std::shared_ptr<const Seabed> seabed = nullptr) {
    node_ = std::make_unique<VehicleSimNode>(lcm_, bus::NodeIdentity{"vehicle-sim", 77}, scenario_of_two(),
                                             config_, std::move(seabed));
  }

  // As the runner of a process does it: dispatch, then step at the instants the node asks for.
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
      const bool hit = altitude <= q.greatest_range_m[i];
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

TEST_F(VehicleSimNodeTest, FixedVehiclesSpeakAndExternalOnesDoNot) {
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

TEST_F(VehicleSimNodeTest, ACurrentHeardOnTheBusMovesTheVehicles) {
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

TEST_F(VehicleSimNodeTest, TheRayClientNamesThisLife) {
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

}  // namespace
}  // namespace halocline::vehicle_sim
