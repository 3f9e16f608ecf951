// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/propagation.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/link/link_kernel.h"
#include "channel_server/propagation/straight_propagation.h"
#include "core/check.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::relative_error;
using halocline::testing::tolerance;
using testing::kSpeedMps;

acoustics::Modem modem_of_level(double level_db) {
  acoustics::Modem modem;
  modem.source_level = {level_db};
  return modem;
}

LinkEnd end_at(const Vec3& position, const acoustics::Modem& modem, const Vec3& velocity = Vec3::Zero()) {
  return {0, position, velocity, &modem};
}

Arrival path_of(double delay_s, double level_db) {
  Arrival path;
  path.delay_s = delay_s;
  path.level = {level_db};
  return path;
}

TEST(StraightPropagation, AnswersAsTheLinkBudgetOfTheTwoModems) {
  const acoustics::Environment water;
  StraightPropagation propagation(water);
  const auto quiet = modem_of_level(160), loud = modem_of_level(190);
  const Vec3 from(0, 0, 40), to(900, -300, 700);
  for (int turn = 0; turn < 2; ++turn) {  // the second time from what was kept
    const auto reception = propagation.reception(SimTime(), end_at(from, quiet), end_at(to, loud));
    const auto expected = link_budget(water, quiet, loud, from, to);
    EXPECT_EQ(reception.budget.received_level.value, expected.received_level.value);
    EXPECT_EQ(reception.budget.capacity_bps, expected.capacity_bps);
  }
}

TEST(StraightPropagation, GivesOnePathWithTheDelayAndLevelOfTheBudget) {
  StraightPropagation propagation(acoustics::Environment{});
  const acoustics::Modem modem;
  const auto reception =
      propagation.reception(SimTime(), end_at({0, 0, 40}, modem), end_at({300, 400, 540}, modem));
  EXPECT_EQ(reception.state, PathState::kOpen);
  EXPECT_EQ(reception.used, PropagationUsed::kStraight);
  EXPECT_EQ(reception.delay_spread_s, 0);
  ASSERT_EQ(reception.paths.size(), 1u);
  const Arrival& path = reception.paths[0];
  EXPECT_EQ(path.delay_s, reception.budget.delay_s);
  EXPECT_EQ(path.level, reception.budget.received_level);
  // 500 m across and 500 m down.
  EXPECT_NEAR(path.launch_angle_rad, std::numbers::pi / 4, tolerance(1e-12));
  EXPECT_NEAR(path.arrival_angle_rad, std::numbers::pi / 4, tolerance(1e-12));
}

// f_rx / f_tx = (c - v_rx) / (c - v_tx), velocities along the path.
TEST(StraightPropagation, TheDopplerFactorIsThatOfTheVelocitiesAlongThePath) {
  StraightPropagation propagation(testing::even_water());
  const acoustics::Modem modem;
  const auto reception = propagation.reception(SimTime(), end_at({0, 0, 50}, modem, {3, 9, 0}),
                                               end_at({800, 0, 50}, modem, {-2, 0, 1}));
  EXPECT_NEAR(reception.paths[0].doppler_factor, (kSpeedMps + 2) / (kSpeedMps - 3), tolerance(1e-14));
}

TEST(StraightPropagation, ModemsOfTwoFamiliesShareNoModel) {
  StraightPropagation propagation(acoustics::Environment{});
  const acoustics::Modem modem = modem_of_level(190);
  acoustics::Modem foreign = modem;
  foreign.family = "whistle";
  const auto receivable = [&](const acoustics::Modem& receiver) {
    return propagation.reception(SimTime(), end_at({0, 0, 40}, modem), end_at({100, 0, 40}, receiver))
        .budget.receivable;
  };
  EXPECT_TRUE(receivable(modem));
  EXPECT_FALSE(receivable(foreign));
}

TEST(StraightPropagation, EqualModemsShareOneModel) {
  StraightPropagation propagation(acoustics::Environment{});
  const auto model = [&](double transmitter_db, double receiver_db) {
    return propagation.kernel_of(SimTime(), modem_of_level(transmitter_db), modem_of_level(receiver_db));
  };
  const auto first = model(180, 180);
  EXPECT_EQ(model(180, 180), first);
  EXPECT_NE(model(181, 180), first);
  EXPECT_EQ(model(180, 180), first);
}

TEST(StraightPropagation, TheModelUsedLeastRecentlyMakesRoom) {
  StraightPropagation propagation(acoustics::Environment{}, /*max_kernels=*/3);
  const acoustics::Modem receiver;
  std::vector<std::weak_ptr<const acoustics::LinkKernel>> models;
  for (int level = 150; level < 170; ++level) {
    const auto transmitter = modem_of_level(level);
    const auto reception =
        propagation.reception(SimTime(), end_at({0, 0, 1}, transmitter), end_at({1, 0, 1}, receiver));
    // At 1 m, absorption alone is lost.
    EXPECT_NEAR(reception.budget.received_level.value, level, tolerance(1e-2));
    models.push_back(propagation.kernel_of(SimTime(), transmitter, receiver));
    const auto kept = std::count_if(models.begin(), models.end(), [](const auto& m) { return !m.expired(); });
    EXPECT_LE(kept, 3);
  }
}

TEST(StraightPropagation, AnImpossibleModemIsRefusedEachTime) {
  StraightPropagation propagation(acoustics::Environment{});
  const acoustics::Modem impossible = modem_of_level(900), modem;
  for (int i = 0; i < 2; ++i) {
    EXPECT_THROW(propagation.reception(SimTime(), end_at({0, 0, 1}, impossible), end_at({1, 0, 1}, modem)),
                 InvalidArgument);
  }
}

TEST(Paths, TheFirstSignificantOneLiesWithinTwentyDecibelsOfTheStrongest) {
  EXPECT_EQ(first_significant({path_of(1, 79.9), path_of(2, 80.1), path_of(3, 100)}), 1u);
  EXPECT_EQ(first_significant({path_of(1, 80.1), path_of(3, 100), path_of(4, 90)}), 0u);
  EXPECT_EQ(first_significant({path_of(1, -50)}), 0u);
}

TEST(Paths, TheDelaySpreadRunsFromTheFirstSignificantPathToTheLast) {
  EXPECT_NEAR(
      delay_spread_s({path_of(1, 79), path_of(2, 81), path_of(3, 100), path_of(3.5, 85), path_of(9, 60)}),
      1.5, tolerance(1e-12));
  EXPECT_EQ(delay_spread_s({path_of(1, 80)}), 0);
  EXPECT_EQ(delay_spread_s({}), 0);
}

TEST(Paths, PowersAddAndNothingIsSilence) {
  EXPECT_NEAR(total_level({path_of(1, 80), path_of(2, 80)}).value, 80 + 10 * std::log10(2), tolerance(1e-12));
  EXPECT_EQ(total_level({}), kSilence);
  EXPECT_EQ(total_level({path_of(1, -4000)}), kSilence);
}

}  // namespace
}  // namespace halocline::channel_server
