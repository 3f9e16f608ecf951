// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "bus/config/config.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/replay_config.h"
#include "halocline/commands.h"
#include "simulation/composition.h"

namespace halocline::clients {
namespace {

struct ConfigArguments {
  bool advanced = false;
  std::string scenario;
  std::vector<std::string> overrides;
};

// Reads measured channels to find their errors. A run reads them only once, when it creates its channel
// server.
void check_replay(const ScenarioConfig& config) {
  const channel_server::ReplayConfig& replay = config.channel_server.propagation.replay;
  if (replay.is_wanted()) make_measured_links(replay, make_modems(config.channel_server), config.scenario);
}

// Counts the keys of a list by their comments.
std::size_t count_keys(const std::string& list) {
  std::istringstream lines(list);
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line);) count += line.find("  # ") != std::string::npos;
  return count;
}

void list_common_keys() {
  std::cout << key_list(bus::KeyClass::kCommon) << "\n# " << count_keys(key_list(bus::KeyClass::kAdvanced))
            << " more keys tune vehicles, sensors and protocols; `halocline config --advanced` prints them\n";
}

int show(const ConfigArguments& arguments) {
  if (arguments.advanced) {
    std::cout << key_list(bus::KeyClass::kAdvanced);
  } else if (arguments.scenario.empty()) {
    list_common_keys();
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
                                         "without one, the keys with their defaults and meanings");
  CLI::Option* scenario = command->add_option("scenario", arguments->scenario, "scenario file (TOML)");
  command->add_flag("--advanced", arguments->advanced, "print the keys that tune instead")
      ->excludes(scenario);
  command->add_option("--set", arguments->overrides, "change a key: section.key=value (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  command->footer(footer("  halocline config scenarios/seamount.toml"));
  command->callback([arguments, &exit_code] { exit_code = show(*arguments); });
}

}  // namespace halocline::clients
