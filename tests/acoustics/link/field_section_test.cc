// Sound through a field of temperature and salinity: along the straight line, and as rays see it.
#include "acoustics/link/field_section.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/link/line_means.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/ray_water.h"
#include "acoustics/sea/sound_speed.h"
#include "core/units.h"
#include "ocean/ocean_field.h"
#include "ocean/ocean_field_reader.h"
#include "tests/acoustics/rays/runge_kutta_ray.h"
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

TEST(FieldSection, KeepsTheSpeedOfTheFieldWithinItsTolerance) {
  const Environment sea = front();
  std::mt19937 draw(5);
  std::uniform_real_distribution<double> share(0, 1);
  for (const double allowed : {0.1, 0.02}) {
    double greatest = 0, squares = 0;
    int places = 0;
    for (int k = 0; k < 20; ++k) {
      const Vec3 from{4000 * (2 * share(draw) - 1), 4000 * (2 * share(draw) - 1), 0},
          to{4000 * (2 * share(draw) - 1), 4000 * (2 * share(draw) - 1), 0};
      const LinkWater water = water_between(sea, from, to, 180, kFrequency, allowed);
      if (!water.section) continue;
      const double range = std::hypot(to.x() - from.x(), to.y() - from.y());
      if (k < 3)
        printf("range %g strips %zu levels %zu\n", range, water.section->ranges_m().size(),
               water.section->depths_m().size());
      for (int i = 0; i < 300; ++i, ++places) {
        const double along = share(draw), depth = 180 * share(draw);
        const Vec3 place = from + along * (to - from) + Vec3(0, 0, depth);
        const double off =
            std::abs(water.section->speed_at(along * range, depth) - sound_speed_at(sea, place));
        greatest = std::max(greatest, off);
        squares += off * off;
      }
    }
    printf("allowed %g greatest %g rms %g\n", allowed, greatest, std::sqrt(squares / places));
    EXPECT_LT(greatest, 3 * allowed);
    EXPECT_LT(std::sqrt(squares / places), 0.5 * allowed);
  }
}

// Delays of direct paths against rays integrated in the field itself.
TEST(FieldSection, DelaysAreThoseOfTheField) {
  const Environment sea = front();
  std::mt19937 draw(9);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<double> errors;
  for (int k = 0; k < 12; ++k) {
    const Vec3 from{-3500 + 2000 * share(draw), 1000 * share(draw), 0}, to{1500 + 2000 * share(draw), 0, 0};
    const Vec3 way = (to - from).normalized();
    const double range = (to - from).norm();
    const PiecewiseWater water{[](double, double) { return 0; },
                               [&](int, double r, double z) {
                                 const auto c = [&](double x, double y) {
                                   return sound_speed_at(sea, from + x * way + Vec3(0, 0, y));
                                 };
                                 constexpr double h = 1e-3;
                                 return SpeedThere{c(r, z), (c(r + h, z) - c(r - h, z)) / (2 * h),
                                                   (c(r, z + h) - c(r, z - h)) / (2 * h)};
                               }};
    const RungeKuttaTracer tracer(
        water, {1000, 0}, [](double, double) { return 1.0; }, 1);
    const RayLink link{20 + 60 * share(draw), 40 + 80 * share(draw), range};
    const LinkWater along = water_between(sea, from, to, 1000, kFrequency, 0.02);
    RaySea rays{along.water, BottomProfile::flat(1000), {}, {}, {}};
    rays.section = along.section;
    rays.options.max_bounces = 0;
    rays.options.airy_folds = false;
    double nearest = 1, error = -1;
    for (const Arrival& path : arrivals(rays, link).paths) {
      double angle = path.launch_angle_rad;
      for (int i = 0; i < 8; ++i) {
        const RungeKuttaRay ray = tracer.trace(link.source_depth_m, range, angle),
                            beside = tracer.trace(link.source_depth_m, range, angle + 1e-5);
        if (!ray.arrived || !beside.arrived || ray.surface + beside.surface > 0) break;
        const double off = ray.z - link.receiver_depth_m;
        if (std::abs(off) < 1e-4) {
          if (std::abs(angle - path.launch_angle_rad) < nearest) {
            nearest = std::abs(angle - path.launch_angle_rad);
            error = std::abs(path.delay_s - (ray.tau - std::sin(ray.angle) / ray.c * off));
          }
          break;
        }
        angle -= off * 1e-5 / (beside.z - ray.z);
      }
    }
    if (error >= 0) errors.push_back(error);
  }
  std::sort(errors.begin(), errors.end());
  for (double e : errors) printf("delay error %g\n", e);
  ASSERT_GT(errors.size(), 5U);
  EXPECT_LT(errors[errors.size() / 2], tolerance(2e-6));
  EXPECT_LT(errors.back(), tolerance(5e-5));
}

}  // namespace
}  // namespace halocline::acoustics
