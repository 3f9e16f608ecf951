// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/ray_propagation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "acoustics/link/link_budget.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "channel_server/links/link_table.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/random.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::relative_error;
using halocline::testing::tolerance;
using testing::at_s;
using testing::even_water;
using testing::kSpeedMps;

constexpr double kDepthM = 100;

std::shared_ptr<const SeabedProfile> flat(double depth_m = kDepthM) {
  return std::make_shared<const SeabedProfile>(SeabedProfile::flat(depth_m));
}

class RayPropagationTest : public ::testing::Test {
 protected:
  static LinkEnd end(const Vec3& position, const acoustics::Modem& modem, VehicleId id = 0,
                     const Vec3& velocity = Vec3::Zero()) {
    return {id, position, velocity, &modem};
  }
  static RayPropagation rays(const RayModel& model, const acoustics::Environment& water = even_water(),
                             std::shared_ptr<SeabedMap> seabed = nullptr) {
    if (!seabed) seabed = std::make_shared<SeabedMap>(SeabedRule{});
    return {std::make_shared<EnvironmentTimeline>(water), seabed, model};
  }
  Reception over_flat(const RayModel& model, const Vec3& from, const Vec3& to) {
    auto propagation = rays(model);
    return propagation.reception_over(at_s(0), end(from, modem_), end(to, modem_), flat());
  }

  acoustics::Modem modem_;
};

// The closed form of images between a surface of R = -1 and the bottom's own coefficient: path (s, b) has the
// length of the straight line to the image at depth 2 b H +- z_r, and loses |V|^b at the grazing angle of
// that line.
TEST_F(RayPropagationTest, LevelsAndDelaysOverAFlatBottomAreThoseOfTheImages) {
  RayModel model;
  model.surface = acoustics::SurfaceModel::kFlat;
  const Vec3 from(0, 0, 30), to(600, 800, 55);
  const double range_m = 1000;
  const Reception reception = over_flat(model, from, to);
  const auto water = even_water();
  const double khz_squared = 25 * 25;
  double power = 0;
  std::size_t found = 0;
  for (int bottom = 0; bottom <= 2; ++bottom) {
    for (int surface = std::max(0, bottom - 1); surface <= bottom + 1; ++surface) {
      for (const int first_down : {0, 1}) {
        if (surface == bottom && surface == 0 && first_down == 1) continue;
        if (surface > bottom && first_down == 1) continue;
        if (surface < bottom && first_down == 0) continue;
        // Height of the unfolded path: every bounce at the bottom adds twice the depth below.
        const double up = first_down == 0 && surface > 0 ? -1 : 1;
        double rise = 0;
        if (surface == bottom) {
          rise = surface == 0 ? to.z() - from.z() : up * 2 * kDepthM * bottom + (to.z() - from.z());
        } else {
          rise = surface > bottom ? -2 * kDepthM * bottom - from.z() - to.z()
                                  : 2 * kDepthM * bottom - from.z() - to.z();
        }
        const double length = std::hypot(range_m, rise);
        const double bounce =
            bottom_reflection(model.bottom, std::asin(std::abs(rise) / length), kSpeedMps).magnitude;
        const auto path = std::find_if(reception.paths.begin(), reception.paths.end(), [&](const Arrival& p) {
          return std::abs(p.delay_s - length / kSpeedMps) < 1e-9;
        });
        if (std::pow(bounce, bottom) < 0.005) continue;
        ASSERT_NE(path, reception.paths.end()) << surface << " " << bottom << " " << first_down;
        EXPECT_EQ(path->surface_bounces, surface);
        EXPECT_EQ(path->bottom_bounces, bottom);
        // Absorption of water of one temperature changes with depth by pressure alone: 0.04 dB over these
        // paths.
        const double absorbed = length / 1000 * absorption_spectrum_at(water, 50).db_per_km(khz_squared);
        const double expected = 185 - 20 * std::log10(length) + 20 * bottom * std::log10(bounce) - absorbed;
        EXPECT_NEAR(path->level.value, expected, tolerance(0.05));
        ++found;
      }
    }
  }
  EXPECT_GE(found, 7u);
  for (const Arrival& path : reception.paths) power += to_power_ratio(path.level).value;
  EXPECT_NEAR(reception.budget.received_level.value, to_decibels(PowerRatio{power}).value, tolerance(1e-9));
}

