// SPDX-License-Identifier: BSD-3-Clause
// Each scenario of the studies of seas and trials, as found in its folder: it is sound as a run, and its
// sender is heard where it stands.
#include <filesystem>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "simulation/composition.h"
#include "simulation/link_survey.h"

namespace halocline::clients {
namespace {

std::set<std::string> scenarios_in(const std::string& folder) {
  std::set<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(HALOCLINE_SOURCE_DIR "/studies/" + folder))
    if (entry.path().extension() == ".toml") paths.insert(entry.path().string());
  return paths;
}

class StudyScenarios : public ::testing::TestWithParam<const char*> {};

TEST_P(StudyScenarios, LoadAndPredictTheirLink) {
  const std::set<std::string> paths = scenarios_in(GetParam());
  EXPECT_GE(paths.size(), 6u);
  for (const std::string& path : paths) {
    SCOPED_TRACE(path);
    CheckedScenario checked;
    ASSERT_NO_THROW(checked = load_checked(path, {}));
    EXPECT_TRUE(checked.warnings.empty());
    const ScenarioConfig& config = checked.config;
    ASSERT_EQ(config.scenario.vehicles.size(), 2u);
    const LinkSurvey link = survey_link(config, link_end(config, config.scenario.vehicles[1].name),
                                        link_end(config, config.scenario.vehicles[0].name));
    EXPECT_EQ(link.reception.state, channel_server::PathState::kOpen);
    EXPECT_GT(link.forecast.delivery_probability, 0);
    // The hour of the forecast may be one of the worst or the best.
    EXPECT_LE(link.forecast.delivery_low, link.forecast.delivery_high);
  }
}

INSTANTIATE_TEST_SUITE_P(Folders, StudyScenarios, ::testing::Values("seas", "trials"),
                         [](const auto& folder) { return std::string(folder.param); });

}  // namespace
}  // namespace halocline::clients
