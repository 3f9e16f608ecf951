// SPDX-License-Identifier: BSD-3-Clause
// Each shipped scenario by itself and shared out, as found in the folder: its first seconds.
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bus/logs/log_reader.h"
#include "runs/analysis/simulation_output.h"
#include "tests/integration/embedded_fixture.h"

namespace halocline::clients {
namespace {

// Names below scenarios/, without the ending; those of sweeps (sweep_*) say what halocline sweep changes,
// and are none.
std::set<std::string> shipped_scenarios() {
  const std::filesystem::path folder = HALOCLINE_SOURCE_DIR "/scenarios";
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::filesystem::path& path = entry.path();
    if (path.extension() != ".toml" || path.filename().string().starts_with("sweep_")) continue;
    names.insert(path.lexically_relative(folder).replace_extension().string());
  }
  return names;
}

class ShippedScenarios : public testing::EmbeddedTest {
 protected:
  // In the first 6 s everything of a run happens once: all servers search, some ask for the terrain before
  // others.
  std::string output_of(const std::string& scenario, std::vector<std::string> settings) {
    settings.push_back("scenario.duration_s=6");
    LogReader log(run(load(scenario, settings), "log"));
    const std::string path = log_path("output");
    write_simulation_output(log, path);
    return bytes_of(path);
  }
};

TEST_F(ShippedScenarios, HaveTheOutputOfOneServerWithThreadsShardsAndBlocks) {
  const std::set<std::string> scenarios = shipped_scenarios();
  EXPECT_GE(scenarios.size(), 21u);
  for (const std::string& scenario : scenarios) {
    SCOPED_TRACE(scenario);
    const std::string plain = output_of(scenario, {});
    EXPECT_GT(plain.size(), 1'000u);
    EXPECT_TRUE(output_of(scenario, {"channel_server.threads=3", "vehicle_sim.threads=3"}) == plain)
        << "threads";
    for (const char* shards : {"2", "3"})
      EXPECT_TRUE(output_of(scenario, {std::string("channel_server.shards=") + shards}) == plain)
          << "shards " << shards;
    if (!load(scenario, {}).vehicle_sim.tethers.empty()) continue;  // those of a tether are in one block
    EXPECT_TRUE(output_of(scenario, {"vehicle_sim.blocks=2"}) == plain) << "blocks";
  }
}

}  // namespace
}  // namespace halocline::clients
