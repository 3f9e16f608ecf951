// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "bathymetry/rasters/raster_options.h"
#include "bus/runtime/node_process.h"
#include "bus/runtime/output_check.h"
#include "bus/runtime/version_text.h"
#include "bus/transport/transport.h"
#include "core/names.h"
#include "halocline/commands.h"

namespace hc = halocline::clients;

namespace {

// Refuses NaN, which the ranges of CLI11 accept.
void refuse_nan(CLI::App& app) {
  const auto check = [](const std::string& text) {
    return std::isnan(std::strtod(text.c_str(), nullptr)) ? "Value " + text + " is no number" : std::string();
  };
  for (CLI::Option* option : app.get_options()) {
    if (option->get_type_name().starts_with("FLOAT")) option->check(check);
  }
  for (CLI::App* command : app.get_subcommands({})) refuse_nan(*command);
}

// Adds an option that also holds for the programs that a run starts.
void add_any_raster_option(CLI::App& app) {
  const auto allow = [](std::int64_t) { setenv(halocline::bathymetry::kAnyRaster, "1", 1); };
  app.add_flag_function("--any-raster", allow,
                        "rasters may be anything that GDAL opens: virtual files and servers, too")
      ->trigger_on_parse();
}

void describe(CLI::App& app, int& exit_code) {
  app.set_version_flag("--version", [] { return halocline::bus::version_text("halocline"); });
  app.require_subcommand(1);
  app.footer(
      hc::footer("  halocline run scenarios/seamount.toml\n  halocline link scenarios/seamount.toml --from "
                 "auv-1 --to auv-2\n  halocline SUBCOMMAND --help"));
  for (const auto add :
       {hc::add_run_command, hc::add_link_command, hc::add_coverage_command, hc::add_arrivals_command,
        hc::add_calc_command, hc::add_report_command, hc::add_outcomes_command, hc::add_log_command,
        hc::add_replay_command, hc::add_compare_command, hc::add_sweep_command, hc::add_vehicle_command,
        hc::add_calibrate_command, hc::add_waveform_command, hc::add_view_command, hc::add_config_command,
        hc::add_completion_command}) {
    add(app, exit_code);
  }
  add_any_raster_option(app);
  refuse_nan(app);
}

// Returns an error message for an unknown subcommand; empty when all subcommands are known.
std::string wrong_subcommand(const CLI::App& app, int argc, char** argv) {
  const CLI::App* command = &app;
  for (int i = 1; i < argc && argv[i][0] != '-'; ++i) {
    const auto all = command->get_subcommands({});
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const CLI::App* one) { return one->check_name(argv[i]); });
    if (all.empty()) return "";
    if (found == all.end()) {
      std::string allowed;
      for (const CLI::App* one : all) allowed += (allowed.empty() ? "" : ", ") + one->get_name();
      return "'" + std::string(argv[i]) + "' is no subcommand of " + command->get_name() + "; allowed are " +
             allowed;
    }
    command = *found;
  }
  return "";
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Simulation of AUVs with acoustic communication: run scenarios, compute links, read logs.",
               "halocline");
  int exit_code = hc::kDone;
  describe(app, exit_code);
  const auto checked = [](int code) {
    if (code != hc::kDone || halocline::bus::output_is_whole()) return code;
    halocline::bus::print_failure("halocline", "standard output could not be written");
    return hc::kFailed;
  };
  try {
    app.parse(argc, argv);
    return checked(exit_code);
  } catch (const CLI::ParseError& error) {
    if (const std::string wrong = wrong_subcommand(app, argc, argv); !wrong.empty()) {
      halocline::bus::print_failure("halocline", wrong);
      return hc::kUserError;
    }
    std::ostringstream said;
    const int code = app.exit(error, std::cout, said);
    std::cerr << halocline::without_controls(said.str());
    return checked(code == 0 ? hc::kDone : hc::kUserError);
  } catch (const std::exception& error) {
    halocline::bus::print_failure("halocline", error.what());
    if (dynamic_cast<const halocline::bus::NetworkError*>(&error) != nullptr)
      return halocline::bus::kExitNetwork;
    return dynamic_cast<const std::invalid_argument*>(&error) != nullptr ? hc::kUserError : hc::kFailed;
  }
}
