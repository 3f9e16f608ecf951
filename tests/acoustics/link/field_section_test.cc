// SPDX-License-Identifier: BSD-3-Clause
// Sound through a field of temperature and salinity: along the straight line, and as rays see it.
#include "acoustics/link/field_section.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/link/line_means.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/ray_trace.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/rays/traced_eigenray.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/ray_water.h"
#include "acoustics/sea/sound_speed.h"
#include "core/units.h"
#include "ocean/ocean_field.h"
#include "ocean/ocean_field_reader.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

constexpr double kFrequency = 25'000;
constexpr double kMetresPerRadian = 6'371'000;

Environment in_field(std::shared_ptr<const ocean::OceanField> field) {
  Environment environment;
  environment.absorption_model = AbsorptionModel::kFrancoisGarrison1982;
  environment.field = {std::move(field), 300, 600};
  environment.profile = environment_at(environment, 0, 0).profile;
  return environment;
}

Environment front() {
  const ocean::GeodeticOrigin origin{to_radians(39.9), to_radians(-71.2)};
  return in_field(ocean::read_ocean_field(
      {std::string(HALOCLINE_SOURCE_DIR) + "/scenarios/front.nc", "2026-05-02T01:00:00Z", origin}));
}

// Columns 1 km apart about the origin on the equator.
template <class Temperature>
Environment field_of(const Temperature& temperature) {
  ocean::OceanGrid grid{{0}, {0, 20, 40, 60, 100, 200}, {}, {}};
  for (int i = -4; i <= 4; ++i) {
    grid.latitudes_rad.push_back(1000.0 * i / kMetresPerRadian);
    grid.longitudes_rad.push_back(1000.0 * i / kMetresPerRadian);
  }
  ocean::OceanValues values;
  for (const double depth : grid.depths_m) {
    for (const double north : grid.latitudes_rad) {
      for (const double east : grid.longitudes_rad) {
        values.temperature_degc.push_back(
            static_cast<float>(temperature(depth, north * kMetresPerRadian, east * kMetresPerRadian)));
        values.salinity_psu.push_back(35);
      }
    }
  }
  return in_field(std::make_shared<const ocean::OceanField>(grid, values, ocean::GeodeticOrigin{0, 0}));
}

TEST(FieldOfOneWater, IsThatOfItsProfile) {
  const Environment sea = field_of([](double depth, double, double) { return 20 - depth / 10; });
  const Vec3 from{-2000, 500, 30}, to{1500, -700, 90};
  const LinkWater water = water_between(sea, from, to, 200, kFrequency, 0.02);
  EXPECT_EQ(water.section, nullptr);
  const RayWater layered = ray_water(environment_at(sea, from.x(), from.y()), kFrequency, 0.02);
  EXPECT_EQ(water.water.depths_m(), layered.depths_m());
  EXPECT_EQ(water.water.speeds_mps(), layered.speeds_mps());
  // The straight line, too.
  const LineMeans means = means_along(sea, from, to, kFrequency);
  EXPECT_NEAR(means.slowness_s_per_m * sea.profile.mean_sound_speed_mps(30, 90), 1, tolerance(1e-9));
  EXPECT_EQ(means_along(sea, to, from, kFrequency).slowness_s_per_m, means.slowness_s_per_m);
}

// Along a line through water that changes evenly the sums are those of many small pieces.
TEST(LineThroughAField, IsTheIntegralOfSlownessAndAbsorption) {
  const Environment sea = front();
  const Vec3 from{-3000, 500, 20}, to{2500, -800, 110};
  constexpr int kPieces = 20'000;
  LineMeans sum;
  for (int i = 0; i < kPieces; ++i) {
    const Vec3 place = from + (i + 0.5) / kPieces * (to - from);
    const Environment there = environment_at(sea, place.x(), place.y());
    if (i % 500 == 0) {  // the profile of a place has the speed of the field
      EXPECT_NEAR(there.profile.sound_speed_mps(place.z()), sound_speed_at(sea, place), tolerance(1e-9));
    }
    sum.slowness_s_per_m += 1 / sound_speed_at(sea, place) / kPieces;
    if (i % 20 == 10)
      sum.absorption_db_per_km += absorption_spectrum_at(there, place.z()).db_per_km(625) / (kPieces / 20);
  }
  const LineMeans means = means_along(sea, from, to, kFrequency);
  EXPECT_NEAR(means.slowness_s_per_m / sum.slowness_s_per_m, 1, tolerance(1e-9));
  EXPECT_NEAR(means.absorption_db_per_km / sum.absorption_db_per_km, 1, tolerance(1e-4));
}

double some_temperature(double depth, double north, double) {
  return 10 + 6 * std::exp(-depth / 50) + 2 * std::tanh(north / 1500);
}

TEST(FieldSection, HasTheSpeedOfTheFieldAtItsPoints) {
  const Environment sea = field_of(some_temperature);
  const Vec3 from{-2700, 0, 0}, to{2400, 0, 0};
  const LinkWater water = water_between(sea, from, to, 200, kFrequency, 0);
  ASSERT_TRUE(water.section);
  const auto rows = sea.field.ocean->crossings(from, to);
  ASSERT_EQ(rows.size(), 5U);
  for (const double share : rows) {
    for (const double depth : sea.field.ocean->grid().depths_m) {
      const Vec3 place = from + share * (to - from) + Vec3(0, 0, depth);
      EXPECT_NEAR(water.section->speed_at(share * (to - from).norm(), depth), sound_speed_at(sea, place),
                  tolerance(1e-6));
    }
  }
}

// Between its points it is nearer to a smooth sea than the field's straight lines are.
TEST(FieldSection, IsNearASmoothSea) {
  const Environment sea = field_of(some_temperature);
  const Vec3 from{-2700, 300, 0}, to{2400, -900, 0};
  const LinkWater water = water_between(sea, from, to, 200, kFrequency, 0);
  double squares = 0, of_lines = 0;
  std::mt19937 draw(5);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 2000; ++i) {
    const double along = share(draw), depth = 190 * share(draw);
    const Vec3 place = from + along * (to - from) + Vec3(0, 0, depth);
    const double speed = sound_speed_mps(sea.profile.model(), some_temperature(depth, place.x(), place.y()),
                                         35, depth, sea.latitude_rad);
    squares += std::pow(water.section->speed_at(along * (to - from).norm(), depth) - speed, 2);
    of_lines += std::pow(sound_speed_at(sea, place) - speed, 2);
  }
  EXPECT_LT(std::sqrt(squares / of_lines), 0.5);
}

}  // namespace
}  // namespace halocline::acoustics
