// SPDX-License-Identifier: BSD-3-Clause
// That a world moves the same, bit by bit, however many threads share its step.
#include <cstring>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/for_each.h"
#include "tests/vehicle_sim/world/formula_seabed.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/model_library.h"
#include "vehicle_sim/world/vehicle_world.h"

namespace halocline::vehicle_sim {
namespace {

// Every thread takes each n-th turn.
ForEach with_threads(std::size_t threads) {
  return [threads](std::size_t count, const std::function<void(std::size_t)>& body) {
    std::vector<std::thread> pool;
    for (std::size_t t = 0; t < threads; ++t) {
      pool.emplace_back([&, t] {
        for (std::size_t i = t; i < count; i += threads) body(i);
      });
    }
    for (std::thread& thread : pool) thread.join();
  };
}

struct Outcome {
  std::vector<double> numbers;
  int touched = 0, grounded = 0, pulled = 0;
};

// 60 groups of three heavy vehicles that run across each other over a ridge, two of each tied: all kinds of
// contact at once.
Outcome crowd(const ForEach& for_each) {
  VehicleWorld world(testing::ridge(20.7, 0.01), 0.5, for_each);
  ModelParameters p = *programmed_model("torpedo");
  p.buoyancy_n *= 0.95;
  const auto model = std::make_shared<const Model>(p);
  for (int i = 0; i < 180; ++i) {
    const int group = i / 3;
    VehicleState s;
    s.position_ned_m = {8.0 * (group % 8), 8.0 * (group / 8) + 0.8 * (i % 3), 20.5};
    s.orientation = to_quaternion({0, 0, 0.7 * i});
    s.velocity_body[0] = 2;
    world.add(model, s);
    world.set_command(static_cast<std::size_t>(i), {0.1, 0, 20});
    world.set_water(static_cast<std::size_t>(i), {.current_ned_mps = {0.3, 0.1, 0}, .sea_surface_z_m = 0});
  }
  for (std::size_t i = 0; i < 180; i += 3) world.add(Tether{i, Vec3::Zero(), i + 1, Vec3::Zero(), 1.5});
  Outcome outcome;
  for (int step = 0; step < 300; ++step) {
    world.step(0.01);
    for (std::size_t i = 0; i < world.size(); ++i) {
      outcome.touched += world.touches_vehicle(i);
      outcome.grounded += !world.seabed_force_ned_n(i).isZero(0);
    }
    for (std::size_t i = 0; i < 60; ++i) outcome.pulled += world.tether_pull_n(i) > 0;
  }
  for (std::size_t i = 0; i < world.size(); ++i) {
    const VehicleState& s = world.state(i);
    for (const double x : s.position_ned_m) outcome.numbers.push_back(x);
    for (const double x : s.orientation.coeffs()) outcome.numbers.push_back(x);
    for (const double x : s.velocity_body) outcome.numbers.push_back(x);
  }
  return outcome;
}

TEST(VehicleThreads, ACrowdInContactMovesTheSameWithOneTwoAndFour) {
  const Outcome alone = crowd(one_after_the_other);
  EXPECT_GT(alone.touched, 1000);
  EXPECT_GT(alone.grounded, 1000);
  EXPECT_GT(alone.pulled, 100);
  for (const std::size_t threads : {2u, 4u}) {
    const Outcome shared = crowd(with_threads(threads));
    ASSERT_EQ(shared.numbers.size(), alone.numbers.size());
    EXPECT_EQ(std::memcmp(shared.numbers.data(), alone.numbers.data(), sizeof(double) * alone.numbers.size()),
              0);
  }
}

TEST(VehicleThreads, WorldsSideBySideMoveAsEachAlone) {
  const Outcome alone = crowd(one_after_the_other);
  std::vector<Outcome> side_by_side(3);
  std::vector<std::thread> threads;
  for (Outcome& outcome : side_by_side)
    threads.emplace_back([&outcome] { outcome = crowd(one_after_the_other); });
  for (std::thread& thread : threads) thread.join();
  for (const Outcome& outcome : side_by_side) EXPECT_EQ(outcome.numbers, alone.numbers);
}

}  // namespace
}  // namespace halocline::vehicle_sim
