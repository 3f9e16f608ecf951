// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "bus/logs/log_reader.h"
#include "core/check.h"
#include "halocline/commands.h"
#include "runs/analysis/outcome_summary.h"
#include "runs/analysis/run_files.h"

namespace halocline::clients {
namespace {

struct OutcomesArguments {
  std::vector<std::string> logs;
  std::string format = "table", plot;
  double window_s = 60;
  bool force = false;
};

// Returns how complete the outcomes are according to the RECEIPTs.
std::string coverage_of(const PacketAccount::Missing& missing, bool is_whole) {
  if (missing.accepted == 0) return "; the log holds no accepted RECEIPT to count them by";
  if (missing.without_outcome > 0)
    return "; " + std::to_string(missing.without_outcome) + " of " + std::to_string(missing.accepted) +
           " accepted packets have none";
  if (!is_whole) return "; the log is not whole";
  return ", one for each packet and possible receiver";
}

void print_table(const OutcomeSummary& summary, const PacketAccount::Missing& missing, bool is_whole) {
  print(std::cout, summary, coverage_of(missing, is_whole));
  if (missing.under_way > 0)
    std::cout << "under way at the end, perhaps: " << missing.under_way << " of " << missing.accepted
              << " accepted packets\n";
}

int show_outcomes(const OutcomesArguments& arguments) {
  if (!arguments.plot.empty()) require_plot_file(arguments.plot);
  require_free({{arguments.plot}, arguments.force}, arguments.logs);
  LogReader log(arguments.logs);
  const OutcomeSummary summary = summary_of(log, std::llround(arguments.window_s * 1e6));
  const bool is_whole = report_damage(std::cerr, log);
  if (arguments.format == "json")
    std::cout << to_json(summary) << "\n";
  else if (arguments.format == "csv")
    print_csv(std::cout, summary);
  else if (arguments.format == "outcomes")
    print_outcomes_csv(std::cout, summary);
  else
    print_table(summary, log.contents().missing(), is_whole);
  if (!arguments.plot.empty()) write_plot(outcome_plot(summary, arguments.logs.front()), arguments.plot);
  return is_whole ? kDone : kFailed;
}

}  // namespace

void add_outcomes_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<OutcomesArguments>();
  CLI::App* command =
      app.add_subcommand("outcomes", "Count the packet outcomes of a log by outcome, pair and time window");
  command->alias("ledger");
  command->add_option("log", arguments->logs, "LCM log, or the parts of one in order")->required();
  command
      ->add_option(
          "--format", arguments->format,
          "table; json; csv: a row a pair and outcome; outcomes: CSV, a row an outcome with its numbers")
      ->check(CLI::IsMember({"table", "json", "csv", "outcomes"}));
  command->add_option("--window-s", arguments->window_s, "length of the windows of time, seconds")
      ->check(CLI::Range(1e-3, 1e9));
  command->add_option("--plot", arguments->plot,
                      "also draw the outcomes and their course over time: FILE.png or FILE.svg");
  add_force_option(*command, arguments->force);
  command->footer(
      "Outcomes (docs/packets.md has the rest):\n"
      "  shadow        the water bends every ray away\n"
      "  blocked       the terrain stops every ray\n"
      "  too weak      rays arrive that lost too much at their bounces\n"
      "  too steep     rays arrive only more steeply than is searched (80 degrees)\n"
      "  no terrain    the terrain ends or has no data on the way (propagation.beyond = \"none\")\n"
      "  out of reach  so far away that its sound cannot matter; counted, in one row a packet\n"
      "  foreign       the packet's waveform is not of the receiver's family\n"
      "  not acquired  the preamble was missed; bit errors: the bits after it\n\n" +
      footer("  halocline outcomes results/harbour/harbour.lcm\n"
             "  halocline outcomes results/harbour/harbour.lcm --format outcomes > outcomes.csv"));
  command->callback([arguments, &exit_code] { exit_code = show_outcomes(*arguments); });
}

}  // namespace halocline::clients
