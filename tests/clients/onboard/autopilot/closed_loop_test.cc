// SPDX-License-Identifier: BSD-3-Clause
// The control laws steering the equations of motion of the fin-steered vehicles: what a mission looks like in
// the water.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "clients/onboard/autopilot/control_laws.h"
#include "clients/onboard/autopilot/guidance.h"
#include "core/frames.h"
#include "tests/support/tolerance.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/model_library.h"

namespace halocline::clients {
namespace {

using ::halocline::testing::tolerance;
namespace vs = ::halocline::vehicle_sim;

constexpr double kStepS = 0.02, kCommandPeriodS = 0.1;
constexpr int kStepsPerCommand = 5;

class ClosedLoop {
 public:
  ClosedLoop(const std::string& model, Mission mission)
      : model_(vs::programmed_model(model).value()), mission_(std::move(mission)) {}

  // Runs for `seconds`; `look` sees the state after each command period.
  void run(double seconds, const std::function<void(double, const vs::VehicleState&)>& look = nullptr) {
    for (const double end = time_s_ + seconds; time_s_ < end - 1e-9; time_s_ += kCommandPeriodS) {
      one_period();
      if (look) look(time_s_ + kCommandPeriodS, state);
    }
  }

  vs::VehicleState state;
  Progress progress = begin(Vec3::Zero());

 private:
  void one_period() {
    const EulerAngles euler = to_euler(state.orientation);
    progress = advance(mission_, progress, state.position_ned_m);
    const Measured measured{
        state.position_ned_m.z(), euler.yaw, euler.pitch, state.velocity_body[4], state.velocity_body[5],
        state.velocity_body[0]};
    const ActuatorCommand c = command(Gains{}, set_points(mission_, progress, state.position_ned_m), measured,
                                      kCommandPeriodS, integrals_);
    for (int i = 0; i < kStepsPerCommand; ++i) {
      state =
          rk4_step(model_, state, {c.rudder_rad, c.stern_plane_rad, c.propeller_rpm / 60, {}}, {}, kStepS);
    }
  }

  vs::Model model_;
  Mission mission_;
  Integrals integrals_;
  double time_s_ = 0;
};

Mission straight(const Vec3& waypoint, double speed_mps) {
  Mission mission;
  mission.waypoints = {waypoint};
  mission.speed_mps = speed_mps;
  return mission;
}

class FinSteered : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(ClosedLoop, FinSteered, ::testing::Values("torpedo", "remus100-pvs"),
                         [](const auto& test) { return test.param.substr(0, test.param.find('-')); });

// Settled to 2 % of the set speed: a requirement on the pilot, not an equation.
TEST_P(FinSteered, SpeedSettlesAtTheSetPoint) {
  for (const double speed : {0.8, 2.4}) {
    ClosedLoop loop(GetParam(), straight({1e5, 0, 0}, speed));
    loop.run(120);
    EXPECT_NEAR(loop.state.velocity_body[0], speed, tolerance(0.02 * speed)) << "at " << speed;
  }
}

TEST_P(FinSteered, DepthSettlesWithoutMuchOvershoot) {
  for (const double speed : {1.2, 2.4}) {
    ClosedLoop loop(GetParam(), straight({1e5, 0, 30}, speed));
    double deepest = 0;
    loop.run(300,
             [&](double, const vs::VehicleState& s) { deepest = std::max(deepest, s.position_ned_m.z()); });
    EXPECT_NEAR(loop.state.position_ned_m.z(), 30, tolerance(0.5)) << "at " << speed;
    EXPECT_LT(deepest, 33) << "at " << speed;  // a tenth of the step
  }
}

TEST_P(FinSteered, HeadingSettlesOnTheLeg) {
  ClosedLoop loop(GetParam(), straight({0, 1e5, 10}, 2));
  loop.run(120);
  EXPECT_NEAR(to_euler(loop.state.orientation).yaw, std::numbers::pi / 2, tolerance(0.02));
  EXPECT_NEAR(loop.state.position_ned_m.x(), 0, tolerance(0.5));
}

TEST_P(FinSteered, WaypointsAreVisitedOneAfterAnother) {
  Mission mission;
  mission.waypoints = {{200, 0, 10}, {200, 200, 15}, {0, 200, 20}};
  mission.speed_mps = 2;
  ClosedLoop loop(GetParam(), mission);
  std::vector<double> closest(3, 1e9);
  loop.run(500, [&](double, const vs::VehicleState& s) {
    for (std::size_t i = 0; i < 3; ++i) {
      closest[i] = std::min(closest[i], (s.position_ned_m - mission.waypoints[i]).head<2>().norm());
    }
  });
  EXPECT_TRUE(loop.progress.at_end);
  for (const double distance : closest) EXPECT_LT(distance, 10);  // twice the acceptance radius
}

TEST_P(FinSteered, HoldCirclesTheLastWaypoint) {
  Mission mission = straight({150, 0, 10}, 1.5);
  mission.hold_radius_m = 40;
  ClosedLoop loop(GetParam(), mission);
  loop.run(300);
  double nearest = 1e9, farthest = 0;
  loop.run(300, [&](double, const vs::VehicleState& s) {
    const double distance = (s.position_ned_m - mission.waypoints[0]).head<2>().norm();
    nearest = std::min(nearest, distance);
    farthest = std::max(farthest, distance);
  });
  // The heading follows a course that turns: the circle is held to a quarter of its radius.
  EXPECT_GT(nearest, 30);
  EXPECT_LT(farthest, 50);
}

TEST_P(FinSteered, StopBringsTheVehicleToRest) {
  Mission mission = straight({60, 0, 10}, 1.5);
  mission.at_end = AtEnd::kStop;
  ClosedLoop loop(GetParam(), mission);
  loop.run(400);
  EXPECT_TRUE(loop.progress.at_end);
  EXPECT_LT(loop.state.linear_velocity_body_mps().norm(), 0.1);
}

TEST_P(FinSteered, EveryStateStaysFinite) {
  Mission mission;
  mission.waypoints = {{30, 30, 200}, {-30, 10, 0}, {5, -80, 90}};
  mission.at_end = AtEnd::kLoop;
  ClosedLoop loop(GetParam(), mission);
  loop.run(200, [](double t, const vs::VehicleState& s) { ASSERT_TRUE(is_finite(s)) << t; });
}

}  // namespace
}  // namespace halocline::clients