TEST_F(RayPropagationTest, TheBudgetHangsTogether) {
  const Reception reception = over_flat({}, {0, 0, 30}, {2000, 0, 60});
  const acoustics::LinkBudget& b = reception.budget;
  EXPECT_EQ(reception.used, PropagationUsed::kRays);
  EXPECT_EQ(reception.state, PathState::kOpen);
  EXPECT_NEAR(b.transmission_loss.value, 185 - b.received_level.value, tolerance(1e-9));
  EXPECT_NEAR(b.snr.value, b.received_level.value - b.noise_level.value, tolerance(1e-9));
  EXPECT_EQ(b.delay_s, reception.paths[first_significant(reception.paths)].delay_s);
  EXPECT_TRUE(b.receivable);
}

// In deep water of one speed, near the middle, the direct path alone remains: spherical spreading.
TEST_F(RayPropagationTest, WithOnePathTheBudgetIsThatOfSphericalSpreading) {
  RayModel model;
  model.options.max_bounces = 0;
  auto water = even_water();
  water.spreading_exponent = 2;
  // As many rows as keep the rays' parabola of absorption within each layer true to pressure.
  std::vector<acoustics::SpeedRow> rows;
  for (double depth = 0; depth <= 5000; depth += 250) rows.push_back({depth, kSpeedMps});
  water.profile = acoustics::SoundSpeedProfile::from_speeds(rows, {10, 35});
  auto propagation = rays(model, water);
  const Vec3 from(0, 0, 2000), to(1500, 0, 2100);
  const auto rays =
      propagation.reception_over(at_s(0), end(from, modem_), end(to, modem_), flat(5000)).budget;
  const auto straight = link_budget(water, modem_, modem_, from, to);
  EXPECT_LT(relative_error(rays.delay_s, straight.delay_s), tolerance(1e-9));
  EXPECT_NEAR(rays.received_level.value, straight.received_level.value, tolerance(1e-3));
  EXPECT_NEAR(rays.snr.value, straight.snr.value, tolerance(1e-3));
  EXPECT_LT(relative_error(rays.capacity_bps, straight.capacity_bps), tolerance(1e-4));
}

TEST_F(RayPropagationTest, BothWaysHaveTheSamePathsToTheLastBit) {
  const auto seabed =
      testing::seabed_around({0, 0, 30}, {1000, 0, 60}, [](double north_m) { return 150 - north_m / 25; });
  auto propagation = rays({}, acoustics::Environment{}, seabed);
  const LinkEnd a = end({0, 0, 30}, modem_, 1), b = end({1000, 0, 60}, modem_, 2);
  testing::expect_same_paths(propagation.reception(at_s(1), a, b), propagation.reception(at_s(1), b, a));
  EXPECT_EQ(propagation.searches(), 1);
}

TEST_F(RayPropagationTest, WithoutAKnownBottomThePathIsMarkedStraight) {
  auto propagation = rays({});
  const LinkEnd a = end({0, 0, 30}, modem_, 1), b = end({1000, 0, 60}, modem_, 2);
  const Reception reception = propagation.reception(at_s(1), a, b);
  EXPECT_EQ(reception.used, PropagationUsed::kStraightWithoutBottom);
  EXPECT_EQ(reception.paths.size(), 1u);
  EXPECT_EQ(
      reception.budget.received_level.value,
      link_budget(even_water(), modem_, modem_, a.position_ned_m, b.position_ned_m).received_level.value);
}

TEST_F(RayPropagationTest, ARidgeUpToTheSurfaceBlocks) {
  SeabedProfile ridge{0, 25, std::vector<double>(41, 100.0)};
  ridge.z_m[20] = -5;
  RayModel model;
  model.shadow_loss = Decibels{90};
  auto propagation = rays(model);
  const auto reception =
      propagation.reception_over(at_s(0), end({0, 0, 30}, modem_), end({1000, 0, 60}, modem_),
                                 std::make_shared<const SeabedProfile>(ridge));
  EXPECT_EQ(reception.state, PathState::kBlocked);
  EXPECT_TRUE(reception.paths.empty());
  EXPECT_FALSE(reception.budget.receivable);
  EXPECT_EQ(reception.budget.received_level, kSilence);
}

