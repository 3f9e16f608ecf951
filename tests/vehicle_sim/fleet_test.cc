// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/fleet.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "bathymetry/terrain/generated_terrain.h"
#include "bathymetry/terrain/height_grid.h"
#include "core/check.h"
#include "tests/support/at_ms.h"
#include "tests/support/tolerance.h"
#include "tests/vehicle_sim/world/formula_seabed.h"
#include "vehicle_sim/dynamics/remus100_pvs.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/world/terrain_seabed.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;

constexpr ActuatorValues kAhead{0.05, 0, 20};
using halocline::testing::at_ms;

std::shared_ptr<const Model> remus(double buoyancy_ratio = 1) {
  ModelParameters p = remus100_pvs_parameters(CurrentTreatment::kGalilean);
  p.buoyancy_n *= buoyancy_ratio;
  return std::make_shared<const Model>(p);
}

VehicleState deep(double z = 50) {
  VehicleState s;
  s.position_ned_m.z() = z;
  return s;
}

Fleet fleet_of_one(const FleetSettings& settings = {}, std::shared_ptr<const Seabed> seabed = nullptr) {
  return Fleet(settings, {{"one", remus(), deep()}}, std::move(seabed), SimTime());
}

TEST(Fleet, AdvancesInWholeStepsOnly) {
  Fleet fleet = fleet_of_one();
  fleet.advance(at_ms(57));
  EXPECT_EQ(fleet.time(), at_ms(50));
  fleet.advance(at_ms(60));
  EXPECT_EQ(fleet.time(), at_ms(60));
}

TEST(Fleet, LookingBetweenStepsChangesNothing) {
  Fleet watched = fleet_of_one(), unwatched = fleet_of_one();
  for (Fleet* fleet : {&watched, &unwatched})
    EXPECT_EQ(fleet->command(0, {SimTime(), kAhead}), CommandVerdict::kTaken);
  for (int ms = 0; ms <= 1500; ms += 7) {
    watched.advance(at_ms(ms));
    watched.state_at(0, at_ms(ms));
    watched.reading_at(0, at_ms(ms));
  }
  unwatched.advance(at_ms(1500));
  watched.advance(at_ms(1500));
  EXPECT_EQ(watched.state_at(0, at_ms(1500)).position_ned_m,
            unwatched.state_at(0, at_ms(1500)).position_ned_m);
}

TEST(Fleet, BetweenStepsTheMotionIsContinuous) {
  Fleet fleet = fleet_of_one();
  EXPECT_EQ(fleet.command(0, {SimTime(), kAhead}), CommandVerdict::kTaken);
  fleet.advance(at_ms(1500));
  const Vec3 before = fleet.state_at(0, at_ms(1509)).position_ned_m;
  fleet.advance(at_ms(1510));
  const Vec3 after = fleet.state_at(0, at_ms(1510)).position_ned_m;
  EXPECT_LT((after - before).norm(), tolerance(1e-3));  // a millisecond at half a metre a second
}

TEST(Fleet, ACommandIsObeyedFromTheFirstStepAtOrAfterItsTime) {
  Fleet fleet = fleet_of_one();
  EXPECT_EQ(fleet.command(0, {at_ms(105), kAhead}), CommandVerdict::kTaken);
  fleet.advance(at_ms(110));
  EXPECT_EQ(fleet.state_at(0, at_ms(110)).actuators.propeller_hz, 0);
  fleet.advance(at_ms(120));
  EXPECT_GT(fleet.state_at(0, at_ms(120)).actuators.propeller_hz, 0);
}

TEST(Fleet, WithoutCommandsThePropellerRunsDown) {
  Fleet fleet = fleet_of_one();
  EXPECT_EQ(fleet.command(0, {SimTime(), kAhead}), CommandVerdict::kTaken);
  fleet.advance(at_ms(2000));
  EXPECT_FALSE(fleet.reading_at(0, at_ms(2000)).safe_state);
  fleet.advance(at_ms(12000));
  EXPECT_TRUE(fleet.reading_at(0, at_ms(12000)).safe_state);
  EXPECT_NEAR(fleet.state_at(0, at_ms(12000)).actuators.propeller_hz, 0, tolerance(1e-2));
}

TEST(Fleet, AFixedMemberStaysWhereItIs) {
  Fleet fleet({}, {{"buoy", nullptr, deep(5)}, {"one", remus(), deep()}}, nullptr, SimTime());
  EXPECT_EQ(fleet.command(0, {SimTime(), kAhead}), CommandVerdict::kTaken);
  fleet.advance(at_ms(1000));
  EXPECT_EQ(fleet.state_at(0, at_ms(1000)).position_ned_m, Vec3(0, 0, 5));
  EXPECT_EQ(fleet.reading_at(0, at_ms(1000)).depth_m, 5);
  EXPECT_FALSE(fleet.on_seabed(0));
}

