#include <cstdio>
#include <stdexcept>

#include "bus/version.h"
#include "clients/halocline/commands.h"

namespace hc = halocline::clients;

int main(int argc, char** argv) {
  CLI::App app("AUVs that talk through water: run scenarios, ask the water, read logs.", "halocline");
  app.set_version_flag("--version", halocline::bus::kVersion);
  app.require_subcommand(1);
  app.footer(
      hc::footer("  halocline run scenarios/seamount.toml\n  halocline link scenarios/seamount.toml --from "
                 "auv-1 --to auv-2\n  halocline SUBCOMMAND --help"));
  int exit_code = hc::kDone;
  for (const auto add :
       {hc::add_run_command, hc::add_link_command, hc::add_arrivals_command, hc::add_calc_command,
        hc::add_ledger_command, hc::add_log_command, hc::add_replay_command, hc::add_compare_command,
        hc::add_sweep_command, hc::add_vehicle_command, hc::add_config_command, hc::add_completion_command}) {
    add(app, exit_code);
  }
  try {
    app.parse(argc, argv);
    return exit_code;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? hc::kDone : hc::kUserError;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "halocline: %s\n", error.what());
    return hc::kUserError;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "halocline: %s\n", error.what());
    return hc::kFailed;
  }
}
