// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/ostream.h>

#include "bus/config/config.h"
#include "bus/logs/log_reader.h"
#include "bus/logs/log_rotation.h"
#include "bus/runtime/node_process.h"
#include "bus/transport/event_log.h"
#include "core/atomic_file.h"
#include "core/check.h"
#include "core/sim_time.h"
#include "halocline/commands.h"
#include "runs/analysis/comparison.h"
#include "runs/analysis/read_timeline.h"
#include "runs/analysis/recording.h"
#include "runs/analysis/run_files.h"
#include "simulation/composition.h"
#include "simulation/embedded_run.h"
#include "simulation/replay_node.h"

namespace halocline::clients {
namespace {

namespace fs = std::filesystem;

struct ReplayOptions {
  std::vector<std::string> logs, overrides, rotate;
  std::string scenario, out, format = "table";
  std::int64_t seed = -1;
  int keep_parts = 0;
  bool quiet = false, no_comparison = false, force = false;
};

// Adds the files that it reads to `inputs`.
ScenarioConfig config_of(const ReplayOptions& options, std::vector<std::string>& inputs) {
  std::vector<std::string> overrides = options.overrides;
  if (options.seed >= 0) overrides.push_back("scenario.seed=" + std::to_string(options.seed));
  bus::ConfigFile file = options.scenario.empty() ? recorded_configuration(options.logs, overrides)
                                                  : bus::ConfigFile::load(options.scenario, overrides);
  ScenarioConfig config = load_scenario(file, ScenarioUse::kWater);
  if (!options.quiet)
    for (const std::string& warning : file.warnings()) std::cerr << "warning: " << warning << "\n";
  const std::vector<std::string> read = file.inputs();
  inputs.insert(inputs.end(), read.begin(), read.end());
  return config;
}

void show(const Comparison& comparison, const std::string& format) {
  if (format == "json")
    std::cout << to_json(comparison) << "\n";
  else if (format == "csv")
    print_csv(std::cout, comparison);
  else
    print(std::cout, comparison);
}

// Files of the comparison, beside the new log.
struct ComparisonFiles {
  std::string csv, json;
};

ComparisonFiles comparison_files(const std::string& log) {
  const auto beside = [&](const char* ending) { return fs::path(log).replace_extension(ending).string(); };
  return {beside(".comparison.csv"), beside(".comparison.json")};
}

// Names the output files; throws when an existing file would be replaced.
RunFiles files_of(const ReplayOptions& options, const ScenarioConfig& config,
                  const std::vector<std::string>& inputs) {
  RunFiles files = run_files("", config.scenario.name, options.out, "", options.scenario);
  const auto [csv, json] = comparison_files(files.log);
  OutputFiles outputs{files_of_log(files.log), options.force};
  outputs.paths.push_back(files.config);
  if (!options.no_comparison) outputs.paths.insert(outputs.paths.end(), {csv, json});
  require_free(outputs, inputs);
  return files;
}

void compare_with_original(const ReplayOptions& options, const std::string& made, SimDuration zero) {
  LogReader original(options.logs), replayed(made);
  const Comparison comparison(outcomes_of(original, zero.nanoseconds() / 1000), outcomes_of(replayed));
  const auto [csv, json] = comparison_files(made);
  std::ostringstream table;
  print_csv(table, comparison);
  replace_file(csv, table.str());
  replace_file(json, to_json(comparison) + "\n");
  if (options.quiet) return;
  show(comparison, options.format);
  if (options.format == "table") std::cout << "\ncomparison  " << csv << ", " << json << "\n";
}

RunOutcome run_replay(const ReplayOptions& options, const ScenarioConfig& config, const RunFiles& files,
                      Recording recording) {
  EmbeddedRun run;
  run.end = recording.end;
  run.log_path = files.log;
  run.rotation = rotation_of(options.rotate, options.keep_parts);
  run.quiet = options.quiet;
  run.should_stop = bus::stop_requested;
  lcm::LCM lcm("memq://");
  ReplayNode recorded(lcm, {"replay", bus::session_of(config.scenario.seed, "replay")}, std::move(recording));
  Composition nodes(lcm, config, Composition::kReplay, &recorded);
  bus::catch_stop_signals();
  run.threads = nodes.threads();
  return run_embedded(nodes.nodes(), run);
}

int replay(const ReplayOptions& options) {
  bus::set_log_level(bus::log_level_from_name(options.quiet ? "error" : "warning"));
  LogReader log(options.logs);
  std::vector<std::string> inputs = log.files();
  const ScenarioConfig config = config_of(options, inputs);
  const RunFiles files = files_of(options, config, inputs);
  Recording recording = read_recording(log, config.scenario, played_in(config));
  const bool is_whole = report_damage(std::cerr, log);
  if (!options.quiet) print_repairs(std::cerr, recording);
  require(!recording.events.empty(), options.logs.front() + " holds no states and no transmissions");
  if (!files.config.empty()) replace_file(files.config, portable_toml(config));
  const SimDuration zero = recording.zero;
  const RunOutcome outcome = run_replay(options, config, files, std::move(recording));
  if (options.format == "table" && !options.quiet) {
    fmt::print(std::cout, "replayed    {}: {:.3f} s{} in {:.3f} s\nlog         {}\n\n", options.logs.front(),
               outcome.reached.seconds(), outcome.interrupted ? " (interrupted)" : "", outcome.wall_s,
               files.log);
  }
  if (!options.no_comparison) compare_with_original(options, files.log, zero);
  return bus::interrupt_requested() ? kInterrupted : is_whole ? kDone : kFailed;
}

int compare(const ReplayOptions& options) {
  LogReader before(options.logs.at(0)), after(options.logs.at(1));
  const LoggedOutcomes was = outcomes_of(before), is = outcomes_of(after);
  const bool was_whole = report_damage(std::cerr, before), is_whole = report_damage(std::cerr, after);
  show(Comparison(was, is), options.format);
  return was_whole && is_whole ? kDone : kFailed;
}

void add_format_option(CLI::App& command, std::string& format) {
  command.add_option("--format", format, "of the comparison: table, json or csv")
      ->check(CLI::IsMember({"table", "json", "csv"}));
}

}  // namespace

void add_replay_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand(
      "replay", "Pass a log's states and transmissions through another sea, into a new log and a comparison");
  command
      ->add_option("recording", options->logs,
                   "LCM log of a run, ours or lcm-logger's; or its parts in order")
      ->required();
  command->add_option("--log", options->out, "the new log; the comparison is written beside it")->required();
  command->add_option(
      "--scenario", options->scenario,
      "water, modems and terrain; default: the configuration recorded in the log, or beside it");
  command->add_option("--set", options->overrides, "change a key: section.key=value (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  command->add_option("--seed", options->seed, "seed of all random draws; default: the scenario's")
      ->check(CLI::NonNegativeNumber);
  add_rotation_options(*command, options->rotate, options->keep_parts);
  add_format_option(*command, options->format);
  command->add_flag("--no-comparison", options->no_comparison, "write no comparison");
  add_force_option(*command, options->force);
  command->add_flag("--quiet", options->quiet, "no progress line, no table, errors only");
  command->footer(
      footer("  halocline replay results/seamount/seamount.lcm --log calm.lcm --set environment.wind_mps=0\n"
             "  halocline replay at-sea.lcm --scenario scenarios/seamount.toml --log again.lcm"));
  command->callback([options, &exit_code] { exit_code = replay(*options); });
}

void add_compare_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand(
      "compare",
      "List the packets of one scenario whose outcome differs between two logs, with the inputs that differ");
  command->add_option("logs", options->logs, "the log before and the log after")->required()->expected(2);
  add_format_option(*command, options->format);
  command->footer(footer("  halocline compare results/seamount/seamount.lcm calm.lcm"));
  command->callback([options, &exit_code] { exit_code = compare(*options); });
}

}  // namespace halocline::clients
