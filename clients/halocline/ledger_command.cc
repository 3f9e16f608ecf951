#include <cmath>
#include <iostream>
#include <memory>

#include "clients/halocline/analysis/ledger.h"
#include "clients/halocline/commands.h"
#include "core/check.h"

namespace halocline::clients {
namespace {

struct LedgerArguments {
  std::vector<std::string> logs;
  std::string format = "table", plot;
  double window_s = 60;
};

int sum_up(const LedgerArguments& arguments) {
  if (!arguments.plot.empty()) require_plot_file(arguments.plot);
  LogReader log(arguments.logs);
  const Ledger ledger = ledger_of(log, std::llround(arguments.window_s * 1e6));
  if (arguments.format == "json")
    std::cout << to_json(ledger) << "\n";
  else if (arguments.format == "csv")
    print_csv(std::cout, ledger);
  else if (arguments.format == "outcomes")
    print_outcomes_csv(std::cout, ledger);
  else
    print(std::cout, ledger);
  tell_damage(std::cerr, log);
  if (!arguments.plot.empty()) write_plot(ledger_plot(ledger, arguments.logs.front()), arguments.plot);
  return kDone;
}

}  // namespace

void add_ledger_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<LedgerArguments>();
  CLI::App* command =
      app.add_subcommand("ledger", "Sum up what became of the packets of a log, by cause, pair and time");
  command->add_option("log", arguments->logs, "LCM log, or the parts of one in order")->required();
  command
      ->add_option(
          "--format", arguments->format,
          "table; json; csv: a row a pair and cause; outcomes: CSV, a row an outcome with its numbers")
      ->check(CLI::IsMember({"table", "json", "csv", "outcomes"}));
  command->add_option("--window-s", arguments->window_s, "length of the windows of time, seconds")
      ->check(CLI::Range(1e-3, 1e9));
  command->add_option("--plot", arguments->plot, "also draw causes and their course: FILE.png or FILE.svg");
  command->footer(
      footer("  halocline ledger runs/harbour/harbour.lcm\n"
             "  halocline ledger runs/harbour/harbour.lcm --format outcomes > outcomes.csv"));
  command->callback([arguments, &exit_code] { exit_code = sum_up(*arguments); });
}

}  // namespace halocline::clients
