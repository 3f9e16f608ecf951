// SPDX-License-Identifier: BSD-3-Clause
// Rays over a bottom that changes with range: against a dense fan of straight lines, symmetries, moving ends.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/profile_rays.h"
#include "acoustics/rays/ray_trace.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/ray_water.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/check.h"
#include "tests/acoustics/rays/ray_reference.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

// A cosine hill 120 m high on a bottom of 200 m, between 1.5 and 3.5 km.
BottomProfile cosine_hill(double step_m, double crease_rad = kDefaultCreaseAngle) {
  std::vector<ProfiledDepth> points;
  for (double r = 0; r <= 5000; r += step_m) {
    const double along = (r - 2500) / 1000;
    points.push_back({r, std::abs(along) < 1 ? 200 - 60 * (1 + std::cos(std::numbers::pi * along)) : 200});
  }
  return BottomProfile(std::move(points), crease_rad);
}

BottomProfile sharp_ridge() { return BottomProfile({{0, 200}, {1500, 200}, {2500, 80}, {3500, 200}}); }

// One ray of straight lines in water of 1500 m/s, by vectors: an independent way to the same reflections.
struct StraightRay {
  double z = 0, length = 0, slope = 0;
  int surface = 0, bottom = 0;
  bool arrived = false;
  std::vector<int> bounce_sequence;
};

StraightRay straight_ray(const BottomProfile& profile, double z0, double range, double theta,
                         int max_bounces) {
  double r = 0, z = z0, dr = std::cos(theta), dz = std::sin(theta);
  StraightRay ray;
  const std::vector<Facet>& facets = profile.facets();
  std::size_t on = facets.size();
  while (ray.surface + ray.bottom <= max_bounces) {
    double best = (range - r) / dr;
    std::size_t hit = facets.size() + 1;  // the receiver's range
    if (dz < 0 && -z / dz < best) {
      best = -z / dz;
      hit = facets.size();
    }
    for (std::size_t i = profile.facet_at(r); i < facets.size() && facets[i].r0 <= r + best * dr; ++i) {
      if (i == on) continue;
      const Facet& f = facets[i];
      const double t = (f.z0 + f.slope * (r - f.r0) - z) / (dz - f.slope * dr), at = r + t * dr;
      if (t > 0 && t < best && at >= f.r0 && at <= f.r1 && dz > f.slope * dr) {
        best = t;
        hit = i;
      }
    }
    r += best * dr;
    z += best * dz;
    ray.length += best;
    on = hit;
    if (hit == facets.size() + 1) {
      ray.arrived = true;
      ray.z = z;
      ray.slope = dz;
      return ray;
    }
    if (hit == facets.size()) {
      z = 0;
      dz = -dz;
      ++ray.surface;
      ray.bounce_sequence.push_back(-1);
      continue;
    }
    const Facet& f = facets[hit];
    const double beta = std::atan(f.slope) + f.turn_at((r - f.r0) / (f.r1 - f.r0)), nr = -std::sin(beta),
                 nz = std::cos(beta);  // normal, downward
    const double along = dr * nr + dz * nz;
    dr -= 2 * along * nr;
    dz -= 2 * along * nz;
    ++ray.bottom;
    ray.bounce_sequence.push_back(f.smooth_group);
    if (dr <= 0.001) return ray;
  }
  return ray;
}

struct FanResult {
  double delay_s, theta;
  int surface, bottom;
};

// Eigenrays between neighbours of a fan of straight rays with one history.
std::vector<FanResult> straight_fan(const BottomProfile& profile, const RayLink& link, int count,
                                    int max_bounces) {
  std::vector<FanResult> found;
  const auto off = [&](double theta, StraightRay& ray) {
    ray = straight_ray(profile, link.source_depth_m, link.range_m, theta, max_bounces);
    return ray.z - link.receiver_depth_m;
  };
  StraightRay before, next, middle;
  const double steepest = to_radians(80);
  double a = -steepest, fa = off(a, before);
  for (int i = 1; i <= count; ++i) {
    const double b = -steepest + 2 * steepest * i / count, fb = off(b, next);
    if (before.arrived && next.arrived && before.bounce_sequence == next.bounce_sequence &&
        (fa > 0) != (fb > 0)) {
      double low = a, high = b;
      for (int k = 0; k < 60; ++k)
        ((off(0.5 * (low + high), middle) > 0) == (fa > 0) ? low : high) = 0.5 * (low + high);
      if (std::abs(off(low, middle)) < 1e-3 && middle.bounce_sequence == before.bounce_sequence) {
        found.push_back({middle.length / 1500, low, middle.surface, middle.bottom});
      }
    }
    a = b;
    fa = fb;
    before = next;
  }
  return found;
}

