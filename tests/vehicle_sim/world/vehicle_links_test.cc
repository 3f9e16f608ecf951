// SPDX-License-Identifier: BSD-3-Clause
// Vehicles that meet, and vehicles that tow: nothing passes through, momentum stays, ropes hold.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/check.h"
#include "core/frames.h"
#include "core/units.h"
#include "tests/support/tolerance.h"
#include "tests/vehicle_sim/world/grounds.h"
#include "vehicle_sim/dynamics/body_motion.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/model_library.h"
#include "vehicle_sim/world/neighbours.h"
#include "vehicle_sim/world/vehicle_contact.h"
#include "vehicle_sim/world/vehicle_world.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;

constexpr double kMaxPenetration = 0.02;  // m, the project's bound

std::shared_ptr<const Model> torpedo() {
  return std::make_shared<const Model>(programmed_model("torpedo").value());
}

// A hull in an ideal fluid: added mass, no drag, centres of gravity and buoyancy in one point.
std::shared_ptr<const Model> ideal() {
  ModelParameters p = programmed_model("torpedo").value();
  p.buoyancy_n = p.mass_kg * p.gravity_m_s2;
  p.center_of_gravity_m = p.center_of_buoyancy_m = Vec3::Zero();
  p.damping = {};
  p.lift_drag = {};
  p.body_lift = {};
  p.cross_flow = {};
  p.rudder = p.stern_planes = {};
  p.propeller = {};
  return std::make_shared<const Model>(p);
}

VehicleState at(const Vec3& position, double yaw = 0, double forward = 0, double pitch = 0) {
  VehicleState s;
  s.position_ned_m = position;
  s.orientation = to_quaternion({0, pitch, yaw});
  s.velocity_body[0] = forward;
  return s;
}

HullPose pose(const HullShape& hull, const VehicleState& s) {
  return {hull, s.position_ned_m, s.orientation * Vec3::UnitX()};
}

double min_gap(const VehicleWorld& world, std::size_t a, std::size_t b) {
  std::vector<VehicleContact> found;
  find_vehicle_contacts(pose(world.model(a).parameters().hull, world.state(a)),
                        pose(world.model(b).parameters().hull, world.state(b)), 1, found);
  double least = 1;
  for (const VehicleContact& c : found) least = std::min(least, c.gap_m);
  return least;
}

TEST(VehicleContact, TheGapOfSpheresIsTheDistanceOfTheirCentresLessTheirRadii) {
  std::vector<VehicleContact> found;
  const HullPose one{{2, 2}, {0, 0, 0}, Vec3::UnitX()}, other{{1, 1}, {0, 3, 4}, Vec3::UnitZ()};
  find_vehicle_contacts(one, other, 4, found);
  ASSERT_EQ(found.size(), 3u);  // of the middle third, and of what lies beside it
  EXPECT_NEAR(found[1].gap_m, 5 - 1.5, tolerance(1e-6));
  EXPECT_LT((found[1].normal_ned - Vec3(0, -0.6, -0.8)).norm(), tolerance(1e-6));
}

TEST(VehicleContact, SpheroidsTouchWithTheirTipsAndTheirFlanks) {
  const HullShape hull{1.6, 0.2};
  const auto gap = [&](const VehicleState& a, const VehicleState& b) {
    std::vector<VehicleContact> found;
    find_vehicle_contacts(pose(hull, a), pose(hull, b), 2, found);
    double least = 2;
    for (const VehicleContact& c : found) least = std::min(least, c.gap_m);
    return least;
  };
  EXPECT_NEAR(gap(at({0, 0, 0}), at({2, 0, 0})), 0.4, tolerance(1e-4));                        // tip to tip
  EXPECT_NEAR(gap(at({0, 0, 0}), at({0, 0, 1})), 0.8, tolerance(1e-4));                        // side by side
  EXPECT_NEAR(gap(at({0, 0, 0}), at({0, 1, 0}, std::numbers::pi / 2)), 0.1, tolerance(1e-4));  // tip to flank
}

