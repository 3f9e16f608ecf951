// SPDX-License-Identifier: BSD-3-Clause
// The published vehicle against reference motion: accelerations of random states, and whole trajectories.
#include "tests/vehicle_sim/dynamics/reference_motion.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/support/csv.h"
#include "tests/support/tolerance.h"
#include "vehicle_sim/dynamics/remus100_pvs.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::CsvRow;
using halocline::testing::read_reference_csv;
using halocline::testing::tolerance;
using testing::current_toward;
using testing::deviation_along;

constexpr double kSecondsPerMinute = 60;
constexpr int kStepsPerSecond = 100;  // 10 ms, the default of the vehicle simulator

VehicleState state_of(const CsvRow& row) {
  VehicleState s;
  s.position_ned_m = {row.number("x"), row.number("y"), row.number("z")};
  s.orientation = to_quaternion({row.number("phi"), row.number("theta"), row.number("psi")});
  s.velocity_body << row.number("u"), row.number("v"), row.number("w"), row.number("p"), row.number("q"),
      row.number("r");
  s.actuators = {row.number("act_rudder"), row.number("act_stern"),
                 row.number("act_rpm") / kSecondsPerMinute};
  return s;
}

Vec6 acceleration_of(const CsvRow& row) {
  Vec6 a;
  a << row.number("udot"), row.number("vdot"), row.number("wdot"), row.number("pdot"), row.number("qdot"),
      row.number("rdot");
  return a;
}

TEST(Remus100Pvs, AccelerationOfRandomStatesMatchesTheReference) {
  for (const CsvRow& row : read_reference_csv("vehicle/rhs_random_states.csv")) {
    ModelParameters parameters = remus100_pvs_parameters(CurrentTreatment::kUpstream);
    parameters.buoyancy_n *= row.number("B_over_W");
    const Water water{.current_ned_mps =
                          current_toward(row.number("Vc"), to_degrees(row.number("beta_rad")))};
    const Vec6 computed = acceleration(Model(parameters), state_of(row), water);
    const Vec6 expected = acceleration_of(row);
    for (int k = 0; k < 6; ++k) {
      // 1e-10 of each number; where terms cancel, of a hundredth of the unit (reference and we round terms of
      // 1e2).
      const double scale = std::max(std::abs(expected[k]), 1e-2);
      EXPECT_NEAR(computed[k], expected[k], tolerance(1e-10) * scale)
          << "line " << row.line() << ", element " << k;
    }
  }
}

struct Case {
  const char* file;
  CurrentTreatment treatment;
  double current_azimuth_deg;
  double current_mps;
};

class Remus100PvsTrajectory : public ::testing::TestWithParam<Case> {};

TEST_P(Remus100PvsTrajectory, StaysWithinAMillimetreAndAThousandthOfADegreeAtTenMilliseconds) {
  const Case& c = GetParam();
  const Model model(remus100_pvs_parameters(c.treatment));
  const Water water{.current_ned_mps = current_toward(c.current_mps, c.current_azimuth_deg)};
  const auto deviation = deviation_along(model, std::string("vehicle/") + c.file, water, kStepsPerSecond);
  EXPECT_LT(deviation.position_m, tolerance(1e-3));
  EXPECT_LT(deviation.angle_rad, tolerance(to_radians(1e-3)));
  EXPECT_LT(deviation.velocity, tolerance(1e-4));
  EXPECT_LT(deviation.actuator, tolerance(1e-6));
  RecordProperty("position_m", std::to_string(deviation.position_m));
}

constexpr auto kUpstream = CurrentTreatment::kUpstream;
constexpr auto kGalilean = CurrentTreatment::kGalilean;

INSTANTIATE_TEST_SUITE_P(
    Reference, Remus100PvsTrajectory,
    ::testing::Values(Case{"exact/a_straight_1525.csv", kUpstream, 0, 0},
                      Case{"exact/a_straight_500.csv", kUpstream, 0, 0},
                      Case{"exact/b_turn_1000_m15.csv", kUpstream, 0, 0},
                      Case{"exact/b_turn_1525_p10.csv", kUpstream, 0, 0},
                      Case{"exact/c_stern_1525_m5.csv", kUpstream, 0, 0},
                      Case{"exact/d_upstream_stepInput.csv", kUpstream, 0, 0},
                      Case{"exact/f_roll_release_20deg.csv", kUpstream, 0, 0},
                      Case{"galilean_current/e_current170_turn_1525_p10.csv", kGalilean, 170, 0.5},
                      Case{"galilean_current/e_current30_straight_1525.csv", kGalilean, 30, 0.5}),
    [](const auto& parameter) {
      std::string name = parameter.param.file;
      name = name.substr(name.find('/') + 1, name.find('.') - name.find('/') - 1);
      return name;
    });

}  // namespace
}  // namespace halocline::vehicle_sim
