// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/bottom_echo.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/link/link_budget.h"
#include "acoustics/link/transmission_loss.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

const Vec3 kFrom{0, 0, 20}, kTo{400, 0, 20};

LinkKernel model_with_cut_off(double cut_off_db, const Environment& sea = {}) {
  const Modem modem = generic_modem({160}, {cut_off_db}, 25e3, 5e3);
  return LinkKernel(sea, modem, modem);
}

// Whether the bottom, with these depths in equal parts of the line, sends an echo, whatever its level.
bool sends_echo(const std::vector<double>& parts_z_m, double ends_z_m = 20) {
  std::vector<double> bottom_z_m;
  for (const double z_m : parts_z_m) bottom_z_m.insert(bottom_z_m.end(), kReflectingOneIn, z_m);
  return is_echo_likely(model_with_cut_off(0), {0, 0, ends_z_m}, {400, 0, ends_z_m}, bottom_z_m);
}

TEST(BottomEcho, LevelMatchesTheImageMethodInUniformWater) {
  Environment sea;
  sea.profile = SoundSpeedProfile::isovelocity(1500, {10, 35});
  const LinkKernel model = model_with_cut_off(0, sea);
  const double image_m = std::hypot(400, 200);  // the receiver's image lies 100 m under the bottom
  const double alpha = model.absorption_db_per_km(20, 120);
  EXPECT_NEAR(echo_level(model, kFrom, kTo, {200, 0, 120}).value,
              160 - transmission_loss(image_m, sea.spreading_exponent, alpha).total.value, tolerance(1e-9));
}

TEST(BottomEcho, LevelIsTheLossLawOverTheWholeLength) {
  // Two straight legs in one line are one straight link: same absorption integral, same spreading.
  const LinkKernel model = model_with_cut_off(0);
  const Vec3 deep{400, 0, 220};
  EXPECT_NEAR(echo_level(model, kFrom, deep, {200, 0, 120}).value,
              model.budget(kFrom, deep, Capacity::kLeftOut).received_level.value, tolerance(1e-11));
}

TEST(BottomEcho, IsLikelyWhenAnyOpenPathExceedsTheCutOff) {
  const std::vector<double> bottom_z_m(kBottomDepths, 120);
  const double loudest = echo_level(model_with_cut_off(0), kFrom, kTo, {200, 0, 120}).value;
  EXPECT_TRUE(is_echo_likely(model_with_cut_off(loudest - 0.01), kFrom, kTo, bottom_z_m));
  // "Exceeds": at the cut-off itself it does not count.
  EXPECT_FALSE(is_echo_likely(model_with_cut_off(loudest), kFrom, kTo, bottom_z_m));
}

TEST(BottomEcho, AnEchoIsFainterThanTheDirectPath) {
  const LinkKernel model = model_with_cut_off(0);
  const Decibels direct = model.budget(kFrom, kTo, Capacity::kLeftOut).received_level;
  for (double north_m = 20; north_m < 400; north_m += 40)
    EXPECT_LT(echo_level(model, kFrom, kTo, {north_m, 0, 120}), direct) << north_m;
}

TEST(BottomEcho, ABottomThatStandsAboveALegBlocksIt) {
  EXPECT_TRUE(sends_echo({120, 120, 120}));
  // A wall in the middle hides each side's bottom from the far end, and its own top is seen by both.
  EXPECT_TRUE(sends_echo({120, 30, 120}));
  // Walls beside both ends: the bottom between them is hidden from both, each wall's top from the far end.
  EXPECT_FALSE(sends_echo({5, 120, 5}, 60));
  // A rise below one end hides nothing.
  EXPECT_TRUE(sends_echo({70, 120, 120}, 60));
}

TEST(BottomEcho, WithoutBottomAndOffLandThereIsNoEcho) {
  EXPECT_FALSE(sends_echo({}));
  EXPECT_FALSE(sends_echo({-3}));
}

TEST(BottomEcho, APointOnTheTransmitterLosesTheDirectLoss) {
  const LinkKernel model = model_with_cut_off(0);
  EXPECT_NEAR(echo_level(model, kFrom, kTo, kFrom).value,
              model.budget(kFrom, kTo, Capacity::kLeftOut).received_level.value, tolerance(1e-11));
  EXPECT_EQ(echo_level(model, kFrom, kFrom, kFrom).value, 160);
}

}  // namespace
}  // namespace halocline::acoustics