// Speed falls with depth by 1 /s: rays bend down with a radius of 1500 m, so none that misses the absorbing
// bottom gets to a shallow receiver some kilometres away.
TEST_F(RayPropagationTest, WhereNoRayGetsIsAShadowWithTheStatedLevel) {
  acoustics::Environment water;
  water.profile = acoustics::SoundSpeedProfile::from_speeds({{0, 1540}, {400, 1460}}, {10, 35});
  RayModel model;
  model.options.max_bounces = 0;
  for (const bool stated : {false, true}) {
    if (stated) model.shadow_loss = Decibels{95};
    auto propagation = rays(model, water);
    const auto reception =
        propagation.reception_over(at_s(0), end({0, 0, 20}, modem_), end({5000, 0, 20}, modem_), flat(400));
    EXPECT_EQ(reception.state, PathState::kShadow);
    EXPECT_FALSE(reception.budget.receivable);
    EXPECT_NEAR(reception.budget.received_level.value, stated ? 185 - 95 : kSilence.value, tolerance(1e-9));
    EXPECT_NEAR(reception.budget.delay_s, 5000 / water.profile.sound_speed_mps(20), tolerance(1e-9));
  }
}

TEST_F(RayPropagationTest, WithoutAPathTheStateIsTheCause) {
  RayModel steep, weak;
  steep.options.max_launch_angle_rad = to_radians(1);
  steep.options.keep_steep_direct = false;
  weak.options.min_amplitude = 0.5;
  weak.shadow_loss = steep.shadow_loss = Decibels{95};
  const Reception too_steep = over_flat(steep, {0, 0, 30}, {100, 0, 90});
  EXPECT_EQ(too_steep.state, PathState::kTooSteep);
  EXPECT_EQ(too_steep.budget.received_level, kSilence);
  const Reception too_weak = over_flat(weak, {0, 0, 30}, {100, 0, 90});
  EXPECT_EQ(too_weak.state, PathState::kTooWeak);
  EXPECT_NEAR(too_weak.budget.received_level.value, 185 - 95, tolerance(1e-9));
  for (const Reception& reception : {too_steep, too_weak}) {
    EXPECT_TRUE(reception.paths.empty());
    EXPECT_FALSE(reception.budget.receivable);
  }
}

TEST_F(RayPropagationTest, TheLevelIsThatOfAMetreBelowOneAndTheDelayThatOfTheDistance) {
  for (const double off_m : {0.0, 0.001, 0.5}) {
    for (const double reuse_m : {0.0, 5.0}) {
      RayModel model;
      model.reuse_distance_m = reuse_m;
      const Reception reception = over_flat(model, {0, 0, 30}, {off_m, 0, 30});
      EXPECT_EQ(reception.state, PathState::kOpen);
      // The direct path at 1 m, and echoes 30 dB and more below.
      EXPECT_NEAR(reception.budget.received_level.value, 185, 0.05) << off_m;
      EXPECT_NEAR(reception.budget.delay_s, off_m / kSpeedMps, tolerance(1e-9)) << off_m;
      EXPECT_NEAR(reception.budget.mean_sound_speed_mps, kSpeedMps, tolerance(1e-6)) << off_m;
    }
  }
}

TEST_F(RayPropagationTest, MultipathIsLikelyWhenAPathOffTheBottomIsAboveTheCutoff) {
  const Reception reception = over_flat({}, {0, 0, 30}, {500, 0, 60});
  Decibels loudest = kSilence;
  for (const Arrival& path : reception.paths) {
    if (path.bottom_bounces > 0) loudest = std::max(loudest, path.level);
  }
  EXPECT_EQ(multipath_of(reception, loudest - Decibels{0.1}), Multipath::kLikely);
  EXPECT_EQ(multipath_of(reception, loudest + Decibels{0.1}), Multipath::kUnlikely);
}

TEST_F(RayPropagationTest, EachPathHasTheDopplerOfItsAngles) {
  auto propagation = rays({});
  const double speed = 3;
  const auto reception = propagation.reception_over(at_s(0), end({0, 0, 50}, modem_, 0, {speed, 0, 0}),
                                                    end({400, 0, 50}, modem_), flat());
  for (const Arrival& path : reception.paths) {
    const double along = speed * std::cos(path.launch_angle_rad);
    EXPECT_NEAR(path.doppler_factor, 1 / (1 - along / kSpeedMps), tolerance(1e-9));
  }
  ASSERT_GT(reception.paths.size(), 2u);
  EXPECT_GT(reception.paths.front().doppler_factor, reception.paths.back().doppler_factor);
}

