// SPDX-License-Identifier: BSD-3-Clause
// States by dead reckoning: what receivers who carry the last state on see of a vehicle that manoeuvres.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/frames.h"
#include "core/sim_time.h"
#include "core/state_extrapolation.h"
#include "core/units.h"
#include "tests/bus/runtime/journal_files.h"
#include "tests/support/tolerance.h"
#include "tests/vehicle_sim/client_messages.h"
#include "tests/vehicle_sim/vehicle_sim_node_fixture.h"
#include "vehicle_sim/state_selection.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;

constexpr std::int64_t kEnd_ms = 60'000;
constexpr SimDuration kPeriod = SimDuration::from_milliseconds(100);

double speed_difference_mps(const vehicle_state_t& a, const vehicle_state_t& b) {
  return (kinematics_in(a).velocity_ned_mps - kinematics_in(b).velocity_ned_mps).norm();
}

class ReckonedStates : public VehicleSimNodeTest {
 protected:
  // Spirals down to port and to starboard by turns, with its propeller now fast, now slow.
  std::vector<vehicle_state_t> manoeuvre(const StateRule& rule, SimDuration period) {
    config_.states = rule;
    config_.state_period = period;
    states_.clear();
    now_ = SimTime();
    make_node();
    for (std::int64_t ms = 0; ms < kEnd_ms; ms += 1000) {
      run_until(at_ms(ms));
      const double turn = (ms / 7000) % 2 == 0 ? 0.25 : -0.2;
      command(at_ms(ms), {turn, ms % 11'000 < 4000 ? 0.1 : -0.05, ms % 17'000 < 9000 ? 25.0 : 12.0});
    }
    run_until(at_ms(kEnd_ms));
    return states_["sub"];
  }
};

struct Seen {
  double off_m = 0, off_rad = 0;
  double allowed_m = 0;  // beside the bound
};

// At each true state: the error of the reckoning from the last state published `delay` ago or earlier, the
// greatest, and what its place may be off beyond the bound, |v - u| (T + delay), likewise.
Seen seen_by_receiver(const std::vector<vehicle_state_t>& truth,
                      const std::vector<vehicle_state_t>& published, SimDuration period, SimDuration delay) {
  Seen seen;
  std::size_t last = 0;
  for (const vehicle_state_t& state : truth) {
    const SimTime now = SimTime::from_utime(state.utime);
    while (last + 1 < published.size() && SimTime::from_utime(published[last + 1].utime) + delay <= now)
      ++last;
    const KinematicState known = kinematics_in(published[last]), true_state = kinematics_in(state);
    const Pose carried = reckoned(known, now - SimTime::from_utime(published[last].utime)).pose;
    seen.off_m = std::max(seen.off_m, (true_state.pose.position_ned_m - carried.position_ned_m).norm());
    seen.off_rad = std::max(seen.off_rad, angle_between(true_state.pose.orientation, carried.orientation));
    seen.allowed_m =
        std::max(seen.allowed_m, (period + delay).seconds() * speed_difference_mps(state, published[last]));
  }
  return seen;
}

TEST_F(ReckonedStates, AtTheTicksTheReckoningIsWithinTheBounds) {
  const auto truth = manoeuvre({}, kPeriod);
  std::size_t most = truth.size();
  for (const double bound_m : {0.02, 0.1, 0.5}) {
    const StateRule rule{.deviation_m = bound_m,
                         .deviation_rad = to_radians(200 * bound_m),
                         .longest_silence = SimDuration::from_milliseconds(2000)};
    const auto published = manoeuvre(rule, kPeriod);
    const Seen seen = seen_by_receiver(truth, published, kPeriod, SimDuration());
    EXPECT_LE(seen.off_m, rule.deviation_m);
    EXPECT_LE(seen.off_rad, rule.deviation_rad);
    EXPECT_GT(std::max(seen.off_m / rule.deviation_m, seen.off_rad / rule.deviation_rad), 0.8);
    EXPECT_LT(published.size(), most) << "a wider bound, fewer states";
    most = published.size();
  }
  EXPECT_LT(most, truth.size() / 4);
}

