// SPDX-License-Identifier: BSD-3-Clause
// Bubbles and waves along traced paths, against straight lines and against sums along arcs.
#include "acoustics/fading/near_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/ice_cover.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "acoustics/sea/surface/surface_boundary.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using halocline::testing::tolerance;

constexpr double kHz = 25'000;

RayWater water_of(std::vector<SpeedRow> rows) {
  return {std::move(rows), [](double) { return 5.0; }};
}
RayWater even() { return water_of({{0, 1500}, {kDeepestWater, 1500}}); }

std::vector<Eigenray> paths_in(const RayWater& water, const RayLink& link, double wind_mps,
                               double depth_m = 200) {
  const RaySea sea{
      water, BottomProfile::flat(depth_m), *sediment("SandyMud"), RaySurface{.wind_mps = wind_mps}, {}};
  return eigenrays(sea, link).paths;
}

const Eigenray& path_of(const std::vector<Eigenray>& paths, int surface, int bottom) {
  for (const Eigenray& path : paths)
    if (path.surface_bounces == surface && path.bottom_bounces == bottom) return path;
  ADD_FAILURE() << "no path of " << surface << " and " << bottom << " bounces";
  return paths.front();
}

TEST(NearSurface, AStraightPathLosesTheClosedForm) {
  const NearSurface surface = near_surface(14, kHz);
  for (const RayLink& link : {RayLink{0.5, 20, 500}, RayLink{20, 0.5, 500}, RayLink{3, 0.8, 60}}) {
    const Eigenray path = path_of(paths_in(even(), link, 14), 0, 0);
    const double straight =
        surface.bubbles.straight_loss_db(link.source_depth_m, link.receiver_depth_m, path.path_length_m);
    EXPECT_NEAR(crossing_of(surface, even(), link, path).bubble_db, std::min(straight, kMaxBubblePathDb),
                tolerance(1e-5));
  }
}

TEST(NearSurface, ALevelPathLosesTheLayersOwnAttenuation) {
  const RayLink link{0.5, 0.5, 500};
  const NearSurface calm = near_surface(3, kHz), gale = near_surface(14, kHz);
  const Eigenray path = path_of(paths_in(even(), link, 3), 0, 0);
  EXPECT_NEAR(crossing_of(calm, even(), link, path).bubble_db, calm.bubbles.db_per_m(0.5) * 500,
              tolerance(1e-9));
  EXPECT_EQ(crossing_of(gale, even(), link, path).bubble_db, kMaxBubblePathDb);
}

// From 0.5 m up, and down again to 20 m: two ways through the layer above, one through the rest.
TEST(NearSurface, ABounceNearAnEndLosesWhatItPasses) {
  const RayLink link{0.5, 20, 500};
  const NearSurface surface = near_surface(7, kHz);
  const Eigenray path = path_of(paths_in(even(), link, 7), 1, 0);
  const double length = path.path_length_m, up = length * 0.5 / 20.5, down = length - up;
  const double passed =
      surface.bubbles.straight_loss_db(0.5, 0, up) + surface.bubbles.straight_loss_db(0, 20, down);
  const double taken = path.surface_loss_db + crossing_of(surface, even(), link, path).bubble_db;
  EXPECT_NEAR(taken, passed, tolerance(1e-4));
}

TEST(NearSurface, BouncesBetweenDeepEndsStayAsTheyAre) {
  const RayLink link{20, 60, 800};
  for (const Eigenray& path : paths_in(even(), link, 14)) {
    const SurfaceCrossing crossing = crossing_of(near_surface(14, kHz), even(), link, path);
    EXPECT_NEAR(crossing.bubble_db, 0, tolerance(1e-4));
    EXPECT_EQ(crossing.clear_share, 1);
  }
}

// The loss summed over 200 000 steps along the arc of a ray that turns, with its curvature xi g.
double summed_along_arc(const NearSurface& surface, const RayLink& link, const Eigenray& path,
                        double surface_speed, double gradient) {
  constexpr int kSteps = 200'000;
  const double xi = std::cos(path.launch_angle_rad) / (surface_speed + gradient * link.source_depth_m);
  const double step = path.path_length_m / kSteps;
  double z = link.source_depth_m, angle = path.launch_angle_rad, loss = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double middle = angle - xi * gradient * step / 2;
    loss += surface.bubbles.db_per_m(z + std::sin(middle) * step / 2) * step;
    z += std::sin(middle) * step;
    angle -= xi * gradient * step;
  }
  return loss;
}