TEST_F(RayPropagationTest, ANamedSolverIsUsedWhereItCan) {
  RayModel model;
  model.solver = acoustics::RaySolver::kArcs;
  const Reception arcs = over_flat(model, {0, 0, 30}, {1000, 0, 60});
  const Reception images = over_flat({}, {0, 0, 30}, {1000, 0, 60});
  EXPECT_NEAR(arcs.budget.received_level.value, images.budget.received_level.value, tolerance(1e-3));
  model.solver = acoustics::RaySolver::kImages;
  const SeabedProfile slope{0, 1000, {100, 90}};
  auto propagation = rays(model);
  EXPECT_NO_THROW(propagation.reception_over(at_s(0), end({0, 0, 30}, modem_), end({1000, 0, 60}, modem_),
                                             std::make_shared<const SeabedProfile>(slope)));
}

TEST_F(RayPropagationTest, EndsAboveTheSurfaceAndBelowTheBottomAreAnsweredToo) {
  for (const double z : {-3.0, 0.0, 99.99, 100.0, 130.0}) {
    const Reception reception = over_flat({}, {0, 0, 30}, {500, 0, z});
    EXPECT_TRUE(std::isfinite(reception.budget.received_level.value)) << z;
    EXPECT_GT(reception.budget.delay_s, 0) << z;
  }
  EXPECT_TRUE(std::isfinite(over_flat({}, {0, 0, 30}, {0, 0, 30}).budget.received_level.value));
  EXPECT_TRUE(std::isfinite(over_flat({}, {0, 0, 30}, {0, 0, 70}).budget.received_level.value));
}

// A pool as simple as can be: odd numbers on another thread.
void on_two_threads(std::size_t count, const std::function<void(std::size_t)>& body) {
  std::thread odd([&] {
    for (std::size_t i = 1; i < count; i += 2) body(i);
  });
  for (std::size_t i = 0; i < count; i += 2) body(i);
  odd.join();
}

TEST_F(RayPropagationTest, TwoThreadsGiveTheSameBitsAsOneAndAsOneByOne) {
  auto seabed = std::make_shared<SeabedMap>(SeabedRule{});
  std::vector<PlacedVehicle> vehicles(6);
  for (int i = 0; i < 6; ++i) {
    vehicles[i].id = i + 1;
    vehicles[i].placement.position_ned_m = {300.0 * i, 170.0 * (i % 3), 20 + 7.0 * i};
  }
  vehicles[5].placement.position_ned_m.x() = 90'000;  // far from all that is known
  testing::survey(*seabed, {-300, 150, 0}, {1500, 150, 0},
                  [](const Vec3& place) { return 120 + 0.02 * place.x(); });
  testing::survey(*seabed, {-300, 350, 0}, {1500, 350, 0},
                  [](const Vec3& place) { return 120 + 0.02 * place.x(); });
  std::vector<EndPair> links;
  for (const auto& a : vehicles) {
    for (const auto& b : vehicles) {
      if (a.id == b.id) continue;
      links.push_back(
          {end(a.placement.position_ned_m, modem_, a.id), end(b.placement.position_ned_m, modem_, b.id)});
    }
  }
  auto one = rays({}, acoustics::Environment{}, seabed), two = rays({}, acoustics::Environment{}, seabed),
       in_turn = rays({}, acoustics::Environment{}, seabed);
  const auto expected = one.receptions(at_s(1), links, one_after_the_other);
  const auto shared = two.receptions(at_s(1), links, on_two_threads);
  EXPECT_EQ(one.searches(), 10);
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Reception alone = in_turn.reception(at_s(1), links[i].from, links[i].to);
    for (const Reception* other : {&shared[i], &alone}) {
      EXPECT_EQ(expected[i].budget.received_level.value, other->budget.received_level.value);
      EXPECT_EQ(expected[i].budget.capacity_bps, other->budget.capacity_bps);
      EXPECT_EQ(expected[i].paths.size(), other->paths.size());
      EXPECT_EQ(expected[i].used, other->used);
    }
  }
}

}  // namespace
}  // namespace halocline::channel_server