// The truth at each step of the physics; a state takes 50 ms to its receiver.
TEST_F(ReckonedStates, InBetweenTheErrorGrowsByTheDifferenceOfVelocitiesAlone) {
  const auto truth = manoeuvre({}, SimDuration::from_milliseconds(10));
  const SimDuration delay = SimDuration::from_milliseconds(50);
  for (const double bound_m : {0.02, 0.1, 0.5}) {
    const StateRule rule{.deviation_m = bound_m,
                         .deviation_rad = to_radians(180),
                         .longest_silence = SimDuration::from_milliseconds(2000)};
    const Seen seen = seen_by_receiver(truth, manoeuvre(rule, kPeriod), kPeriod, delay);
    EXPECT_GT(seen.off_m, bound_m) << "nothing accrued: the test is too easy";
    EXPECT_LE(seen.off_m, bound_m + seen.allowed_m);
  }
}

TEST_F(ReckonedStates, TheMotionDoesNotDependOnWhichStatesArePublished) {
  const auto all = manoeuvre({}, kPeriod);
  const auto some = manoeuvre({.deviation_m = 0.1}, kPeriod);
  ASSERT_LT(some.size(), all.size());
  for (const vehicle_state_t& state : some) {
    const vehicle_state_t& same = all.at(static_cast<std::size_t>(state.utime / 100'000));
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(state.position_ned_m[axis], same.position_ned_m[axis]);
  }
}

TEST_F(ReckonedStates, TheirNumbersHaveNoGapsAndTheirSilencesAreShort) {
  const auto states = manoeuvre({.deviation_m = 0.1}, kPeriod);
  for (std::size_t k = 1; k < states.size(); ++k) {
    EXPECT_EQ(states[k].sequence, static_cast<std::int64_t>(k));
    EXPECT_LE(states[k].utime - states[k - 1].utime, 500'000);
  }
}

TEST_F(ReckonedStates, AFixedVehicleIsPublishedOncePerLongestSilence) {
  config_.states = {.deviation_m = 0.01, .longest_silence = SimDuration::from_milliseconds(800)};
  make_node();
  run_until(at_ms(8000));
  ASSERT_EQ(states_["buoy"].size(), 11u);
  for (std::size_t k = 0; k < 11; ++k)
    EXPECT_EQ(states_["buoy"][k].utime, static_cast<std::int64_t>(k) * 800'000);
}

TEST_F(ReckonedStates, AfterAKillTheReckoningGoesOnFromTheLastStatePublished) {
  config_.states = {.deviation_m = 0.05, .longest_silence = SimDuration::from_milliseconds(2000)};
  const auto run = [&](bool is_killed) {
    states_.clear();
    now_ = SimTime();
    const bus::testing::JournalFiles files;
    const auto start = [&] {
      make_node();
      node_->enable_repair();
      node_->keep_state_in(files.open());
    };
    start();
    run_until(at_ms(0));
    command(at_ms(0), {0.2, 0.05, 20});
    run_until(at_ms(3000));
    if (is_killed) {
      node_.reset();
      now_ = at_ms(3700);
      start();
    }
    run_until(at_ms(8000));
    return states_["sub"];
  };
  const auto whole = run(false), killed = run(true);
  EXPECT_GT(whole.size(), 10u);
  EXPECT_LT(whole.size(), 40u);
  ASSERT_EQ(killed.size(), whole.size());
  for (std::size_t k = 0; k < whole.size(); ++k) {
    EXPECT_EQ(killed[k].utime, whole[k].utime);
    EXPECT_EQ(killed[k].sequence, whole[k].sequence);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(killed[k].position_ned_m[axis], whole[k].position_ned_m[axis]) << k;
  }
}

TEST_F(ReckonedStates, WithoutAJournalOrInAnotherRunAStateIsPublishedAtOnce) {
  config_.states = {.deviation_m = 5, .longest_silence = SimDuration::from_milliseconds(2000)};
  make_node();
  run_until(at_ms(1000));
  EXPECT_EQ(states_["buoy"].size(), 1u);
  make_node();  // killed without a journal
  run_until(at_ms(1100));
  EXPECT_EQ(states_["buoy"].size(), 2u);
  now_ = SimTime();
  node_->restart({now_, now_});
  node_->step({now_, at_ms(1200)});
  drain();
  ASSERT_EQ(states_["buoy"].size(), 3u);
  EXPECT_EQ(states_["buoy"].back().utime, 0);
}

}  // namespace
}  // namespace halocline::vehicle_sim
