// SPDX-License-Identifier: BSD-3-Clause
// Subcommands of `halocline`. Each adds itself to the command line. When it is chosen, its callback does the
// work and sets the exit code: 0 done, 1 failed, 2 error of the user, 130 interrupted by Ctrl-C. Exceptions
// are reported by main.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace halocline::clients {

inline constexpr int kDone = 0, kFailed = 1, kUserError = 2;
inline constexpr int kInterrupted = 130;  // 128 + SIGINT, as in shells
inline constexpr const char* kExitCodes =
    "Exit codes: 0 done, 1 failed, 2 wrong command line or configuration, 69 the network cannot be used, "
    "130 interrupted by Ctrl-C.";

// Returns the end of a subcommand's --help.
std::string footer(const std::string& examples);

// Adds --force, which each command that writes files has; see require_free (analysis/run_files.h).
void add_force_option(CLI::App& command, bool& force);

// Adds the options that `run` and `replay` share.
void add_rotation_options(CLI::App& command, std::vector<std::string>& rotate, int& keep_parts);

void add_run_command(CLI::App& app, int& exit_code);
void add_link_command(CLI::App& app, int& exit_code);
void add_coverage_command(CLI::App& app, int& exit_code);
void add_calibrate_command(CLI::App& app, int& exit_code);
void add_calc_command(CLI::App& app, int& exit_code);
void add_arrivals_command(CLI::App& app, int& exit_code);
void add_report_command(CLI::App& app, int& exit_code);
void add_outcomes_command(CLI::App& app, int& exit_code);
void add_log_command(CLI::App& app, int& exit_code);
void add_replay_command(CLI::App& app, int& exit_code);
void add_compare_command(CLI::App& app, int& exit_code);
void add_sweep_command(CLI::App& app, int& exit_code);
void add_vehicle_command(CLI::App& app, int& exit_code);
void add_config_command(CLI::App& app, int& exit_code);
void add_view_command(CLI::App& app, int& exit_code);
void add_waveform_command(CLI::App& app, int& exit_code);
void add_completion_command(CLI::App& app, int& exit_code);

}  // namespace halocline::clients