TEST(Fleet, AFixedMemberThatFloatsFollowsTheTideAndAMooredOneFeelsItsDepthChange) {
  FleetSettings settings;
  settings.tide = {{{.amplitude_m = 2, .period_s = 600}}};
  std::vector<FleetMember> members{{"moored", nullptr, deep(5)}, {"buoy", nullptr, deep(5)}};
  members[1].floats = true;
  Fleet fleet(settings, members, nullptr, SimTime());
  for (const int s : {0, 100, 250}) {
    fleet.advance(at_ms(1000 * s));
    const double height = settings.tide.height_m(s);
    EXPECT_NEAR(fleet.sea_surface_z_m(0, Vec3::Zero(), at_ms(1000 * s)), -height, tolerance(1e-12));
    EXPECT_EQ(fleet.state_at(0, at_ms(1000 * s)).position_ned_m.z(), 5);
    EXPECT_NEAR(fleet.state_at(1, at_ms(1000 * s)).position_ned_m.z(), 5 - (height - 2), tolerance(1e-12));
    EXPECT_NEAR(fleet.reading_at(0, at_ms(1000 * s)).depth_m, 5 + height, tolerance(1e-3));
  }
}

TEST(Fleet, TheCurrentCarriesAVehicleThatDrifts) {
  FleetSettings settings;
  settings.current.uniform_ned_mps = {0.5, 0, 0};
  VehicleState drifting = deep();
  drifting.velocity_body[0] = 0.5;
  Fleet fleet(settings, {{"one", remus(), drifting}}, nullptr, SimTime());
  fleet.advance(at_ms(10'000));
  EXPECT_NEAR(fleet.state_at(0, at_ms(10'000)).position_ned_m.x(), 5, tolerance(1e-9));
}

// Where the current is the same everywhere, the path is that in still water plus the integral of the current:
// between two steps it changes evenly, so the integral is the trapezoids'. Rounding over 60 s of path.
TEST(Fleet, ACurrentThatChangesWithTimeOnlyCarriesThePathAlong) {
  FleetSettings settings;
  settings.current.tide = {.amplitude_mps = 0.8, .period_s = 50, .phase_rad = 0.3, .toward_rad = 1};
  settings.current.random = {.deviation_mps = 0.3, .time_s = 20};
  OceanCurrent current(settings.current, settings.seed);
  const auto velocity = [&](int ms) { return current.everywhere(at_ms(ms), settings.step).velocity_mps; };
  VehicleState carried_start = deep();
  carried_start.velocity_body.head<3>() = velocity(0);
  Fleet carried(settings, {{"one", remus(), carried_start}}, nullptr, SimTime()), still = fleet_of_one();
  Vec3 drift = Vec3::Zero();
  for (int ms = 0; ms < 60'000; ms += 10) drift += 0.005 * (velocity(ms) + velocity(ms + 10));
  for (Fleet* fleet : {&carried, &still}) {
    for (int ms = 0; ms < 60'000; ms += 1000) {
      EXPECT_EQ(fleet->command(0, {at_ms(ms), kAhead}), CommandVerdict::kTaken);
      fleet->advance(at_ms(ms + 1000));
    }
  }
  const Vec3 path =
      carried.state_at(0, at_ms(60'000)).position_ned_m - still.state_at(0, at_ms(60'000)).position_ned_m;
  EXPECT_LT((path - drift).norm(), tolerance(1e-9));
}

TEST(Fleet, TheCurrentAtAVehiclesDepthActsOnIt) {
  FleetSettings settings;
  settings.current.by_depth = {{0, 1, 0}, {100, 0, 0}};
  VehicleState drifting = deep(25);
  drifting.velocity_body[0] = 0.75;
  Fleet fleet(settings, {{"one", remus(), drifting}}, nullptr, SimTime());
  fleet.advance(at_ms(10'000));
  EXPECT_NEAR(fleet.state_at(0, at_ms(10'000)).position_ned_m.x(), 7.5, tolerance(1e-9));
}

TEST(Fleet, AChangedCurrentHoldsFromItsTimeOn) {
  CurrentSettings east;
  east.uniform_ned_mps = {0, 0.5, 0};
  Fleet fleet = fleet_of_one(), other = fleet_of_one();
  EXPECT_TRUE(fleet.change_current(at_ms(5000), east));
  fleet.advance(at_ms(5000));
  EXPECT_EQ(fleet.state_at(0, at_ms(5000)).position_ned_m.y(), 0);
  fleet.advance(at_ms(60'000));
  EXPECT_GT(fleet.state_at(0, at_ms(60'000)).position_ned_m.y(), 1);
  other.advance(at_ms(5000));
  EXPECT_TRUE(other.change_current(at_ms(4321), east));  // late: at once
  other.advance(at_ms(60'000));
  EXPECT_EQ(other.state_at(0, at_ms(60'000)).position_ned_m, fleet.state_at(0, at_ms(60'000)).position_ned_m);
}

TEST(Fleet, AnImpossibleCurrentIsRefused) {
  CurrentSettings fast;
  fast.uniform_ned_mps = {99, 0, 0};
  Fleet fleet = fleet_of_one();
  EXPECT_THROW(static_cast<void>(fleet.change_current(at_ms(0), fast)), InvalidArgument);
}

TEST(Fleet, WavesMoveAShallowVehicleAndLeaveADeepOneAlone) {
  FleetSettings settings;
  settings.waves = {.kind = SeaKind::kRegular, .height_m = 1, .period_s = 6};
  Fleet fleet(settings, {{"shallow", remus(), deep(3)}, {"deep", remus(), deep(60)}}, nullptr, SimTime());
  double shallow = 0, below = 0;
  for (int ms = 0; ms < 30'000; ms += 100) {
    fleet.advance(at_ms(ms));
    shallow = std::max(shallow, std::abs(fleet.state_at(0, at_ms(ms)).velocity_body[0]));
    below = std::max(below, std::abs(fleet.state_at(1, at_ms(ms)).velocity_body[0]));
  }
  EXPECT_GT(shallow, 0.1);
  EXPECT_LT(below, 0.01);
}

// Within waves the velocity of the water is evenly extrapolated over a step: finer steps, the same path.
TEST(Fleet, HalvingTheStepInWavesAndShearChangesLittle) {
  const auto after = [](int step_ms) {
    FleetSettings settings;
    settings.step = SimDuration::from_milliseconds(step_ms);
    settings.waves = {.kind = SeaKind::kJonswap, .height_m = 1, .period_s = 6};
    settings.current.by_depth = {{0, 0.5, 0}, {20, 0, 0.5}};
    Fleet fleet(settings, {{"one", remus(), deep(5)}}, nullptr, SimTime());
    fleet.advance(at_ms(30'000));
    return fleet.state_at(0, at_ms(30'000)).position_ned_m;
  };
  const Vec3 exact = after(1);
  const double coarse = (after(20) - exact).norm(), fine = (after(10) - exact).norm();
  EXPECT_LT(fine, 5e-3);
  EXPECT_LT(fine, 0.6 * coarse);  // of the first order at least
}

TEST(Fleet, ABuoyantVehicleInTheSafeStateComesUp) {
  Fleet fleet({}, {{"one", remus(1.02), deep(10)}}, nullptr, SimTime());
  fleet.advance(at_ms(120'000));
  EXPECT_LT(fleet.state_at(0, at_ms(120'000)).position_ned_m.z(), 0.2);
}

TEST(Fleet, AHeavyVehicleComesToRestOnTheTerrain) {
  const bathymetry::GridGeometry geometry{-100, -100, 10, 21, 21};
  const auto terrain = std::make_shared<const bathymetry::Terrain>(
      bathymetry::make_grid(geometry, bathymetry::FlatShape{.depth_m = 52}));
  Fleet fleet({}, {{"one", remus(0.98), deep()}}, std::make_shared<TerrainSeabed>(terrain), SimTime());
  fleet.advance(at_ms(60'000));
  EXPECT_TRUE(fleet.on_seabed(0));
  EXPECT_TRUE(fleet.reading_at(0, at_ms(60'000)).on_seabed);
  EXPECT_NEAR(fleet.state_at(0, at_ms(60'000)).position_ned_m.z(), 52 - 0.095, tolerance(2e-3));
}

TEST(Fleet, BeyondTheTerrainThereIsNoSeabed) {
  const bathymetry::GridGeometry geometry{0, 0, 10, 3, 3};
  const auto terrain = std::make_shared<const bathymetry::Terrain>(
      bathymetry::make_grid(geometry, bathymetry::FlatShape{.depth_m = 52}));
  const TerrainSeabed seabed(terrain);
  EXPECT_FALSE(seabed.plane_at(-5, 5));
  ASSERT_TRUE(seabed.plane_at(5, 5));
  EXPECT_EQ(seabed.plane_at(5, 5)->z_m, 52);
  EXPECT_EQ(seabed.plane_at(5, 5)->normal_ned, -Vec3::UnitZ());
  EXPECT_THROW(TerrainSeabed(nullptr), InvalidArgument);
}

TEST(Fleet, ATetherToAFixedMemberMoorsAVehicle) {
  FleetSettings settings;
  settings.tethers.push_back({0, Vec3::Zero(), 1, {0, 0, -1}, 5});
  Fleet fleet(settings, {{"one", remus(1.02), deep(50)}, {"anchor", nullptr, deep(52)}}, nullptr, SimTime());
  fleet.advance(at_ms(60'000));
  EXPECT_NEAR(fleet.state_at(0, at_ms(60'000)).position_ned_m.z(), 51 - 5, tolerance(0.01));
  EXPECT_NEAR(fleet.tether_pull_n(0), 0.02 * remus()->weight_n(),
              tolerance(0.01) * 0.02 * remus()->weight_n());
}

TEST(Fleet, AnImpossibleStepIsRefused) {
  FleetSettings settings;
  settings.step = SimDuration::from_milliseconds(50);
  EXPECT_THROW(fleet_of_one(settings), InvalidArgument);
}

}  // namespace
}  // namespace halocline::vehicle_sim
