// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "bus/logs/log_reader.h"
#include "core/check.h"
#include "core/files/input_file.h"
#include "halocline/commands.h"
#include "runs/analysis/run_files.h"
#include "simulation/calibration/calibration.h"
#include "simulation/calibration/calibration_output.h"
#include "simulation/calibration/trial_data.h"
#include "simulation/calibration/trial_log.h"
#include "simulation/composition.h"
#include "simulation/link_survey.h"

namespace halocline::clients {
namespace {

struct CalibrateOptions {
  std::string data, scenario, write;
  std::vector<std::string> overrides;
  bool force = false;
};

std::vector<TrialRow> rows_of(const CalibrateOptions& options, const ScenarioConfig& config) {
  if (const std::string reason = why_unreadable(options.data); !reason.empty())
    throw InvalidArgument(options.data + ": cannot be read: " + reason);
  if (options.data.ends_with(".csv")) {
    std::ifstream file(options.data);
    const auto terrain = make_terrain(config).terrain;
    return read_trial_csv(file, options.data, [&](const std::string& end) -> std::string {
      try {
        require_above_seabed(*terrain, link_end(config, end));
      } catch (const InvalidArgument& error) {
        return error.what();
      }
      return {};
    });
  }
  LogReader log(options.data);
  TrialLog trial = read_trial_log(log, config);
  report_damage(std::cerr, log);
  for (const std::string& note : trial.notes) std::cerr << "note: " << note << "\n";
  require(!trial.rows.empty(), options.data + " holds no outcome that tells of this scenario's sea");
  return trial.rows;
}

int calibrate_scenario(const CalibrateOptions& options) {
  require_free({{options.write}, options.force}, {options.data, options.scenario});
  const ScenarioConfig config = load_scenario(options.scenario, options.overrides, ScenarioUse::kWater);
  const Calibration result = calibrate(config, rows_of(options, config));
  std::cout << to_text(result);
  const std::string keys = to_toml(result, config, options.data);
  if (options.write.empty())
    std::cout << "\n" << keys;
  else
    write_output(options.write, keys);
  return kDone;
}

}  // namespace

void add_calibrate_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command = app.add_subcommand(
      "calibrate", "Fit noise, bottom, slow changes and echoes of a scenario to what was measured at sea");
  command
      ->add_option(
          "data", options->data,
          "CSV with the columns time, from, to and sent, received, or level_db, or snr_db; or an LCM log")
      ->required();
  command
      ->add_option("scenario", options->scenario,
                   "scenario file (TOML), with the trial's vehicles at their places")
      ->required();
  command->add_option(
      "--write", options->write,
      "FILE.toml for the calibrated keys, which the scenario includes; default: standard output");
  command->add_option("--set", options->overrides, "change a key: section.key=value (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  add_force_option(*command, options->force);
  command->footer(
      "Times in CSV are numbers of seconds or dates such as 2026-05-03T14:00:00Z, in any order; from and to "
      "are vehicles\n"
      "of the scenario or places \"NORTH,EAST,DOWN\" in quotes. The scenario then begins with include = "
      "\"FILE.toml\".\n\n" +
      footer("  halocline calibrate first_days.csv bay.toml --write bay_calibrated.toml\n"
             "  halocline link bay.toml --from a --to b --ensemble 20"));
  command->callback([options, &exit_code] { exit_code = calibrate_scenario(*options); });
}

}  // namespace halocline::clients
