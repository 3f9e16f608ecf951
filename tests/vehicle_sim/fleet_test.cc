#include "vehicle_sim/fleet.h"

#include <gtest/gtest.h>

#include "bathymetry/generated_terrain.h"
#include "core/check.h"
#include "tests/support/tolerance.h"
#include "tests/vehicle_sim/grounds.h"
#include "vehicle_sim/remus100_pvs.h"
#include "vehicle_sim/terrain_seabed.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;

constexpr ActuatorValues kAhead{0.05, 0, 20};
SimTime at_ms(std::int64_t ms) { return SimTime::from_utime(ms * 1000); }

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
  for (Fleet* fleet : {&watched, &unwatched}) fleet->command(0, {SimTime(), kAhead});
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
  fleet.command(0, {SimTime(), kAhead});
  fleet.advance(at_ms(1500));
  const Vec3 before = fleet.state_at(0, at_ms(1509)).position_ned_m;
  fleet.advance(at_ms(1510));
  const Vec3 after = fleet.state_at(0, at_ms(1510)).position_ned_m;
  EXPECT_LT((after - before).norm(), tolerance(1e-3));  // a millisecond at half a metre a second
}

TEST(Fleet, ACommandIsObeyedFromTheFirstStepAtOrAfterItsTime) {
  Fleet fleet = fleet_of_one();
  fleet.command(0, {at_ms(105), kAhead});
  fleet.advance(at_ms(110));
  EXPECT_EQ(fleet.state_at(0, at_ms(110)).actuators.propeller_hz, 0);
  fleet.advance(at_ms(120));
  EXPECT_GT(fleet.state_at(0, at_ms(120)).actuators.propeller_hz, 0);
}

TEST(Fleet, WithoutCommandsThePropellerRunsDown) {
  Fleet fleet = fleet_of_one();
  fleet.command(0, {SimTime(), kAhead});
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

TEST(Fleet, TheCurrentCarriesAVehicleThatDrifts) {
  FleetSettings settings;
  settings.water.current_ned_mps = {0.5, 0, 0};
  VehicleState drifting = deep();
  drifting.velocity_body[0] = 0.5;
  Fleet fleet(settings, {{"one", remus(), drifting}}, nullptr, SimTime());
  fleet.advance(at_ms(10'000));
  EXPECT_NEAR(fleet.state_at(0, at_ms(10'000)).position_ned_m.x(), 5, tolerance(1e-9));
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

TEST(Fleet, BeyondTheTerrainThereIsNoGround) {
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

TEST(Fleet, AnImpossibleStepIsRefused) {
  FleetSettings settings;
  settings.step = SimDuration::from_milliseconds(50);
  EXPECT_THROW(fleet_of_one(settings), InvalidArgument);
}

}  // namespace
}  // namespace halocline::vehicle_sim