TEST(VehicleContact, TheNormalPointsToTheFirstWhicheverThatIs) {
  const HullShape hull{1.6, 0.2};
  std::vector<VehicleContact> found;
  find_vehicle_contacts(pose(hull, at({0, 0, 0})), pose(hull, at({0, 0, 0.3})), 1, found);
  ASSERT_FALSE(found.empty());
  EXPECT_LT(found[0].normal_ned.z(), -0.99);
}

TEST(Neighbours, EveryPairWithinReachIsThereWhereverTheyMove) {
  Neighbours neighbours;
  std::vector<Vec3> positions;
  for (int i = 0; i < 60; ++i)
    positions.emplace_back(std::fmod(i * 7.3, 31) - 15, std::fmod(i * 3.7, 29), i % 5);
  for (int step = 0; step < 200; ++step) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const double turn = static_cast<double>(i);
      positions[i] += 0.1 * Vec3(std::cos(turn), std::sin(turn), 0.3 * std::cos(2 * turn));
    }
    const auto& pairs = neighbours.within(3, positions);
    ASSERT_TRUE(std::is_sorted(pairs.begin(), pairs.end()));
    for (std::size_t i = 0; i < positions.size(); ++i) {
      for (std::size_t k = i + 1; k < positions.size(); ++k) {
        if ((positions[i] - positions[k]).norm() <= 3) {
          ASSERT_TRUE(std::binary_search(pairs.begin(), pairs.end(), Neighbours::Pair(i, k)))
              << i << " " << k;
        }
      }
    }
  }
}

class Meeting : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(AtStep, Meeting, ::testing::Values(0.005, 0.01, 0.02), [](const auto& step) {
  return std::to_string(std::lround(step.param * 1000)) + "ms";
});

struct Encounter {
  const char* name;
  VehicleState first, second;
};

std::vector<Encounter> encounters() {
  return {{"head on", at({0, 0, 50}, 0, 2.5), at({4, 0, 50}, std::numbers::pi, 2.5)},
          {"head on, a little aside", at({0, 0, 50}, 0, 2.5), at({4, 0.1, 50.03}, std::numbers::pi, 2.5)},
          {"into the side", at({0, 0, 50}, 0, 2.5), at({3, 0.2, 50}, std::numbers::pi / 2, 0)},
          {"overtaken askew", at({0, 0, 50}, 0.2, 2.5), at({2, 0.3, 50}, 0, 1)},
          {"from above", at({0, 0, 48}, 0, 2, -1.2), at({0.9, 0.03, 50}, 1, 0)}};
}

// Momentum of all vehicles and the water that they carry along, with its moment about the world's origin.
Impulse together(const VehicleWorld& world) {
  Impulse sum;
  for (std::size_t i = 0; i < world.size(); ++i) {
    const VehicleState& state = world.state(i);
    const Vec6 momentum = world.model(i).mass() * state.velocity_body;
    const Vec3 linear = state.orientation * Vec3(momentum.head<3>());
    sum.linear += linear;
    sum.moment += state.orientation * Vec3(momentum.tail<3>()) + state.position_ned_m.cross(linear);
  }
  return sum;
}

double energy(const VehicleWorld& world) {
  double sum = 0;
  for (std::size_t i = 0; i < world.size(); ++i)
    sum += 0.5 * world.state(i).velocity_body.dot(world.model(i).mass() * world.state(i).velocity_body);
  return sum;
}

