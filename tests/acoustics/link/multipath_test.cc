// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/multipath.h"

#include <cmath>

#include <gtest/gtest.h>

#include "acoustics/link/link_budget.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/check.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

const Vec3 kFrom{0, 0, 20}, kTo{400, 0, 20};

BottomPoint flat_bottom_at(double north_m) { return {{north_m, 0, 120}, false, false}; }

LinkKernel model_with_cut_off(double cut_off_db) {
  const Modem modem = generic_modem({160}, {cut_off_db}, 25e3, 5e3);
  return LinkKernel(Environment{}, modem, modem);
}

TEST(Multipath, BouncePathMatchesTheImageMethodInIsovelocityWater) {
  Environment sea;
  sea.profile = SoundSpeedProfile::isovelocity(1500, {10, 35});
  const LinkKernel model(sea, Modem{}, Modem{});
  const EchoPath path = echo_path(model, kFrom, kTo, flat_bottom_at(200));
  const double image = std::hypot(400, 200);  // the receiver's image lies 100 m under the bottom
  EXPECT_NEAR(path.length_m, image, tolerance(1e-12));
  EXPECT_NEAR(path.delay_s, image / 1500, tolerance(1e-15));
}

TEST(Multipath, LevelIsTheLossLawOverTheWholeLength) {
  // Two straight legs in one line are one straight link: same absorption integral, same spreading.
  const LinkKernel model = model_with_cut_off(0);
  const Vec3 deep{400, 0, 220};
  const BottomPoint halfway{{200, 0, 120}, false, false};
  EXPECT_NEAR(echo_path(model, kFrom, deep, halfway).level.value,
              model.budget(kFrom, deep, Capacity::kLeftOut).received_level.value, tolerance(1e-11));
  EXPECT_NEAR(echo_path(model, kFrom, deep, halfway).delay_s,
              model.budget(kFrom, deep, Capacity::kLeftOut).delay_s, tolerance(1e-15));
}

TEST(Multipath, IsLikelyWhenAnyOpenPathExceedsTheCutOff) {
  const std::vector<BottomPoint> points = {flat_bottom_at(-300), flat_bottom_at(200), flat_bottom_at(900)};
  const double loudest = echo_path(model_with_cut_off(0), kFrom, kTo, points[1]).level.value;
  EXPECT_EQ(assess_echoes(model_with_cut_off(loudest - 0.01), kFrom, kTo, points).likelihood,
            EchoLikelihood::kLikely);
  // "Exceeds": at the cut-off itself it does not count.
  EXPECT_EQ(assess_echoes(model_with_cut_off(loudest), kFrom, kTo, points).likelihood,
            EchoLikelihood::kUnlikely);
}

TEST(Multipath, AnEchoIsFainterAndLaterThanTheDirectPath) {
  const LinkKernel model = model_with_cut_off(0);
  const LinkBudget direct = model.budget(kFrom, kTo, Capacity::kLeftOut);
  for (const double fraction : bottom_point_fractions(9)) {
    const EchoPath path = echo_path(model, kFrom, kTo, flat_bottom_at(400 * fraction));
    EXPECT_LT(path.level, direct.received_level) << fraction;
    EXPECT_GT(path.delay_s, direct.delay_s) << fraction;
  }
}

TEST(Multipath, ABlockedPathDoesNotCount) {
  const LinkKernel model = model_with_cut_off(0);
  BottomPoint point = flat_bottom_at(200);
  EXPECT_EQ(assess_echoes(model, kFrom, kTo, {point}).likelihood, EchoLikelihood::kLikely);
  point.blocked_from_transmitter = true;
  EXPECT_EQ(assess_echoes(model, kFrom, kTo, {point}).likelihood, EchoLikelihood::kUnlikely);
  point = flat_bottom_at(200);
  point.blocked_to_receiver = true;
  EXPECT_EQ(assess_echoes(model, kFrom, kTo, {point}).likelihood, EchoLikelihood::kUnlikely);
  EXPECT_EQ(assess_echoes(model, kFrom, kTo, {point, flat_bottom_at(100)}).likelihood,
            EchoLikelihood::kLikely);
}

TEST(Multipath, WithoutBottomThereIsNoEcho) {
  EXPECT_EQ(assess_echoes(model_with_cut_off(0), kFrom, kTo, {}).likelihood, EchoLikelihood::kUnlikely);
}

TEST(Multipath, APointOnTheTransmitterLosesTheDirectLoss) {
  const LinkKernel model = model_with_cut_off(0);
  EXPECT_NEAR(echo_path(model, kFrom, kTo, {kFrom, false, false}).level.value,
              model.budget(kFrom, kTo, Capacity::kLeftOut).received_level.value, tolerance(1e-11));
  EXPECT_EQ(echo_path(model, kFrom, kFrom, {kFrom, false, false}).level.value, 160);
}

TEST(Multipath, PointsSpreadEvenlyUnderTheLine) {
  EXPECT_EQ(bottom_point_fractions(1), std::vector<double>{0.5});
  EXPECT_EQ(bottom_point_fractions(2), (std::vector<double>{0.25, 0.75}));
  EXPECT_THROW(bottom_point_fractions(0), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
