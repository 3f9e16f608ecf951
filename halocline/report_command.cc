// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "bus/logs/log_reader.h"
#include "core/atomic_file.h"
#include "halocline/commands.h"
#include "runs/analysis/comparison.h"
#include "runs/analysis/read_timeline.h"
#include "runs/analysis/run_files.h"
#include "viewer/report/report_page.h"

namespace halocline::clients {
namespace {

struct ReportArguments {
  std::vector<std::string> logs;
  std::string out;
  bool force = false;
};

int write_report(ReportArguments arguments) {
  for (std::string& log : arguments.logs) log = log_of_run(log);
  const bool is_one = arguments.logs.size() == 1;
  const std::string out = arguments.out.empty() ? report_beside(arguments.logs.back()) : arguments.out;
  require_free({{out}, arguments.force}, arguments.logs);
  const LoggedTimeline first = read_timeline({arguments.logs.front()});
  print_remarks(std::cerr, first);
  const ReportPart part{arguments.logs.front(), first.timeline, first.remarks};
  bool is_whole = first.is_whole;
  if (is_one) {
    replace_file(out, report_page(part));
  } else {
    const LoggedTimeline second = read_timeline({arguments.logs.back()});
    print_remarks(std::cerr, second);
    is_whole = is_whole && second.is_whole;
    LogReader before(arguments.logs.front()), after(arguments.logs.back());
    replace_file(out, report_page(part, {arguments.logs.back(), second.timeline, second.remarks},
                                  Comparison(outcomes_of(before), outcomes_of(after))));
  }
  if (is_one) print_summary(std::cout, first.timeline);
  std::cout << "report      " << out << "\n";
  return is_whole ? kDone : kFailed;
}

}  // namespace

void add_report_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command = app.add_subcommand("report", "Write one page about a log, or about two side by side");
  command
      ->add_option("log", arguments->logs,
                   "LCM log, or the folder of a run; two for a comparison, such as a run and its replay")
      ->required()
      ->expected(1, 2);
  command->add_option("--out", arguments->out,
                      "HTML file; default: the (second) log's name, ending in .html");
  add_force_option(*command, arguments->force);
  command->footer(
      footer("  halocline report results/seamount/seamount.lcm\n"
             "  halocline report results/seamount/seamount.lcm calm.lcm --out calm.html"));
  command->callback([arguments, &exit_code] { exit_code = write_report(*arguments); });
}

}  // namespace halocline::clients
