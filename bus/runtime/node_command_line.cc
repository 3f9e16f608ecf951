// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/node_command_line.h"

#include <chrono>
#include <cstdio>
#include <utility>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "bus/runtime/version_text.h"
#include "bus/transport/transport.h"
#include "bus/version.h"
#include "core/check.h"
#include "core/hash.h"

namespace halocline::bus {
namespace {

struct Arguments {
  std::string scenario_path;
  std::vector<std::string> overrides;
  std::string name, lcm_url, sync_url, time_source, journal, log_level = "info";
  bool example = false, interface = false, print_config = false;
};

std::string exit_codes_of(const NodeProgram& program) {
  std::string text = "Exit codes: 0 stopped when asked to, 1 failed, " + std::to_string(kExitConfiguration) +
                     " wrong command line or configuration, ";
  for (const auto& [code, meaning] : program.other_exit_codes)
    text += std::to_string(code) + " " + meaning + ", ";
  return text + std::to_string(kExitNetwork) + " the network cannot be used.";
}

void describe(CLI::App& app, Arguments& arguments, const NodeProgram& program) {
  app.add_option("scenario", arguments.scenario_path, "scenario file (TOML); without one, defaults hold");
  app.add_option("--set", arguments.overrides,
                 "change a key of the scenario: section.key=value (repeatable)");
  app.add_option("--name", arguments.name,
                 "name of this node (channel STATUS.<name>); default: " + program.node_name);
  app.add_option("--lcm-url", arguments.lcm_url, "LCM URL; default: LCM_DEFAULT_URL, else this host only");
  if (!program.make_time_source) {
    app.add_option("--time-source", arguments.time_source,
                   "conductor, messages (greatest time stamp received), wall, or lockstep (turns granted by "
                   "a conductor)")
        ->default_val("conductor");
  }
  app.add_option("--sync-url", arguments.sync_url,
                 "LCM URL of the lockstep protocol, which uses the next port, too")
      ->default_val(std::string(kDefaultSyncUrl));
  if (program.keeps_state) {
    app.add_option("--journal", arguments.journal,
                   "files (FILE.0, FILE.1) of its state, from which a program that was killed goes on where "
                   "it was; of one "
                   "run, not in lockstep")
        ->type_name("FILE");
  }
  for (const ProgramOption& option : program.options) {
    if (option.flag != nullptr) {
      app.add_flag(option.name, *option.flag, option.help);
    } else if (option.values != nullptr) {
      app.add_option(option.name, *option.values, option.help)->take_all()->allow_extra_args(false);
    } else {
      app.add_option(option.name, *option.value, option.help);
    }
  }
  app.add_option("--log-level", arguments.log_level, "debug, info, warning, error or silent")
      ->default_val("info");
  app.add_flag("--example", arguments.example, "print an example of this program's sections and exit");
  app.add_flag("--interface", arguments.interface, "print the channels subscribed and published and exit");
  app.add_flag("--print-config", arguments.print_config, "print the effective configuration and exit");
  app.set_version_flag("--version", [&program] { return version_text(program.program); });
  app.footer("Examples:\n  " + program.program + " " + program.example_scenario + " --log-level debug\n\n" +
             exit_codes_of(program));
}

std::vector<std::string> overrides_of(const Arguments& arguments, const NodeProgram& program) {
  std::vector<std::string> overrides = arguments.overrides;
  for (const ProgramOption& option : program.options) {
    if (!option.settings || option.value->empty()) continue;
    const auto settings = option.settings(*option.value);
    overrides.insert(overrides.end(), settings.begin(), settings.end());
  }
  return overrides;
}

void read_scenario(const Arguments& arguments, const NodeProgram& program, NodeRun& run) {
  const std::vector<std::string> overrides = overrides_of(arguments, program);
  auto file = arguments.scenario_path.empty() ? ConfigFile::parse("", "command line", overrides)
                                              : ConfigFile::load(arguments.scenario_path, overrides);
  file.read([&](ConfigVisitor& v) { visit(v, run.scenario); });
  if (program.visit_config) file.read(program.visit_config);
  file.check(/*whole_file=*/false);
  run.file = std::make_shared<ConfigFile>(std::move(file));
}

std::string config_text(const NodeProgram& program, Scenario scenario, bool with_comments) {
  return to_toml(
      [&](ConfigVisitor& v) {
        visit(v, scenario);
        if (program.visit_config) program.visit_config(v);
      },
      with_comments);
}

std::uint64_t entropy_of_this_incarnation() {
  const auto now = std::chrono::system_clock::now().time_since_epoch().count();
  return static_cast<std::uint64_t>(now) * 1'000'003u + static_cast<std::uint64_t>(getpid());
}

}  // namespace

std::vector<std::string> part_settings(const std::string& option, const std::string& value,
                                       const std::string& index_key, const std::string& count_key) {
  const auto slash = value.find('/');
  const auto is_number = [](const std::string& text) {
    return !text.empty() && text.size() < 4 && text.find_first_not_of("0123456789") == std::string::npos;
  };
  const std::string index = value.substr(0, slash);
  const std::string count = slash == std::string::npos ? "" : value.substr(slash + 1);
  require(is_number(index) && is_number(count) && std::stoi(index) < std::stoi(count),
          option + " " + value + "; allowed is i/n with i from 0 to n - 1, as 0/2 and 1/2");
  return {index_key + "=" + index, count_key + "=" + count};
}

std::optional<NodeRun> parse_node_command_line(int argc, char** argv, const NodeProgram& program) {
  Arguments arguments;
  CLI::App app(program.purpose, program.program);
  describe(app, arguments, program);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& requested) {
    app.exit(requested);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    throw InvalidArgument(std::string(error.what()) + "; --help lists what is allowed");
  }
  NodeRun run;
  if (arguments.interface) {
    std::printf("%s\n", program.interface.c_str());
    return std::nullopt;
  }
  if (arguments.example) {
    std::printf("%s", config_text(program, {}, true).c_str());
    return std::nullopt;
  }
  read_scenario(arguments, program, run);
  if (arguments.print_config) {
    std::printf("%s", config_text(program, run.scenario, false).c_str());
    return std::nullopt;
  }
  std::string name = arguments.name;
  if (name.empty()) name = program.default_name ? program.default_name() : program.node_name;
  run.identity = {name, session_of(entropy_of_this_incarnation(), name)};
  run.lcm_url = arguments.lcm_url;
  run.sync_url = arguments.sync_url;
  run.time_source =
      arguments.time_source.empty() ? program.time_source : time_source_from_name(arguments.time_source);
  run.log_level = log_level_from_name(arguments.log_level);
  run.journal = arguments.journal;
  require(run.journal.empty() || run.time_source != TimeSourceKind::kLockstep,
          "--journal is " + run.journal + "; in lockstep the conductor keeps the journal of all");
  run.config_digest = fnv1a(config_text(program, run.scenario, false), fnv1a(kVersion));
  return run;
}

}  // namespace halocline::bus
