// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include <unistd.h>

#include "core/check.h"
#include "halocline/commands.h"

namespace halocline::clients {
namespace {

// Replaces this process by halocline-monitor, which is beside this program; throws when it cannot be started.
void become_monitor(const std::vector<std::string>& arguments) {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  std::string program = (self.parent_path() / "halocline-monitor").string();
  std::vector<char*> command{program.data()};
  std::vector<std::string> texts = arguments;
  for (std::string& text : texts) command.push_back(text.data());
  command.push_back(nullptr);
  ::execv(program.c_str(), command.data());
  throw InvalidArgument("cannot start " + program + "; ./scripts/monitor builds it");
}

}  // namespace

void add_view_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("view", "Show a log, or a running bus, in the browser: starts halocline-monitor");
  command->prefix_command();
  command->footer(
      footer("  halocline view results/seamount/seamount.lcm\n  halocline view\n"
             "Options are those of halocline-monitor --help; ./scripts/monitor builds the page."));
  command->callback([command, &exit_code] {
    exit_code = kFailed;
    become_monitor(command->remaining());
  });
}

}  // namespace halocline::clients
