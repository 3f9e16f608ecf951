// SPDX-License-Identifier: BSD-3-Clause
// The examples in the comments of the headers of simulation/, compiled and run (tests/docs/check_examples).
#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "bus/runtime/lockstep_runner.h"
#include "core/sim_time.h"
#include "simulation/composition.h"
#include "tests/support/working_folder.h"

namespace halocline::clients {
namespace {

TEST(HeaderExamples, Composition) {
  const halocline::testing::WorkingFolder folder(HALOCLINE_SOURCE_DIR);
  const ScenarioConfig config = load_scenario("scenarios/seamount.toml", {"modem.source_level_db=170"});
  lcm::LCM lcm("memq://");
  Composition all(lcm, config, Composition::kRun);
  bus::LockstepRunner runner(all.nodes());
  runner.run_until(SimTime::from_seconds(1.0));
  EXPECT_EQ(runner.now(), SimTime::from_seconds(1.0));
}

}  // namespace
}  // namespace halocline::clients
