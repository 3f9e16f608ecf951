// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bus/logs/log_reader.h"
#include "core/check.h"
#include "halocline/commands.h"
#include "runs/analysis/csv_export.h"
#include "runs/analysis/log_statistics.h"
#include "runs/analysis/read_timeline.h"
#include "runs/analysis/run_files.h"
#include "runs/analysis/simulation_output.h"
#include "runs/export/run_export.h"
#include "runs/timeline/run_timeline.h"

namespace halocline::clients {
namespace {

struct LogArguments {
  std::vector<std::string> logs;
  std::string out, channel, origin, format = "csv";
  bool json = false, force = false;
};

int info(const LogArguments& arguments) {
  LogReader log(arguments.logs);
  const LogStatistics statistics = statistics_of(log);
  if (arguments.json) {
    std::cout << to_json(statistics) << "\n";
  } else {
    print(std::cout, statistics);
  }
  const bool is_whole = report_damage(std::cerr, log) && statistics.undecodable == 0;
  return is_whole ? kDone : kFailed;
}

// Exports the run that the logs hold into one file.
int export_run(const LogArguments& arguments) {
  require(arguments.channel.empty(), "--channel is for --format csv alone");
  LoggedTimeline log = read_timeline(arguments.logs);
  RunTimeline& timeline = log.timeline;
  if (!arguments.origin.empty()) set_origin(timeline, arguments.origin);
  const std::map<std::string, void (*)(const RunTimeline&, const std::string&)> writers{
      {"mcap", export_mcap}, {"netcdf", export_netcdf}, {"geojson", export_geojson}, {"gpx", export_gpx}};
  writers.at(arguments.format)(timeline, arguments.out);
  std::cout << arguments.out << ": " << timeline.vehicles().size() << " vehicles, "
            << timeline.packets().all().size() << " packets\n";
  print_remarks(std::cerr, log);
  return log.is_whole ? kDone : kFailed;
}

int export_all(const LogArguments& arguments) {
  require_free({{arguments.out}, arguments.force}, arguments.logs);
  if (arguments.format != "csv") return export_run(arguments);
  LogReader log(arguments.logs);
  const ExportResult result = export_csv(log, arguments.out, arguments.channel);
  for (const auto& [file, rows] : result.rows_by_file) std::cout << file << ": " << rows << " rows\n";
  if (result.foreign > 0)
    std::cout << "left out: " << result.foreign << " events on channels that are none of ours\n";
  if (result.undecodable > 0)
    std::cout << "left out: " << result.undecodable << " events that do not decode\n";
  const bool is_whole = report_damage(std::cerr, log) && result.undecodable == 0;
  return is_whole ? kDone : kFailed;
}

int write_output(const LogArguments& arguments) {
  require_free({files_of_log(arguments.out), arguments.force}, arguments.logs);
  LogReader log(arguments.logs);
  std::cout << arguments.out << ": " << write_simulation_output(log, arguments.out) << " events\n";
  return report_damage(std::cerr, log) ? kDone : kFailed;
}

}  // namespace

void add_log_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<LogArguments>();
  CLI::App* command = app.add_subcommand("log", "Inspect an LCM log, or export it");
  command->require_subcommand(1);
  command->footer(footer("  halocline log info results/seamount/seamount.lcm"));
  CLI::App* info_command =
      command->add_subcommand("info", "Print what a log holds: messages, packets, damage");
  info_command->add_option("log", arguments->logs, "LCM log, or the parts of one in order")->required();
  info_command->add_flag("--json", arguments->json, "as JSON");
  info_command->footer(footer("  halocline log info results/seamount/seamount.lcm --json"));
  info_command->callback([arguments, &exit_code] { exit_code = info(*arguments); });
  CLI::App* export_command =
      command->add_subcommand("export", "Write a log as CSV files, MCAP, netCDF, GeoJSON or GPX");
  export_command->add_option("log", arguments->logs, "LCM log, or the parts of one in order")->required();
  export_command->add_option("--out", arguments->out, "folder of the CSV files; the file of another format")
      ->required();
  export_command
      ->add_option("--format", arguments->format,
                   "csv: a file for each channel family; mcap: scene, positions and log for Foxglove; "
                   "netcdf: trajectories "
                   "(CF); geojson, gpx: tracks")
      ->check(CLI::IsMember({"csv", "mcap", "netcdf", "geojson", "gpx"}))
      ->capture_default_str();
  export_command->add_option("--origin", arguments->origin,
                             "LATITUDE,LONGITUDE of the coordinates' origin, where the log does not hold it");
  export_command->add_option("--channel", arguments->channel,
                             "only channels that match this regular expression");
  add_force_option(*export_command, arguments->force);
  export_command->footer(
      footer("  halocline log export run.lcm --out csv --channel 'STATE\\..*|OUTCOME'\n"
             "  halocline log export run.lcm --format mcap --out run.mcap"));
  export_command->callback([arguments, &exit_code] { exit_code = export_all(*arguments); });
  CLI::App* output_command = command->add_subcommand(
      "output", "Write the simulation output alone: the same bytes from one channel server and from shards");
  output_command->add_option("log", arguments->logs, "LCM log, or the parts of one in order")->required();
  output_command->add_option("--out", arguments->out, "LCM log to be written")->required();
  add_force_option(*output_command, arguments->force);
  output_command->footer(footer("  halocline log output run.lcm --out output.lcm && sha256sum output.lcm"));
  output_command->callback([arguments, &exit_code] { exit_code = write_output(*arguments); });
}

}  // namespace halocline::clients
