// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/ostream.h>

#include "bus/logs/log_reader.h"
#include "bus/logs/log_rotation.h"
#include "bus/runtime/node_process.h"
#include "bus/transport/event_log.h"
#include "core/atomic_file.h"
#include "core/check.h"
#include "core/csv_table.h"
#include "core/memory/memory_budget.h"
#include "core/sim_time.h"
#include "halocline/commands.h"
#include "runs/analysis/csv_export.h"
#include "runs/analysis/read_timeline.h"
#include "runs/analysis/run_files.h"
#include "runs/timeline/run_timeline.h"
#include "simulation/composition.h"
#include "simulation/embedded_run.h"
#include "simulation/log_estimate.h"
#include "simulation/waveform/live_sea.h"
#include "viewer/report/report_page.h"

namespace halocline::clients {
namespace {

struct RunOptions {
  std::string scenario, out, log, csv, mirror, log_level = "warning";
  std::vector<std::string> overrides, rotate;
  double duration_s = 0, rate = 0;
  std::int64_t seed = -1;
  int keep_parts = 0;
  bool quiet = false, no_csv = false, no_report = false, force = false;
};

std::vector<std::string> overrides_of(const RunOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (options.duration_s > 0) overrides.push_back("scenario.duration_s=" + format_number(options.duration_s));
  if (options.seed >= 0) overrides.push_back("scenario.seed=" + std::to_string(options.seed));
  return overrides;
}

void print_end(const RunOptions& options, const RunFiles& files, const ScenarioConfig& config,
               const RunOutcome& outcome, const RunTimeline& timeline) {
  fmt::print(std::cout, "scenario    {}: {}\n", config.scenario.name, config.scenario.description);
  fmt::print(std::cout, "simulated   {:.3f} s{} in {:.3f} s, {:.1f} times real time\n",
             outcome.reached.seconds(), outcome.interrupted ? " (interrupted)" : "", outcome.wall_s,
             outcome.reached.seconds() / std::max(outcome.wall_s, 1e-9));
  print_summary(std::cout, timeline);
  std::cout << "log         " << files.log << (options.no_csv ? "" : ", CSVs " + files.csv) << "\n";
  if (!options.no_report) std::cout << "report      " << files.report << "\n";
}

// Names the output files. Without --out the folder is new; existing files are kept unless --force is given.
RunFiles files_of(const RunOptions& options, const std::string& name,
                  const std::vector<std::string>& inputs) {
  const bool all_named = !options.log.empty() && (options.no_csv || !options.csv.empty());
  const std::string out =
      !options.out.empty() || all_named ? options.out : make_new_folder("results/" + name);
  RunFiles files = run_files(out, name, options.log, options.csv, options.scenario);
  OutputFiles outputs{files_of_log(files.log), options.force};
  outputs.paths.push_back(files.config);
  if (!options.no_report) outputs.paths.push_back(files.report);
  if (!options.no_csv) outputs.paths.push_back(files.csv);
  require_free(outputs, inputs);
  return files;
}

// Warns before the run, while it can still be stopped.
void warn_of_large_log(const RunOptions& options, const ScenarioConfig& config, const std::string& log) {
  constexpr double kLarge = 10e9;
  std::error_code error;
  const auto space = std::filesystem::space(std::filesystem::absolute(log).parent_path(), error);
  const double bytes = estimated_log_bytes(config),
               free = error ? HUGE_VAL : static_cast<double>(space.available);
  if (options.keep_parts > 0 || bytes < std::min(kLarge, free)) return;
  std::fprintf(stderr, "warning: the log will have about %s%s; --log-rotate and --log-keep bound it\n",
               size_text(bytes).c_str(),
               bytes < free ? "" : (", and " + size_text(free) + " are free").c_str());
}

int run(const RunOptions& options) {
  bus::set_log_level(bus::log_level_from_name(options.quiet ? "error" : options.log_level));
  CheckedScenario checked = load_checked(options.scenario, overrides_of(options));
  const ScenarioConfig& config = checked.config;
  const RunFiles files = files_of(options, config.scenario.name, checked.inputs);
  if (!options.quiet) {
    for (const std::string& warning : checked.warnings)
      std::fprintf(stderr, "warning: %s\n", warning.c_str());
    warn_of_large_log(options, config, files.log);
    if (!config.gateway.interfaces.empty() && options.rate != 1)
      std::fprintf(stderr, "warning: hosts of modem interfaces keep wall time; --rate 1 does as well\n");
    std::fprintf(stderr, "terrain     %s\n", checked.terrain.summary.c_str());
  }
  if (!files.config.empty()) replace_file(files.config, portable_toml(config));
  lcm::LCM lcm("memq://");
  Composition all(lcm, config, Composition::kRun, nullptr, checked.terrain,
                  live_sea_maker(config, checked.terrain));
  bus::catch_stop_signals();
  EmbeddedRun run;
  run.end = SimTime() + config.scenario.duration;
  run.log_path = files.log;
  run.rotation = rotation_of(options.rotate, options.keep_parts);
  run.rate = options.rate;
  run.threads = all.threads();
  run.mirror_url = options.mirror;
  run.quiet = options.quiet;
  run.should_stop = bus::stop_requested;
  const RunOutcome outcome = run_embedded(all.nodes(), run);
  if (!options.no_csv) {
    LogReader log(files.log);
    export_csv(log, files.csv);
  }
  const int code = bus::interrupt_requested() ? kInterrupted : kDone;
  if (options.quiet && options.no_report) return code;
  const LoggedTimeline log = read_timeline({files.log});
  if (!options.no_report) replace_file(files.report, report_page({files.log, log.timeline, log.remarks}));
  if (!options.quiet) print_end(options, files, config, outcome, log.timeline);
  return code;
}

}  // namespace

void add_force_option(CLI::App& command, bool& force) {
  command.add_flag("--force", force, "replace files that are there");
}

void add_rotation_options(CLI::App& command, std::vector<std::string>& rotate, int& keep_parts) {
  command
      .add_option("--log-rotate", rotate,
                  "begin another part of the log after this size (kB, MB, GB) or simulated time (s, min, h); "
                  "repeatable, e.g. 256MB")
      ->take_all()
      ->allow_extra_args(false);
  command.add_option("--log-keep", keep_parts, "keep only the newest parts, this many; default: all")
      ->check(CLI::PositiveNumber);
}

void add_run_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Run a scenario in this process, in lockstep, into a log");
  command->add_option("scenario", options->scenario, "scenario file (TOML)")->required();
  command->add_option("--duration", options->duration_s, "simulated seconds; default: the scenario's")
      ->check(CLI::PositiveNumber);
  command->add_option("--seed", options->seed, "seed of all random draws; default: the scenario's")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--rate", options->rate, "simulated seconds per wall second; 0: as fast as it computes")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--set", options->overrides, "change a key: section.key=value (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  command->add_option(
      "--out", options->out,
      "folder of the results; default: results/<scenario>, or results/<scenario>-2, ...: a new one");
  command->add_option("--log", options->log, "LCM log; default: <out>/<scenario>.lcm");
  add_rotation_options(*command, options->rotate, options->keep_parts);
  command->add_option("--csv", options->csv, "folder of the CSVs; default: <out>/csv");
  command->add_flag("--no-csv", options->no_csv, "write no CSVs");
  command->add_flag("--no-report", options->no_report, "write no report.html beside the log");
  command->add_option("--mirror", options->mirror, "udpm URL on which the run is shown as well, for lcm-spy");
  command->add_option("--log-level", options->log_level, "debug, info, warning, error or silent");
  add_force_option(*command, options->force);
  command->add_flag("--quiet", options->quiet, "print errors only");
  command->footer(
      footer("  halocline run scenarios/seamount.toml --duration 120 --set modem.source_level_db=170"));
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace halocline::clients