// Sound that rises from 4 m, turns below the surface (speed falls with depth) and comes down again, and sound
// that dips and turns below (speed rises with depth).
TEST(NearSurface, APathThatTurnsLosesWhatLiesAlongItsArc) {
  struct Turn {
    double gradient;
    RayLink link;
  };
  for (const Turn& turn : {Turn{-0.3, {4, 3, 300}}, Turn{-0.3, {2.5, 5, 200}}, Turn{0.2, {0.7, 0.9, 150}}}) {
    const double gradient = turn.gradient;
    const RayWater water =
        water_of({{0, 1500}, {100, 1500 + 100 * gradient}, {kDeepestWater, 1500 + 100 * gradient}});
    const NearSurface surface = near_surface(8, kHz);
    const Eigenray path = path_of(paths_in(water, turn.link, 8), 0, 0);
    EXPECT_EQ(path.identity.upper_turns + path.identity.lower_turns, 1) << gradient;
    const double summed = summed_along_arc(surface, turn.link, path, 1500, gradient);
    const SurfaceCrossing crossing = crossing_of(surface, water, turn.link, path);
    EXPECT_NEAR(crossing.bubble_db + path.surface_loss_db, std::min(summed, kMaxBubblePathDb),
                tolerance(0.002 * summed + 1e-4))
        << gradient;
  }
}

TEST(NearSurface, WavesBlockAPathWithoutABounceAtTheSurfaceAlone) {
  const RayLink link{1, 1, 500};
  const NearSurface surface = near_surface(10, kHz);
  const std::vector<Eigenray> paths = paths_in(even(), link, 10);
  EXPECT_NEAR(crossing_of(surface, even(), link, path_of(paths, 0, 0)).clear_share, 0.7659235052794936,
              tolerance(1e-9));
  for (const Eigenray& path : paths) {
    if (path.surface_bounces > 0) EXPECT_EQ(crossing_of(surface, even(), link, path).clear_share, 1);
  }
}

TEST(NearSurface, WithoutWindNothingHappens) {
  const RayLink link{0.1, 0.1, 100};
  for (const Eigenray& path : paths_in(even(), link, 0)) {
    const SurfaceCrossing crossing = crossing_of(near_surface(0, kHz), even(), link, path);
    EXPECT_EQ(crossing.bubble_db, 0);
    EXPECT_EQ(crossing.clear_share, 1);
  }
}

// p^2 P stays steady, (p - p^2) P becomes fast: of the power p P that arrives, p and 1 - p.
TEST(NearSurface, BehindCrestsTheSteadyShareFallsAndTheRestFadesFast) {
  const PathFading calm{.coherent = 0.8, .medium = 0.1, .scattered = 0.1, .doppler_spread_hz = 0.02};
  const double p = 0.7;
  const PathFading waves = behind_crests(calm, p, 1.2);
  EXPECT_NEAR(waves.coherent, 0.8 * p, tolerance(1e-15));
  EXPECT_NEAR(waves.medium, 0.1 * p, tolerance(1e-15));
  EXPECT_NEAR(waves.coherent + waves.medium + waves.scattered, 1, tolerance(1e-15));
  EXPECT_GT(waves.doppler_spread_hz, 0.1);
  EXPECT_LT(waves.doppler_spread_hz, 1.2 / (2 * std::numbers::pi));
  EXPECT_EQ(behind_crests(calm, 1, 1.2), calm);
}

TEST(NearSurface, TakenBubblesAreInTheAmplitudeAndInTheSurfaceLoss) {
  Eigenray path{.amplitude = 0.01, .surface_loss_db = 2};
  take_bubbles({.bubble_db = 6}, path);
  EXPECT_NEAR(path.amplitude, 0.01 * std::pow(10, -0.3), tolerance(1e-15));
  EXPECT_EQ(path.surface_loss_db, 8);
}

// Below fast ice scattered sound stays for hours between ends at rest.
TEST(FadingUnderIce, LivesForHoursWhereNothingMoves) {
  const FadingModel model{.enabled = true};
  const SurfaceBoundary fast = surface_boundary(0, {.kind = IceKind::kFast}, 10'000);
  const SurfaceBoundary pack = surface_boundary(0, {.kind = IceKind::kPack}, 10'000);
  const PathFading still = path_fading_below(model, fast, 10'000, 0.05, 0, 1, 0);
  EXPECT_GT(still.scattered, 0.9);  // Gamma^2 = (2 k 0.2)^2 0.05 = 14
  EXPECT_NEAR(coherence_time_of(still.doppler_spread_hz), kIceCoherenceS, tolerance(1e-6));
  const PathFading moving = path_fading_below(model, fast, 10'000, 0.05, 0, 1, 1);
  EXPECT_NEAR(coherence_time_of(moving.doppler_spread_hz), model.medium_coherence_s, tolerance(1e-9));
  const PathFading drifting = path_fading_below(model, pack, 10'000, 0.05, 0, 1, 0);
  EXPECT_NEAR(coherence_time_of(drifting.doppler_spread_hz), model.medium_coherence_s, tolerance(1e-9));
}

TEST(FadingUnderIce, OfWavesIsThatOfTheWind) {
  const FadingModel model{.enabled = true};
  EXPECT_EQ(path_fading_below(model, surface_boundary(7, {}, 25'000), 25'000, 0.01, 0.02, 1, 0),
            path_fading(model, 7, 25'000, 0.01, 0.02));
}

}  // namespace
}  // namespace halocline::acoustics
