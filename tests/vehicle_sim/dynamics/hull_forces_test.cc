// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/hull_forces.h"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "core/frames.h"
#include "core/random.h"
#include "tests/support/tolerance.h"
#include "vehicle_sim/dynamics/remus100_pvs.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;

Vec6 random_velocity(std::uint32_t who) {
  Vec6 nu;
  for (int k = 0; k < 6; ++k) nu[k] = 6 * uniform_at({.seed = 8, .who = who, .which = std::uint64_t(k)}) - 3;
  return nu;
}

Mat6 random_symmetric(std::uint32_t who) {
  Mat6 m;
  for (int k = 0; k < 36; ++k)
    m(k / 6, k % 6) = normal_at({.seed = 9, .who = who, .which = std::uint64_t(k)});
  return m * m.transpose();
}

double speed(const Vec6& nu) { return nu.head<3>().norm(); }

// nu . C(nu) nu = 0 for every symmetric mass: what skew symmetry of C means for motion.
TEST(HullForces, CoriolisForcesDoNoWork) {
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const Mat6 mass = random_symmetric(i);
    const Vec6 nu = random_velocity(i);
    const double scale = (mass * nu).norm() * nu.squaredNorm();
    EXPECT_NEAR(nu.dot(coriolis_force(mass, nu).vector()), 0, tolerance(1e-14) * scale);
    const Mat6 diagonal = mass.diagonal().asDiagonal();
    EXPECT_NEAR(nu.dot(roll_only_coriolis_force(diagonal, nu).vector()), 0, tolerance(1e-14) * scale);
  }
}

// A body that turns steadily about a point while its centre of gravity stays at rest needs no force there.
TEST(HullForces, CoriolisOfAPointMassIsItsCentripetalForce) {
  const double mass = 2;
  const Vec3 r(0.3, -0.1, 0.2);
  const Mat6 m = rigid_body_mass_matrix(mass, Mat3::Zero(), r);
  const Vec6 nu = random_velocity(1);
  const Vec3 v = nu.head<3>(), w = nu.tail<3>();
  const Vec3 centripetal = mass * w.cross(v + w.cross(r));
  EXPECT_LT((coriolis_force(m, nu).vector().head<3>() + centripetal).norm(), tolerance(1e-13));
  EXPECT_LT((coriolis_force(m, nu).vector().tail<3>() + r.cross(centripetal)).norm(), tolerance(1e-13));
}

TEST(HullForces, TheFullAddedMassGivesTheMunkMoment) {
  const Mat6 added = remus100_pvs_parameters(CurrentTreatment::kGalilean).added_mass;
  Vec6 nu = Vec6::Zero();
  nu << 2, 0.3, 0, 0, 0, 0;
  EXPECT_NEAR(coriolis_force(added, nu).vector()[5], -(added(1, 1) - added(0, 0)) * 2 * 0.3,
              tolerance(1e-12));
  EXPECT_EQ(roll_only_coriolis_force(added, nu).vector()[5], 0);
}

TEST(HullForces, DampingLiftDragAndCrossFlowTakeEnergy) {
  const ModelParameters p = remus100_pvs_parameters(CurrentTreatment::kUpstream);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const Vec6 nu = random_velocity(i);
    EXPECT_LT(nu.dot(damping_force(p.damping, nu, speed(nu)).vector()), 0);
    EXPECT_LT(nu.dot(lift_drag_force(p.lift_drag, 1026, nu, speed(nu)).vector()), 0);
    EXPECT_LT(nu.dot(cross_flow_force(p.cross_flow, 1026, 0.19, nu).vector()), 0);
  }
}

TEST(HullForces, DampingFallsWithSpeedOnlyWhereADecayIsGiven) {
  const Damping damping = remus100_pvs_parameters(CurrentTreatment::kUpstream).damping;
  const Vec6 ones = Vec6::Ones();
  const Vec6 slow = damping_force(damping, ones, 0).vector(), fast = damping_force(damping, ones, 1).vector();
  const double e3 = std::exp(-3);
  EXPECT_NEAR(fast[0], slow[0] * e3, tolerance(1e-15));
  EXPECT_NEAR(fast[1], slow[1] * e3, tolerance(1e-15));
  EXPECT_EQ((fast.tail<4>()), (slow.tail<4>()));
}

TEST(HullForces, LiftIsAcrossAndDragAlongTheFlow) {
  const LiftDrag l{.reference_area_m2 = 1,
                   .zero_lift_drag = 0.5,
                   .lift_slope_per_rad = 2,
                   .aspect_ratio = 1,
                   .oswald_efficiency = 1};
  Vec6 nu = Vec6::Zero();
  nu[0] = 2;
  const Vec6 straight = lift_drag_force(l, 1000, nu, 2).vector();
  EXPECT_NEAR(straight[0], -0.5 * 1000 * 4 * 0.5, tolerance(1e-10));
  EXPECT_EQ(straight[2], 0);
  nu[2] = 0.2;  // sinking: the lift pushes up, against it
  EXPECT_LT(lift_drag_force(l, 1000, nu, speed(nu)).vector()[2], 0);
}

// The sign of a zero once chose between two trajectories that part by decimetres when the flow comes from
// astern.
TEST(HullForces, BothZerosOfHeaveTakeOneBranchInReverseFlow) {
  const LiftDrag l = remus100_pvs_parameters(CurrentTreatment::kUpstream).lift_drag;
  Vec6 nu = Vec6::Zero();
  nu[0] = -1;
  const Vec6 plus = lift_drag_force(l, 1026, nu, 1).vector();
  nu[2] = -0.0;
  EXPECT_EQ(lift_drag_force(l, 1026, nu, 1).vector(), plus);
  EXPECT_GT(plus[2], 0);
}

TEST(HullForces, WaterAtRestGivesNoForce) {
  const ModelParameters p = remus100_pvs_parameters(CurrentTreatment::kUpstream);
  EXPECT_EQ(lift_drag_force(p.lift_drag, 1026, BodyVelocity(), 0).vector(), Vec6::Zero());
  EXPECT_EQ(cross_flow_force(p.cross_flow, 1026, 0.19, BodyVelocity()).vector(), Vec6::Zero());
}

// Strips of a hull that only yaws: the moment of |x r| x r over x, in closed form for many strips.
TEST(HullForces, CrossFlowTendsToTheIntegralOverTheHull) {
  const double length = 1.6, diameter = 0.19, rate = 0.7;
  const CrossFlow fine{1.1, length / 2000, 2000};
  Vec6 nu = Vec6::Zero();
  nu[5] = rate;
  // 2 int_0^{L/2} x^3 dx = L^4 / 32
  const double expected = -0.5 * 1026 * diameter * 1.1 * rate * rate * std::pow(length, 4) / 32;
  const Vec6 force = cross_flow_force(fine, 1026, diameter, nu).vector();
  EXPECT_NEAR(force[5] / expected, 1, tolerance(1e-6));  // midpoint rule: (dx/L)^2
  EXPECT_NEAR(force[1], 0, tolerance(1e-12));
}

}  // namespace
}  // namespace halocline::vehicle_sim
