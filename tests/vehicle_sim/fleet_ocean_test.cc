// SPDX-License-Identifier: BSD-3-Clause
// Vehicles in the currents of an ocean field.
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/frames.h"
#include "core/units.h"
#include "ocean/ocean_field.h"
#include "tests/support/at_ms.h"
#include "tests/support/tolerance.h"
#include "vehicle_sim/dynamics/remus100_pvs.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/fleet.h"

namespace halocline::vehicle_sim {
namespace {

using testing::at_ms;
using testing::tolerance;

constexpr double kMetresPerRadian = 6'371'000;

// A grid of 5 x 5 columns, 500 m apart about the origin on the equator, of two times and two depths.
template <class Current>
std::shared_ptr<const ocean::OceanField> field_of(const std::vector<double>& times_s,
                                                  const Current& current) {
  ocean::OceanGrid grid{times_s, {0, 100}, {}, {}};
  for (int i = -2; i <= 2; ++i) {
    grid.latitudes_rad.push_back(500.0 * i / kMetresPerRadian);
    grid.longitudes_rad.push_back(500.0 * i / kMetresPerRadian);
  }
  ocean::OceanValues values;
  for (const double time : grid.times_s) {
    for (const double depth : grid.depths_m) {
      for (const double north : grid.latitudes_rad) {
        for (const double east : grid.longitudes_rad) {
          const auto [n, e] = current(time, depth, north * kMetresPerRadian, east * kMetresPerRadian);
          values.north_mps.push_back(static_cast<float>(n));
          values.east_mps.push_back(static_cast<float>(e));
        }
      }
    }
  }
  return std::make_shared<const ocean::OceanField>(grid, values, ocean::GeodeticOrigin{0, 0});
}

using NorthEast = std::pair<double, double>;

Fleet fleet_in(std::shared_ptr<const ocean::OceanField> field, const Vec3& place,
               const Vec3& velocity = Vec3::Zero()) {
  VehicleState start;
  start.position_ned_m = place;
  start.velocity_body.head<3>() = velocity;
  FleetSettings settings;
  settings.ocean = std::move(field);
  const auto model = std::make_shared<const Model>(remus100_pvs_parameters(CurrentTreatment::kGalilean));
  return Fleet(settings, {{"one", model, start}}, nullptr, SimTime());
}

Vec3 place_after(Fleet& fleet, int ms) {
  fleet.advance(at_ms(ms));
  return fleet.state_at(0, at_ms(ms)).position_ned_m;
}

// Where the current is the same everywhere and changes evenly with time, a vehicle that starts with it is
// carried by its integral, exactly.
TEST(FleetInAnOcean, AFieldThatChangesWithTimeCarriesAVehicleAlong) {
  const auto field = field_of({0, 200}, [](double time, double, double, double) {
    return NorthEast{0.25 + time / 400, 0.125 - time / 800};
  });
  Fleet fleet = fleet_in(field, {0, 0, 50}, {0.25, 0.125, 0});
  const Vec3 place = place_after(fleet, 100'000);
  EXPECT_NEAR(place.x(), 25 + 0.5 * 100 * 100 / 400, tolerance(1e-6));
  EXPECT_NEAR(place.y(), 12.5 - 0.5 * 100 * 100 / 800, tolerance(1e-6));
}

// A field that depends on depth alone is the table of currents by depth.
TEST(FleetInAnOcean, AFieldOfDepthIsTheTableOfDepths) {
  const auto field = field_of({0}, [](double, double depth, double, double) {
    return NorthEast{0.5 - depth / 400, depth / 800};
  });
  Fleet in_field = fleet_in(field, {0, 0, 40});
  VehicleState start;
  start.position_ned_m = {0, 0, 40};
  FleetSettings settings;
  settings.current.by_depth = {{0, 0.5, 0}, {100, 0.25, 0.125}};
  const auto model = std::make_shared<const Model>(remus100_pvs_parameters(CurrentTreatment::kGalilean));
  Fleet by_depth(settings, {{"one", model, start}}, nullptr, SimTime());
  EXPECT_LT((place_after(in_field, 60'000) - place_after(by_depth, 60'000)).norm(), tolerance(1e-9));
}

// In an eddy that turns like a solid, a body that starts with the water stays with it: a quarter of a turn in
// pi / 2 omega, at its distance. Its hull, which does not turn, has another added mass along than across;
// drag makes up for the difference.
TEST(FleetInAnOcean, ADrifterGoesRoundWithAnEddy) {
  constexpr double kOmega = 2 * std::numbers::pi / 1200;
  const auto field = field_of({0}, [](double, double, double north, double east) {
    return NorthEast{-kOmega * east, kOmega * north};
  });
  constexpr double kRadius = 80;
  Fleet fleet = fleet_in(field, {kRadius, 0, 50}, {0, kOmega * kRadius, 0});
  const Vec3 quarter = place_after(fleet, 300'000);
  EXPECT_NEAR(quarter.y(), kRadius, tolerance(0.02 * kRadius));
  EXPECT_NEAR(quarter.x(), 0, tolerance(0.02 * kRadius));
}

TEST(FleetInAnOcean, CurrentsAddUp) {
  const auto field = field_of({0}, [](double, double, double, double) { return NorthEast{0.25, 0}; });
  FleetSettings settings;
  settings.ocean = field;
  settings.current.uniform_ned_mps = {0, 0.5, 0};
  VehicleState start;
  start.position_ned_m = {0, 0, 50};
  start.velocity_body.head<3>() = Vec3(0.25, 0.5, 0);
  const auto model = std::make_shared<const Model>(remus100_pvs_parameters(CurrentTreatment::kGalilean));
  Fleet fleet(settings, {{"one", model, start}}, nullptr, SimTime());
  EXPECT_LT((place_after(fleet, 20'000) - Vec3(5, 10, 50)).norm(), tolerance(1e-6));
}

}  // namespace
}  // namespace halocline::vehicle_sim
