// The hover laws steering the equations of motion of `hover`.
#include "clients/autopilot/hover_laws.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/tolerance.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/dynamics/hover.h"
#include "vehicle_sim/dynamics/vehicle_state.h"

namespace halocline::clients {
namespace {

using ::halocline::testing::tolerance;
namespace vs = ::halocline::vehicle_sim;

constexpr double kStepS = 0.01, kCommandPeriodS = 0.1;

class HoverLoop {
 public:
  HoverLoop(const Vec3& target, const Vec3& current) : point_{target, 1.0} {
    water_.current_ned_mps = current;
  }

  void run(double seconds) {
    for (double t = 0; t < seconds - 1e-9; t += kCommandPeriodS) {
      const auto kinematic = to_kinematic_state(state);
      const EulerAngles euler = to_euler(state.orientation);
      const auto rpm = hover_command({}, point_,
                                     {state.position_ned_m, kinematic.velocity_ned_mps, euler.yaw,
                                      euler.pitch, state.velocity_body[4], state.velocity_body[5]},
                                     kCommandPeriodS, integrals_);
      vs::ActuatorValues command;
      for (std::size_t i = 0; i < 4; ++i) command.thruster_hz[i] = rpm[i] / 60;
      for (int i = 0; i < 10; ++i) state = rk4_step(model_, state, command, water_, kStepS);
      farthest = std::max(farthest, (state.position_ned_m - point_.position_ned_m).norm());
    }
  }

  vs::VehicleState state;
  double farthest = 0;

 private:
  vs::Model model_{vs::hover_parameters()};
  StationPoint point_;
  vs::Water water_;
  HoverIntegrals integrals_;
};

TEST(HoverLaws, GoesToAPointAndStaysThere) {
  HoverLoop loop({20, -10, 8}, Vec3::Zero());
  loop.run(300);
  loop.farthest = 0;
  loop.run(120);
  EXPECT_LT(loop.farthest, 0.5);  // a third of its length
}

class HoverInACurrent : public ::testing::TestWithParam<double> {};

TEST_P(HoverInACurrent, HoldsStationWithItsBowAgainstIt) {
  const double toward = GetParam() * std::numbers::pi / 180;
  HoverLoop loop({0, 0, 5}, 0.4 * Vec3(std::cos(toward), std::sin(toward), 0));
  loop.state.position_ned_m.z() = 5;
  loop.run(300);
  loop.farthest = 0;
  loop.run(300);
  EXPECT_LT(loop.farthest, 0.5);
  const double against =
      std::remainder(to_euler(loop.state.orientation).yaw - toward - std::numbers::pi, 2 * std::numbers::pi);
  EXPECT_NEAR(against, 0, tolerance(0.1));
}

INSTANTIATE_TEST_SUITE_P(FromAllSides, HoverInACurrent,
                         ::testing::Values(0.0, 45.0, 90.0, 135.0, 180.0, 270.0));

TEST(HoverLaws, CommandsStayWithinTheThrusters) {
  HoverIntegrals integrals;
  for (const double far : {1.0, 1e3, 1e6}) {
    const auto rpm =
        hover_command({}, {{far, far, far}, 2}, {.heading_rad = 3, .pitch_rad = 1}, 0.1, integrals);
    for (const double n : rpm) EXPECT_LE(std::abs(n), 3600);
  }
}

}  // namespace
}  // namespace halocline::clients
