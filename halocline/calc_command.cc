// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>

#include <fmt/format.h>

#include "core/check.h"
#include "core/files/input_file.h"
#include "halocline/calc/calc.h"
#include "halocline/calc/quantity.h"
#include "halocline/commands.h"
#include "runs/analysis/run_files.h"

namespace halocline::clients {
namespace {

struct CalcArguments {
  CalcOptions options;
  std::string input, output;
  bool force = false;
};

int calc(CalcArguments& arguments) {
  if (arguments.options.quantity.empty()) arguments.options.list = true;
  require_free({{arguments.output}, arguments.force}, {arguments.input});
  std::ifstream file;
  if (!arguments.input.empty() && arguments.input != "-") file = open_input(arguments.input);
  std::ostringstream text;  // nothing is written unless everything succeeds
  const int code = run_calc(arguments.options, file.is_open() ? file : std::cin, text, std::cerr);
  if (code == kDone) write_output(arguments.output, text.str());
  return code;
}

}  // namespace

void add_calc_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<CalcArguments>();
  CLI::App* command = app.add_subcommand("calc", "Compute a quantity for each row of a table (CSV)");
  command->add_option("quantity", arguments->options.quantity,
                      fmt::format("one of: {}", fmt::join(quantity_names(), ", ")));
  command->add_option("input", arguments->input, "CSV with the columns of the quantity; default or -: stdin");
  command->add_option("--out", arguments->output, "CSV with the results appended; default or -: stdout");
  command->add_option("--model", arguments->options.model,
                      "formula, or a modem's name or file; --list names them");
  command->add_option("--profile", arguments->options.profile, "sound-speed profile: built-in name or file");
  command->add_option("--latitude", arguments->options.latitude_deg, "degrees, -90 to 90")
      ->check(CLI::Range(-90.0, 90.0));
  command->add_option("--longitude", arguments->options.longitude_deg, "degrees")
      ->check(CLI::Range(-180.0, 360.0));
  command->add_flag("--list", arguments->options.list, "describe the quantities, or the one named, and exit");
  add_force_option(*command, arguments->force);
  command->footer(footer(
      "  printf 'T_degC,S_ppt,depth_m\\n25,35,1000\\n' | halocline calc sound-speed --model mackenzie\n"
      "  halocline calc --list"));
  command->callback([arguments, &exit_code] { exit_code = calc(*arguments); });
}

}  // namespace halocline::clients
