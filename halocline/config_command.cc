// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "channel_server/channel_server_config.h"
#include "channel_server/replay_config.h"
#include "halocline/commands.h"
#include "simulation/composition.h"

namespace halocline::clients {
namespace {

struct ConfigArguments {
  std::string scenario;
  std::vector<std::string> overrides;
};

// Reads measured channels to find their errors. A run reads them only once, when it creates its channel
// server.
void check_replay(const ScenarioConfig& config) {
  const channel_server::ReplayConfig& replay = config.channel_server.propagation.replay;
  if (replay.is_wanted()) make_measured_links(replay, make_modems(config.channel_server), config.scenario);
}

int show(const ConfigArguments& arguments) {
  if (arguments.scenario.empty()) {
    std::cout << commented_toml();
  } else {
    const CheckedScenario checked = load_checked(arguments.scenario, arguments.overrides);
    for (const std::string& warning : checked.warnings) std::cerr << "warning: " << warning << "\n";
    check_replay(checked.config);
    std::cout << effective_toml(checked.config);
  }
  return kDone;
}

}  // namespace

void add_config_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ConfigArguments>();
  CLI::App* command = app.add_subcommand("config",
                                         "Check a scenario file and print the effective configuration; "
                                         "without one, every key with its default and meaning");
  command->add_option("scenario", arguments->scenario, "scenario file (TOML)");
  command->add_option("--set", arguments->overrides, "change a key: section.key=value (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  command->footer(footer("  halocline config scenarios/seamount.toml"));
  command->callback([arguments, &exit_code] { exit_code = show(*arguments); });
}

}  // namespace halocline::clients