struct Terrain {
  const char* name;
  BottomProfile profile;
};

class ProfileCompleteness : public ::testing::TestWithParam<Terrain> {};

TEST_P(ProfileCompleteness, NoRayOfADenseFanIsMissingOverTheBottom) {
  const RaySea sea = sea_of({{0, 1500}}, GetParam().profile);
  for (const RayLink link :
       {RayLink{20, 50, 2000}, RayLink{20, 60, 3000}, RayLink{60, 120, 4500}, RayLink{150, 30, 5000}}) {
    const Eigenrays found = eigenrays(sea, link, RaySolver::kArcs);
    std::vector<bool> used(found.paths.size());
    int most = 0;
    double loudest = 0;
    for (const Eigenray& path : found.paths) {
      most = std::max(most, path.surface_bounces + path.bottom_bounces);
      loudest = std::max(loudest, path.amplitude);
    }
    for (const FanResult& ray : straight_fan(GetParam().profile, link, 20'000, most)) {
      // Rays too faint for the solver are no loss: trace again for the bounces' factor.
      RayTrace traced;
      TraceDetails details;
      const ProfiledSea profiled{sea.water, sea.bottom_profile, sea.bottom, sea.surface, sea.options};
      ArcTracer(profiled, link).trace(ray.theta, traced, &details);
      // Where a bent facet would throw a grazing ray into itself the solver lets the facet's own slope
      // reflect it.
      if (std::abs(traced.z - link.receiver_depth_m) > 0.01) continue;
      // Nor are rays 30 dB fainter than the loudest, as those spread at the very edge of a crest are.
      const double tube = link.range_m * std::abs(traced.zeta_slope);
      const double amplitude = traced.factor * std::cos(ray.theta) / std::sqrt(tube * std::cos(ray.theta));
      if (traced.factor < 0.005 * 1.01 || amplitude < 0.03 * loudest) continue;
      const int index =
          find_path(found.paths, used, ray.delay_s, ray.theta, ray.surface, ray.bottom, tolerance(1e-7));
      EXPECT_GE(index, 0) << GetParam().name << " at " << link.range_m << " m: missing " << ray.delay_s
                          << " s, " << to_degrees(ray.theta) << " deg, " << ray.surface << "+" << ray.bottom;
      if (index >= 0) used[static_cast<std::size_t>(index)] = true;
    }
    for (std::size_t i = 0; i < used.size(); ++i) {
      // The fan misses what lies between two of its rays of different history, and pairs: what it lacks has
      // to be so near to its neighbour's other side, or be a ray by the independent way as well.
      const Eigenray& path = found.paths[i];
      const StraightRay again =
          straight_ray(GetParam().profile, link.source_depth_m, link.range_m, path.launch_angle_rad, most);
      const bool is_ray = again.arrived && again.surface == path.surface_bounces &&
                          again.bottom == path.bottom_bounces &&
                          std::abs(again.length / 1500 - path.delay_s) < 1e-6;
      EXPECT_TRUE(used[i] || is_ray) << GetParam().name << " extra " << describe(path);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Terrains, ProfileCompleteness,
                         ::testing::Values(Terrain{"slope", BottomProfile({{0, 220}, {5000, 160}})},
                                           Terrain{"ridge", sharp_ridge()}, Terrain{"hill", cosine_hill(50)},
                                           Terrain{"facets", cosine_hill(200, 0)}),
                         [](const auto& terrain) { return std::string(terrain.param.name); });

// The tube in the plane is reciprocal; its width across the plane is taken as round the source, r /
// cos(launch), which is so only where Snell's invariant stays (see the header of arc_tracer.h): what is left
// is its ratio at both ends.
TEST(ProfileRays, SwappedEndsHaveTheSameDelaysAndTubes) {
  for (const BottomProfile& profile : {sharp_ridge(), BottomProfile({{0, 200}, {4000, 120}})}) {
    const RayLink link{20, 60, 3000};
    const std::vector<SpeedRow> knots = {{0, 1520}, {50, 1490}, {200, 1492}};
    const Eigenrays there = eigenrays(sea_of(knots, profile), link);
    const Eigenrays back = eigenrays(sea_of(knots, profile.reversed(3000)), {60, 20, 3000});
    ASSERT_EQ(there.paths.size(), back.paths.size());
    for (std::size_t i = 0; i < there.paths.size(); ++i) {
      EXPECT_NEAR(there.paths[i].delay_s, back.paths[i].delay_s, tolerance(1e-9));
      const RayWater water(knots, no_absorption);
      const double leaves = std::cos(there.paths[i].launch_angle_rad) / water.speed_at(20);
      const double comes = std::cos(there.paths[i].arrival_angle_rad) / water.speed_at(60);
      const double ratio = there.paths[i].amplitude / back.paths[i].amplitude;
      EXPECT_NEAR(20 * std::log10(ratio) - 10 * std::log10(leaves / comes), 0, tolerance(1e-4));
    }
  }
}

TEST(ProfileRays, OverAFlatBottomOfManyPointsAreThoseOfTheFlatSolver) {
  std::vector<ProfiledDepth> points;
  for (int i = 0; i <= 40; ++i) points.push_back({100.0 * i, 100});
  const std::vector<SpeedRow> knots = {{0, 1520}, {50, 1490}, {100, 1490}};
  const Eigenrays flat = eigenrays(sea_of(knots, BottomProfile(points)), {20, 80, 2000}, RaySolver::kSnell);
  const Eigenrays arcs = eigenrays(sea_of(knots, BottomProfile(points)), {20, 80, 2000}, RaySolver::kArcs);
  ASSERT_EQ(flat.paths.size(), arcs.paths.size());
  for (std::size_t i = 0; i < flat.paths.size(); ++i) {
    EXPECT_NEAR(flat.paths[i].delay_s, arcs.paths[i].delay_s, tolerance(1e-10));
    EXPECT_NEAR(20 * std::log10(flat.paths[i].amplitude / arcs.paths[i].amplitude), 0, tolerance(1e-4));
  }
}

TEST(ProfileRays, TubeOverABentBottomFollowsTheFocusOfABasin) {
  // One bounce at the middle of a shallow bowl of radius R: the mirror equation of a line source, 1/q' = 1/q
  // - 2/(R sin).
  std::vector<ProfiledDepth> points;
  constexpr double kRadius = 5000, kMiddle = 500;
  for (double r = 0; r <= 1000; r += 10) {
    points.push_back({r, 100 - kRadius + std::sqrt(kRadius * kRadius - (r - kMiddle) * (r - kMiddle))});
  }
  RaySea sea = sea_of({{0, 1500}}, BottomProfile(points));
  sea.options.max_bounces = 1;
  const Eigenrays found = eigenrays(sea, {50, 50, 1000});
  const auto bounce = std::find_if(found.paths.begin(), found.paths.end(), [](const Eigenray& path) {
    return path.bottom_bounces == 1 && std::abs(path.launch_angle_rad + path.arrival_angle_rad) < 1e-6;
  });
  ASSERT_NE(bounce, found.paths.end());
  const double leg = std::hypot(500, 50), sine = 50 / leg;
  const double tube = leg + leg * (1 - 2 * leg / (kRadius * sine));
  const double expected = std::sqrt(std::cos(bounce->launch_angle_rad) / (1000 * std::abs(tube)));
  // Facets of 10 m approximate the circle to 1e-5 of its sine; the bend of the reflection to 1e-3.
  EXPECT_NEAR(20 * std::log10(bounce->amplitude / expected) + bounce->bottom_loss_db, 0, tolerance(0.02));
}

TEST(ProfileRays, AHillInTheWayCastsAShadow) {
  const RaySea sea = sea_of({{0, 1500}}, BottomProfile({{0, 200}, {900, 200}, {1000, 20}, {1100, 200}}));
  EXPECT_FALSE(has_direct_path(eigenrays(sea, {100, 100, 2000})));
  EXPECT_TRUE(has_direct_path(eigenrays(sea, {10, 10, 2000})));
}

TEST(ProfileRays, AnArcThatBendsDownOverACrestMeetsItsFarSide) {
  // Where it starts the ray is below the far slope drawn on. Its radius is 1.5 km: highest over the crest, 3
  // m above it, it meets the far slope 150 m on.
  const RaySea sea = sea_of({{0, 1600}, {300, 1300}}, BottomProfile({{0, 200}, {500, 100}, {1500, 130}}));
  const ProfiledSea profiled{sea.water, sea.bottom_profile, sea.bottom, sea.surface, sea.options};
  const double theta = -std::atan(500 / (1600.0 - 182));
  RayTrace ray;
  ArcTracer(profiled, {182, 50, 600}).trace(theta, ray);
  EXPECT_TRUE(ray.arrived);
  EXPECT_EQ(ray.bottom_bounces, 0);
  ArcTracer(profiled, {182, 50, 700}).trace(theta, ray);
  EXPECT_TRUE(ray.arrived);
  EXPECT_EQ(ray.bottom_bounces, 1);
}

TEST(BottomProfile, IsLinearBetweenPointsAndConstantBeyond) {
  const BottomProfile profile({{100, 50}, {200, 70}});
  EXPECT_EQ(profile.depth_at(0), 50);
  EXPECT_NEAR(profile.depth_at(150), 60, tolerance(1e-12));
  EXPECT_EQ(profile.depth_at(1000), 70);
  EXPECT_TRUE(profile.is_flat_until(100));
  EXPECT_FALSE(profile.is_flat_until(101));
}

TEST(BottomProfile, KeepsCornersAndLongSlopesAndBendsSamplesOfACurve) {
  const auto bent_facets = [](const BottomProfile& profile) {
    return std::count_if(profile.facets().begin(), profile.facets().end(),
                         [](const Facet& f) { return f.bent(); });
  };
  EXPECT_EQ(bent_facets(sharp_ridge()), 0);
  EXPECT_EQ(bent_facets(BottomProfile({{0, 100}, {5000, 40}})), 0);
  EXPECT_GE(bent_facets(cosine_hill(50)), 38);
  EXPECT_EQ(bent_facets(cosine_hill(50, 0)), 0);
}

TEST(BottomProfile, ACurveSampledCoarselyIsNoRowOfCorners) {
  // Up to 7 degrees from facet to facet, and crests in water shallower than half a facet; one corner as sharp
  // by itself stays one.
  std::vector<ProfiledDepth> steep, shoal;
  for (double r = 0; r <= 5000; r += 100) {
    const double u = (r - 2500) / 300, v = (r - 2500) / 800;
    steep.push_back({r, 200 - 120 * std::exp(-u * u / 2)});
    shoal.push_back({r, 200 - 170 * std::exp(-v * v / 2)});
  }
  for (const BottomProfile& profile : {BottomProfile(steep), BottomProfile(shoal)}) {
    const std::size_t crest = profile.facet_at(2450), foot = profile.facet_at(1900);
    for (std::size_t i = foot; i <= crest; ++i) {
      EXPECT_EQ(profile.facets()[i].smooth_group, profile.facets()[foot].smooth_group) << i;
    }
  }
  const BottomProfile corner({{0, 200}, {100, 200}, {200, 200}, {300, 188}, {400, 176}, {500, 164}});
  EXPECT_FALSE(corner.facets()[corner.facet_at(150)].bent());
}

TEST(BottomProfile, SeenFromTheOtherEndIsTheSame) {
  const BottomProfile there = cosine_hill(50), back = there.reversed(3000);
  for (double r = -100; r < 3200; r += 37)
    EXPECT_NEAR(there.depth_at(r), back.depth_at(3000 - r), tolerance(1e-9));
}

TEST(BottomProfile, RefusesRangesThatDoNotRise) {
  EXPECT_THROW(BottomProfile({{0, 10}, {0, 20}}), InvalidArgument);
  EXPECT_THROW(BottomProfile(std::vector<ProfiledDepth>{}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
