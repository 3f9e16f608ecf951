// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/open_loop.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "core/check.h"
#include "core/units.h"
#include "tests/support/at_ms.h"
#include "tests/support/tolerance.h"
#include "vehicle_sim/model_library.h"

namespace halocline::vehicle_sim {
namespace {

using halocline::testing::tolerance;

const Model kTorpedo(programmed_model("torpedo").value());

using halocline::testing::at_ms;

OpenLoopRun turn(std::int64_t duration_ms) {
  OpenLoopRun run;
  run.duration = SimDuration::from_milliseconds(duration_ms);
  run.schedule = {{at_ms(0), {0, 0, 20, {}}}, {at_ms(2005), {0.2, 0, 20, {}}}};
  return run;
}

TEST(OpenLoop, SamplesTheStartAndEachPeriodToTheEnd) {
  const auto samples = run_open_loop(kTorpedo, turn(3500));
  ASSERT_EQ(samples.size(), 4u);
  EXPECT_EQ(samples.front().time, at_ms(0));
  EXPECT_EQ(samples.back().time, at_ms(3000));
}

TEST(OpenLoop, ACommandActsFromItsOwnInstantBetweenSteps) {
  OpenLoopRun run = turn(2100);
  run.sample_period = SimDuration::from_milliseconds(5);
  const auto samples = run_open_loop(kTorpedo, run);
  const auto rudder_at = [&](int ms) {
    return samples[static_cast<std::size_t>(ms / 5)].state.actuators.rudder_rad;
  };
  EXPECT_EQ(rudder_at(2005), 0);
  // first-order lag of 0.1 s; RK4 of 5 ms steps errs by 1e-9 a lag
  EXPECT_NEAR(rudder_at(2105 - 5), 0.2 * (1 - std::exp(-0.95)), tolerance(1e-7));
}

TEST(OpenLoop, HowOftenItIsSampledChangesNothingOnTheGrid) {
  OpenLoopRun often = turn(5000);
  often.sample_period = SimDuration::from_milliseconds(100);
  EXPECT_EQ(run_open_loop(kTorpedo, turn(5000)).back().state.position_ned_m,
            run_open_loop(kTorpedo, often).back().state.position_ned_m);
}

TEST(OpenLoop, YawCountsOnOverWholeTurns) {
  const auto samples = run_open_loop(kTorpedo, turn(60'000));
  EXPECT_GT(samples.back().yaw_unwrapped_rad, 10);
  for (std::size_t i = 1; i < samples.size(); ++i)
    EXPECT_LT(std::abs(samples[i].yaw_unwrapped_rad - samples[i - 1].yaw_unwrapped_rad), 1);
}

TEST(OpenLoop, WithoutLimitsCommandsActAsGiven) {
  OpenLoopRun run = turn(4000);
  run.schedule = {{at_ms(0), {to_radians(20), 0, 40, {}}}};
  const double held = run_open_loop(kTorpedo, run).back().state.actuators.rudder_rad;
  const double free =
      run_open_loop(Model(without_limits(kTorpedo.parameters())), run).back().state.actuators.rudder_rad;
  EXPECT_NEAR(held, to_radians(15), tolerance(1e-9));
  EXPECT_NEAR(free, to_radians(20), tolerance(1e-9));
}

TEST(OpenLoop, ARunThatDivergesStopsAndNamesTheTime) {
  OpenLoopRun run = turn(60'000);
  run.start.velocity_body[0] = 1e160;  // whose drag no double holds
  try {
    run_open_loop(kTorpedo, run);
    FAIL() << "no result is to be had";
  } catch (const Diverged& diverged) {
    EXPECT_GT(diverged.at(), SimTime());
    EXPECT_LT(diverged.at(), at_ms(60'000));
    EXPECT_NE(std::string(diverged.what()).find(std::to_string(diverged.at().seconds()) + " s"),
              std::string::npos);
  }
}

TEST(OpenLoop, ImpossibleRunsAreRefused) {
  const auto refused = [](const std::function<void(OpenLoopRun&)>& spoil) {
    OpenLoopRun run = turn(1000);
    spoil(run);
    EXPECT_THROW(run_open_loop(kTorpedo, run), InvalidArgument);
  };
  refused([](auto& r) { r.step = SimDuration(); });
  refused([](auto& r) { r.step = SimDuration::from_milliseconds(30); });
  refused([](auto& r) { r.sample_period = SimDuration(); });
  refused([](auto& r) { r.schedule[1].from = at_ms(0); });
  refused([](auto& r) { r.schedule[0].actuators.propeller_hz = std::nan(""); });
  refused([](auto& r) { r.start.position_ned_m.x() = std::nan(""); });
}

}  // namespace
}  // namespace halocline::vehicle_sim
