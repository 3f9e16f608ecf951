#include "channel_server/propagation.h"

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::relative_error;
using halocline::testing::tolerance;

acoustics::Modem modem_of_level(double level_db) {
  acoustics::Modem modem;
  modem.source_level = {level_db};
  return modem;
}

TEST(StraightPropagation, AnswersAsTheLinkModelOfTheTwoModems) {
  const acoustics::Environment water;
  StraightPropagation propagation(water);
  const auto quiet = modem_of_level(160), loud = modem_of_level(190);
  const Vec3 from(0, 0, 40), to(900, -300, 700);
  for (int turn = 0; turn < 2; ++turn) {  // the second time from what was kept
    const auto budget = propagation.budget(quiet, loud, from, to);
    const auto expected = link_budget(water, quiet, loud, from, to);
    EXPECT_EQ(budget.received_level.value, expected.received_level.value);
    EXPECT_EQ(budget.capacity_bps, expected.capacity_bps);
  }
}

TEST(StraightPropagation, TheDelayIsThatOfTheBudget) {
  StraightPropagation propagation(acoustics::Environment{});
  const Vec3 from(0, 0, 40), to(900, -300, 700);
  const double budget_delay_s = propagation.budget({}, {}, from, to).delay_s;
  // Both integrate ds / c by the same quadrature.
  EXPECT_LT(relative_error(propagation.delay_s(from, to), budget_delay_s), tolerance(1e-13));
}

TEST(StraightPropagation, EqualModemsShareOneModel) {
  StraightPropagation propagation(acoustics::Environment{});
  for (int i = 0; i < 5; ++i)
    propagation.budget(modem_of_level(180), modem_of_level(180), {0, 0, 1}, {9, 0, 1});
  EXPECT_EQ(propagation.models_kept(), 1u);
  propagation.budget(modem_of_level(181), modem_of_level(180), {0, 0, 1}, {9, 0, 1});
  EXPECT_EQ(propagation.models_kept(), 2u);
}

TEST(StraightPropagation, TheModelAskedLongestAgoMakesRoom) {
  StraightPropagation propagation(acoustics::Environment{}, /*most_models=*/3);
  for (int level = 150; level < 170; ++level) {
    const auto budget = propagation.budget(modem_of_level(level), {}, {0, 0, 1}, {1, 0, 1});
    EXPECT_NEAR(budget.received_level.value, level, tolerance(1e-2));  // at 1 m, absorption alone is lost
    EXPECT_LE(propagation.models_kept(), 3u);
  }
}

TEST(StraightPropagation, AnImpossibleModemIsRefusedAndNothingKept) {
  StraightPropagation propagation(acoustics::Environment{});
  EXPECT_THROW(propagation.budget(modem_of_level(900), {}, {0, 0, 1}, {1, 0, 1}), InvalidArgument);
  EXPECT_EQ(propagation.models_kept(), 0u);
}

}  // namespace
}  // namespace halocline::channel_server
