// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/state_selection.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/config/config.h"
#include "core/archive.h"
#include "core/units.h"
#include "vehicle_sim/vehicle_sim_config.h"

namespace halocline::vehicle_sim {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr SimDuration kPeriod = SimDuration::from_milliseconds(100);

KinematicState at_rest() { return {}; }

// The ticks of `seconds` at which a motion's states are published.
std::vector<std::int64_t> ticks_of(const StateRule& rule, double seconds,
                                   const std::function<KinematicState(double t)>& motion) {
  StateSelection selection;
  std::vector<std::int64_t> ticks;
  for (std::int64_t tick = 0; static_cast<double>(tick) <= 10 * seconds; ++tick) {
    const SimTime when = SimTime() + kPeriod * tick;
    if (selection.take(rule, kPeriod, when, motion(when.seconds()))) ticks.push_back(tick);
  }
  return ticks;
}

KinematicState straight(double t) {
  KinematicState state;
  state.pose.position_ned_m = {1.5 * t, 0, 20};
  state.velocity_ned_mps = {1.5, 0, 0};
  return state;
}

// Free fall at a: the reckoning is off by a t^2 / 2.
KinematicState speeding_up(double t) {
  KinematicState state;
  state.pose.position_ned_m = {0.5 * t * t, 0, 20};
  state.velocity_ned_mps = {t, 0, 0};
  return state;
}

TEST(StateSelection, WithoutABoundEachTickHasAState) { EXPECT_EQ(ticks_of({}, 5, straight).size(), 51u); }

TEST(StateSelection, WhoRunsStraightOrRestsIsPublishedOncePerLongestSilence) {
  const StateRule rule{.deviation_m = 1e-6, .longest_silence = SimDuration::from_milliseconds(500)};
  const std::vector<std::int64_t> every_fifth{0, 5, 10, 15, 20};
  EXPECT_EQ(ticks_of(rule, 2, straight), every_fifth);
  EXPECT_EQ(ticks_of(rule, 2, [](double) { return at_rest(); }), every_fifth);
}

TEST(StateSelection, ASilenceBetweenTwoTicksEndsAtTheEarlier) {
  const StateRule rule{.deviation_m = 1, .longest_silence = SimDuration::from_milliseconds(350)};
  EXPECT_EQ(ticks_of(rule, 1, straight), (std::vector<std::int64_t>{0, 3, 6, 9}));
}

TEST(StateSelection, ASilenceBelowThePeriodIsAStateAtEachTick) {
  const StateRule rule{.deviation_m = 1, .longest_silence = SimDuration::from_milliseconds(10)};
  EXPECT_EQ(ticks_of(rule, 1, straight).size(), 11u);
}

// a t^2 / 2 exceeds 0.2 m after sqrt(0.4) s = 0.632 s: at the seventh tick.
TEST(StateSelection, WhoSpeedsUpIsPublishedWhenTheReckoningExceedsTheBound) {
  const StateRule rule{.deviation_m = 0.2, .longest_silence = SimDuration::from_milliseconds(60'000)};
  EXPECT_EQ(ticks_of(rule, 2.2, speeding_up), (std::vector<std::int64_t>{0, 7, 14, 21}));
}

// It turns on the spot at 10 deg/s from 1 s on; the state of rest is off by 3 degrees after more than 0.3 s.
TEST(StateSelection, TheAttitudeHasABoundOfItsOwn) {
  const auto turning = [](double t) {
    KinematicState state;
    state.pose.orientation = rotation_by(to_radians(10 * std::max(0.0, t - 1.0)) * Vec3::UnitZ());
    if (t > 1) state.angular_velocity_body_radps = {0, 0, to_radians(10)};
    return state;
  };
  const StateRule rule{.deviation_m = 1,
                       .deviation_rad = to_radians(2.5),
                       .longest_silence = SimDuration::from_milliseconds(60'000)};
  EXPECT_EQ(ticks_of(rule, 5, turning), (std::vector<std::int64_t>{0, 13}));
}

TEST(StateSelection, ItsLastStateIsPartOfWhatIsSaved) {
  const StateRule rule{.deviation_m = 0.2, .longest_silence = SimDuration::from_milliseconds(60'000)};
  StateSelection selection;
  ASSERT_TRUE(selection.take(rule, kPeriod, SimTime(), speeding_up(0)));
  Archive saved;
  saved(selection);
  StateSelection resumed;
  Archive(saved.bytes())(resumed);
  EXPECT_FALSE(resumed.take(rule, kPeriod, SimTime::from_seconds(0.6), speeding_up(0.6)));
  EXPECT_TRUE(resumed.take(rule, kPeriod, SimTime::from_seconds(0.7), speeding_up(0.7)));
}

VehicleSimConfig read(const std::string& text) {
  VehicleSimConfig config;
  bus::ConfigFile file = bus::ConfigFile::parse(text, "test.toml");
  file.read([&](bus::ConfigVisitor& v) { visit(v, config); });
  file.check(/*whole_file=*/false);
  return config;
}

std::string errors_of(const std::string& text) {
  try {
    read(text);
  } catch (const bus::ConfigErrors& errors) {
    return errors.what();
  }
  return "";
}

// Within the default time-outs: 5 s of the channel server, 1 s of the autopilot, 0.05 s for the way.
TEST(StateRule, StatesMayBeSilentAsLongAsNoReceiverLosesTheVehicle) {
  const auto with = [](const std::string& keys, const std::string& others = "") {
    return errors_of("[vehicle_sim]\nstate_deviation_m = 0.5\n" + keys + others);
  };
  EXPECT_EQ(with(""), "");
  EXPECT_EQ(with("state_longest_silence_s = 0.95\n"), "");
  EXPECT_THAT(
      with("state_longest_silence_s = 1\n"),
      AllOf(HasSubstr("test.toml:3: vehicle_sim.state_longest_silence_s is 1; allowed is at most 0.95 s"),
            HasSubstr("autopilot.state_timeout_s")));
  EXPECT_EQ(with("state_longest_silence_s = 2\n", "[autopilot]\nstate_timeout_s = 3\n"), "");
  EXPECT_THAT(
      with("state_longest_silence_s = 2\n",
           "[autopilot]\nstate_timeout_s = 3\n[channel_server]\nstate_timeout_s = 1.5\nstate_lag_s = 0.2\n"),
      HasSubstr("allowed is at most 1.3 s"));
  EXPECT_THAT(with("", "[autopilot]\nstate_timeout_s = 0.3\n"), HasSubstr("allowed is at most 0.25 s"));
  EXPECT_EQ(errors_of("[vehicle_sim]\nstate_longest_silence_s = 2\n"), "")
      << "without a bound it means nothing";
}

TEST(StateRule, ItIsReadIntoSiUnits) {
  const VehicleSimConfig config = read(
      "[vehicle_sim]\nstate_deviation_m = 0.3\nstate_deviation_deg = 5\nstate_longest_silence_s = 0.8\n");
  EXPECT_EQ(config.states.deviation_m, 0.3);
  EXPECT_EQ(config.states.deviation_rad, to_radians(5));
  EXPECT_EQ(config.states.longest_silence, SimDuration::from_milliseconds(800));
  EXPECT_THAT(errors_of("[vehicle_sim]\nstate_deviation_m = -1\n"), HasSubstr("allowed is 0 to 1000 m"));
  EXPECT_THAT(errors_of("[vehicle_sim]\nstate_longest_silence_s = 3\n"), HasSubstr("allowed is 0.01 to 2 s"));
}

}  // namespace
}  // namespace halocline::vehicle_sim