// Momentum of vehicles and water in an ideal fluid. The tolerance is that of the free motion between the
// blows: the collision itself keeps it to rounding.
TEST_P(Meeting, MomentumIsConservedAndEnergyNotGained) {
  for (const Encounter& e : encounters()) {
    VehicleWorld world(nullptr);
    world.add(ideal(), e.first);
    world.add(ideal(), e.second);
    const Impulse before = together(world);
    const double energy_before = energy(world);
    bool met = false;
    for (long i = 0; i < std::lround(4 / GetParam()); ++i) {
      world.step(GetParam());
      met = met || world.touches_vehicle(0);
      ASSERT_LT(energy(world), energy_before * (1 + tolerance(1e-3))) << e.name;
    }
    const Impulse after = together(world);
    EXPECT_TRUE(met) << e.name;
    EXPECT_LT((after.linear - before.linear).norm(), tolerance(1e-4) * 100) << e.name;   // of 100 N s
    EXPECT_LT((after.moment - before.moment).norm(), tolerance(1e-4) * 5000) << e.name;  // of 50 m times that
  }
}

TEST_P(Meeting, TwoThatMeetDoNotPassThroughEachOther) {
  for (const Encounter& e : encounters()) {
    for (const auto& model : {ideal(), torpedo()}) {
      VehicleWorld world(nullptr);
      world.add(model, e.first);
      world.add(model, e.second);
      for (const std::size_t i : {0, 1}) world.set_command(i, {0, 0, 20});
      bool met = false;
      for (long i = 0; i < std::lround(10 / GetParam()); ++i) {
        world.step(GetParam());
        met = met || world.touches_vehicle(0);
        ASSERT_FALSE(world.has_diverged(0) || world.has_diverged(1)) << e.name;
        ASSERT_GT(min_gap(world, 0, 1), -tolerance(kMaxPenetration)) << e.name << " at step " << i;
      }
      EXPECT_TRUE(met) << e.name;
    }
  }
}

TEST_P(Meeting, AVehicleThatSinksOntoOneOnTheGroundIsHeldByIt) {
  ModelParameters heavy = programmed_model("torpedo").value();
  heavy.buoyancy_n *= 0.97;
  const auto model = std::make_shared<const Model>(heavy);
  VehicleWorld world(testing::flat(10));
  world.add(model, at({0, 0, 9.9}));
  world.add(model, at({0.05, 0, 9.5}, std::numbers::pi / 2));  // across the first
  for (long i = 0; i < std::lround(20 / GetParam()); ++i) {
    world.step(GetParam());
    ASSERT_GT(min_gap(world, 0, 1), -tolerance(kMaxPenetration));
  }
  EXPECT_FALSE(world.has_diverged(0) || world.has_diverged(1));
}

TEST(VehicleLinks, TheSameEncounterGivesTheSameBytesAmongOthers) {
  const auto run = [](int bystanders) {
    VehicleWorld world(nullptr);
    for (const VehicleState& s : {encounters()[2].first, encounters()[2].second}) world.add(torpedo(), s);
    for (int i = 0; i < bystanders; ++i) world.add(torpedo(), at({0, 20.0 + 5 * i, 50}));
    for (int i = 0; i < 500; ++i) world.step(0.01);
    return world.state(0);
  };
  const VehicleState alone = run(0), among = run(9);
  EXPECT_EQ(alone.position_ned_m, among.position_ned_m);
  EXPECT_EQ(alone.velocity_body, among.velocity_body);
}

class Towing : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(AtStep, Towing, ::testing::Values(0.005, 0.01, 0.02), [](const auto& step) {
  return std::to_string(std::lround(step.param * 1000)) + "ms";
});

// Surge acceleration times mass: the force along the hull at a steady speed.
double surge_force(const Model& model, double speed, double propeller_hz) {
  VehicleState s = at({0, 0, 50}, 0, speed);
  s.actuators.propeller_hz = propeller_hz;
  return (model.mass() * acceleration(model, s, {}))[0];
}

double speed_where_forces_balance(const Model& model, double propeller_hz, int towed) {
  double slow = 0, fast = 10;
  for (int i = 0; i < 60; ++i) {
    const double speed = (slow + fast) / 2;
    const double force = surge_force(model, speed, propeller_hz) + towed * surge_force(model, speed, 0);
    (force > 0 ? slow : fast) = speed;
  }
  return slow;
}

