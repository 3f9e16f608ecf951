// SPDX-License-Identifier: BSD-3-Clause
// Vehicles on generated terrain, as the simulator meets it: bilinear cells, not formulas. And at the surface.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "bathymetry/terrain/generated_terrain.h"
#include "bathymetry/terrain/height_grid.h"
#include "core/frames.h"
#include "core/units.h"
#include "tests/support/tolerance.h"
#include "tests/vehicle_sim/world/formula_seabed.h"
#include "vehicle_sim/dynamics/submergence.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/model_library.h"
#include "vehicle_sim/world/terrain_seabed.h"
#include "vehicle_sim/world/vehicle_world.h"

namespace halocline::vehicle_sim {
namespace {

using bathymetry::Terrain;
using halocline::testing::tolerance;
using testing::at;
using testing::deepest_in;
using TerrainPointer = std::shared_ptr<const Terrain>;

constexpr double kMaxPenetration = 0.02;  // m, the project's bound
constexpr ActuatorValues kFullAhead{0, 0, 25};

// 200 m by 200 m about the origin.
template <class Shape>
TerrainPointer terrain(const Shape& shape, double spacing_m = 5) {
  const int posts = static_cast<int>(std::lround(200 / spacing_m)) + 1;
  const bathymetry::GridGeometry geometry{-100, -100, spacing_m, posts, posts};
  return std::make_shared<const Terrain>(make_grid(geometry, shape));
}

std::shared_ptr<const Model> torpedo(double buoyancy_ratio) {
  ModelParameters p = programmed_model("torpedo").value();
  p.buoyancy_n = p.mass_kg * p.gravity_m_s2 * buoyancy_ratio;
  return std::make_shared<const Model>(p);
}

struct Outcome {
  VehicleState end;
  double deepest_m = -1e9;
  Vec3 mean_force = Vec3::Zero();  // of the seabed over the last second
};

Outcome run(const TerrainPointer& seabed, double buoyancy_ratio, const VehicleState& start,
            const ActuatorValues& command, double duration_s, double step_s) {
  const auto seabed_z = [&](double north, double east) { return seabed->depth_at(north, east).z_m; };
  VehicleWorld world(std::make_shared<TerrainSeabed>(seabed));
  world.add(torpedo(buoyancy_ratio), start);
  world.set_command(0, command);
  Outcome result;
  const long steps = std::lround(duration_s / step_s), last_second = std::lround(1 / step_s);
  for (long i = 0; i < steps; ++i) {
    world.step(step_s);
    EXPECT_FALSE(world.has_diverged(0));
    if (i % std::lround(0.04 / step_s) == 0)
      result.deepest_m =
          std::max(result.deepest_m, deepest_in(seabed_z, world.state(0), world.model(0).parameters().hull));
    if (i >= steps - last_second) result.mean_force += world.seabed_force_ned_n(0) / last_second;
  }
  result.end = world.state(0);
  return result;
}

class TerrainGrounding : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(AtStep, TerrainGrounding, ::testing::Values(0.005, 0.01, 0.02),
                         [](const auto& step) {
                           return std::to_string(std::lround(step.param * 1000)) + "ms";
                         });

TEST_P(TerrainGrounding, AHeavyVehicleSinksToAFlatBottomAndRestsOnItWithWeightLessBuoyancy) {
  const Outcome r = run(terrain(bathymetry::FlatShape{20}), 0.98, at({1, 2, 19}), {}, 60, GetParam());
  const double expected = 0.02 * torpedo(1)->weight_n();
  EXPECT_LT(r.deepest_m, tolerance(kMaxPenetration));
  EXPECT_NEAR(-r.mean_force.z(), expected, tolerance(0.01) * expected);
  EXPECT_LT(r.end.velocity_body.norm(), tolerance(1e-3));
}

TEST_P(TerrainGrounding, ADiveAtFullSpeedIsStopped) {
  const Outcome r = run(terrain(bathymetry::FlatShape{20}), 1, at({0, 0, 18}, {0, -to_radians(40), 0}, 2.5),
                        kFullAhead, 20, GetParam());
  EXPECT_LT(r.deepest_m, tolerance(kMaxPenetration));
}

TEST_P(TerrainGrounding, AVehicleRunsUpASlopeOfThirtyDegrees) {
  const auto up = [](double x, double) { return 40 - std::tan(to_radians(30)) * std::max(0.0, x - 10); };
  const Outcome r = run(terrain(up), 1, at({5, 0, 39}, {}, 2.5), kFullAhead, 20, GetParam());
  EXPECT_LT(r.deepest_m, tolerance(kMaxPenetration));
  EXPECT_GT(r.end.position_ned_m.x(), 11);
}

TEST_P(TerrainGrounding, AVehicleRestsOnASlopeOfTenDegrees) {
  const bathymetry::SlopeShape slope{20, std::tan(to_radians(10)), std::numbers::pi};
  for (const double yaw : {0.0, std::numbers::pi / 2}) {
    const Outcome r = run(terrain(slope), 0.98, at({0.5, 0, 19.6}, {0, 0, yaw}), {}, 40, GetParam());
    const double expected = 0.02 * torpedo(1)->weight_n();
    EXPECT_LT(r.deepest_m, tolerance(kMaxPenetration)) << yaw;
    EXPECT_NEAR(-r.mean_force.z(), expected, tolerance(0.01) * expected) << yaw;
    EXPECT_LT(r.end.velocity_body.norm(), tolerance(1e-3)) << yaw;
  }
}

TEST_P(TerrainGrounding, AVehicleDroppedAlongOrAcrossASharpRidgeIsNotCutByIt) {
  for (const double angle_deg : {20.0, 45.0}) {
    const double fall = std::tan(to_radians(angle_deg));
    const auto seabed = terrain([=](double x, double) { return 20 + fall * std::abs(x); });
    for (const double yaw : {0.0, 0.5, std::numbers::pi / 2}) {
      const Outcome r = run(seabed, 0.95, at({0.02, 0, 19.5}, {0, 0, yaw}), {}, 12, GetParam());
      EXPECT_LT(r.deepest_m, tolerance(kMaxPenetration)) << angle_deg << " degrees, yaw " << yaw;
    }
  }
}

TEST_P(TerrainGrounding, AVehicleSlidesOverTheCellsOfARoundHill) {
  const bathymetry::SeamountShape hill{30, 12, 15, 0, 0};  // no steeper than 26 degrees
  const Outcome r = run(terrain(hill, 2), 0.97, at({-25, 1, 24}, {}, 2.5), kFullAhead, 40, GetParam());
  EXPECT_LT(r.deepest_m, tolerance(kMaxPenetration));
}

// A rope-straight rise from 3 m: 2 % buoyant, it may leave the water by no more than its speed carries it.
TEST_P(TerrainGrounding, ABuoyantVehicleComesToRestAtTheSurfaceAndDoesNotFly) {
  VehicleWorld world(nullptr);
  const auto model = torpedo(1.05);
  world.add(model, at({0, 0, 3}, {0, 0.2, 0}));
  world.set_water(0, {.sea_surface_z_m = 0});
  double highest = 3;
  for (long i = 0; i < std::lround(300 / GetParam()); ++i) {
    world.step(GetParam());
    highest = std::min(highest, world.state(0).position_ned_m.z());
  }
  const Submergence under = submergence(model->parameters(), world.state(0), 0);
  EXPECT_NEAR(under.hull, 1 / 1.05, tolerance(5e-3));
  EXPECT_LT(world.state(0).velocity_body.norm(), tolerance(1e-2));
  EXPECT_GT(highest, -model->parameters().hull.diameter_m);
}

}  // namespace
}  // namespace halocline::vehicle_sim
