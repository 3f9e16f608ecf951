#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>

#include "bus/event_log.h"
#include "bus/node_process.h"
#include "clients/halocline/commands.h"
#include "clients/halocline/composition.h"
#include "clients/halocline/embedded_run.h"
#include "clients/halocline/log_statistics.h"
#include "clients/halocline/replay_node.h"
#include "clients/halocline/run_files.h"
#include "core/check.h"

namespace halocline::clients {
namespace {

struct ReplayOptions {
  std::string log, scenario, out;
  std::vector<std::string> overrides;
  bool quiet = false;
};

std::string scenario_of(const ReplayOptions& options) {
  if (!options.scenario.empty()) return options.scenario;
  const std::string beside = config_beside(options.log);
  require(std::filesystem::exists(beside),
          "there is no " + beside + " that says what the log was made with; name one by --scenario");
  return beside;
}

int replay(const ReplayOptions& options) {
  bus::set_log_level(bus::log_level_from_name(options.quiet ? "error" : "warning"));
  LogReader log(options.log);
  Recording recording = read_recording(log);
  const SimTime end = recording.end;
  require(!recording.events.empty(), options.log + " holds no states and no transmissions");
  require(!std::filesystem::exists(options.out) || !std::filesystem::equivalent(options.out, options.log),
          "--log is the log that is replayed; allowed is another file");
  const ScenarioConfig config = load_scenario(scenario_of(options), options.overrides);
  const RunFiles files = run_files("", config.scenario.name, options.out, "");
  write_text(files.config, effective_toml(config));
  lcm::LCM lcm("memq://");
  ReplayNode recorded(lcm, {"replay", bus::session_of(config.scenario.seed, "replay")}, std::move(recording));
  Composition nodes(lcm, config, Composition::kReplay, &recorded);
  bus::catch_stop_signals();
  EmbeddedRun run;
  run.end = end;
  run.log_path = files.log;
  run.quiet = options.quiet;
  run.should_stop = bus::stop_requested;
  const RunOutcome outcome = run_embedded(lcm, nodes.nodes(), run);
  std::printf("replayed    %s: %.3f s in %.3f s\n", options.log.c_str(), outcome.reached.seconds(),
              outcome.wall_s);
  std::fflush(stdout);
  LogReader made(files.log);
  print(std::cout, statistics_of(made));
  std::cout << "log         " << files.log << "\n";
  return kDone;
}

}  // namespace

void add_replay_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand(
      "replay", "Pass a log's states and transmissions through a channel server, into a new log");
  command->add_option("recording", options->log, "LCM log of a run, ours or lcm-logger's")->required();
  command->add_option("--log", options->out, "the new log")->required();
  command->add_option("--scenario", options->scenario,
                      "water, modems and terrain; default: the configuration recorded beside the log");
  command->add_option("--set", options->overrides, "change a key: section.key=value (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  command->add_flag("--quiet", options->quiet, "no progress line, errors only");
  command->footer(
      footer("  halocline replay runs/seamount/seamount.lcm --log quiet.lcm --set environment.wind_mps=0"));
  command->callback([options, &exit_code] { exit_code = replay(*options); });
}

}  // namespace halocline::clients