TEST_P(Towing, ATetherHoldsAndSlowsTheTugByTheTowedDrag) {
  const auto model = torpedo();
  const double half = model->parameters().hull.length_m / 2, length = 10, turns = 20;
  VehicleWorld world(nullptr);
  world.add(model, at({0, 0, 50}));
  world.add(model, at({-8, 0.5, 50}));
  const std::size_t rope = world.add(Tether{0, {-half, 0, 0}, 1, {half, 0, 0}, length});
  world.set_command(0, {0, 0, turns});
  double longest = 0;
  for (long i = 0; i < std::lround(120 / GetParam()); ++i) {
    world.step(GetParam());
    longest = std::max(longest, world.tether_distance_m(rope));
  }
  EXPECT_LT(longest, length + tolerance(0.01));
  EXPECT_GT(world.tether_distance_m(rope), length - tolerance(0.01));
  const double expected = speed_where_forces_balance(*model, turns, 1);
  EXPECT_LT(expected, 0.95 * speed_where_forces_balance(*model, turns, 0));
  EXPECT_NEAR(world.state(0).velocity_body.head<3>().norm(), expected, tolerance(0.01) * expected);
  const double drag = -surge_force(*model, expected, 0);
  RecordProperty("pull_error_percent", std::to_string(100 * std::abs(world.tether_pull_n(rope) / drag - 1)));
  EXPECT_NEAR(world.tether_pull_n(rope), drag, tolerance(0.03) * drag);
}

TEST_P(Towing, ASlackTetherDoesNothing) {
  const auto model = torpedo();
  VehicleWorld tied(nullptr), free(nullptr);
  for (VehicleWorld* world : {&tied, &free}) world->add(model, at({0, 0, 50}, 0.3, 1));
  tied.add(Tether{0, {}, {}, {0, 0, 50}, 20});
  for (int i = 0; i < 500; ++i) {
    tied.step(GetParam());
    free.step(GetParam());
  }
  EXPECT_EQ(tied.state(0).position_ned_m, free.state(0).position_ned_m);
  EXPECT_EQ(tied.tether_pull_n(0), 0);
}

TEST_P(Towing, AVehicleOnAMooringStaysWithinItsLength) {
  const auto model = torpedo();
  VehicleWorld world(nullptr);
  world.add(model, at({0, 0, 50}, 0.4, 2));
  const Vec3 anchor(0, 2, 53);
  const std::size_t rope = world.add(Tether{0, {0.8, 0, 0}, {}, anchor, 6});
  world.set_command(0, {0.1, 0, 25});
  double longest = 0;
  for (long i = 0; i < std::lround(60 / GetParam()); ++i) {
    world.step(GetParam());
    longest = std::max(longest, world.tether_distance_m(rope));
  }
  EXPECT_GT(longest, 5.9);
  EXPECT_LT(longest, 6 + tolerance(0.01));
  EXPECT_FALSE(world.has_diverged(0));
}

TEST(VehicleLinks, WhatIsImpossibleIsRefused) {
  VehicleWorld world(nullptr);
  world.add(torpedo(), at({0, 0, 50}));
  const auto tied = [](std::size_t vehicle, std::optional<std::size_t> to, double length) {
    return Tether{vehicle, Vec3::Zero(), to, Vec3::Zero(), length};
  };
  EXPECT_THROW(world.add(tied(1, {}, 1)), InvalidArgument);
  EXPECT_THROW(world.add(tied(0, 0, 1)), InvalidArgument);
  EXPECT_THROW(world.add(tied(0, 5, 1)), InvalidArgument);
  EXPECT_THROW(world.add(tied(0, {}, 0)), InvalidArgument);
}

}  // namespace
}  // namespace halocline::vehicle_sim
