// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <stdexcept>

#include "bus/files/output_check.h"
#include "bus/files/version_text.h"
#include "bus/runtime/node_process.h"
#include "bus/transport.h"
#include "clients/halocline/commands.h"

namespace hc = halocline::clients;

namespace {

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
        hc::add_waveform_command, hc::add_view_command, hc::add_config_command, hc::add_completion_command}) {
    add(app, exit_code);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Simulation of AUVs with acoustic communication: run scenarios, compute links, read logs.",
               "halocline");
  int exit_code = hc::kDone;
  describe(app, exit_code);
  const auto checked = [](int code) {
    if (code != hc::kDone || halocline::bus::output_is_whole()) return code;
    std::fprintf(stderr, "halocline: standard output could not be written\n");
    return hc::kFailed;
  };
  try {
    app.parse(argc, argv);
    return checked(exit_code);
  } catch (const CLI::ParseError& error) {
    return checked(app.exit(error) == 0 ? hc::kDone : hc::kUserError);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "halocline: %s\n", error.what());
    if (dynamic_cast<const halocline::bus::NetworkError*>(&error) != nullptr)
      return halocline::bus::kExitNetwork;
    return dynamic_cast<const std::invalid_argument*>(&error) != nullptr ? hc::kUserError : hc::kFailed;
  }
}
