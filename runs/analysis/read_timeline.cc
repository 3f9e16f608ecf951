// SPDX-License-Identifier: BSD-3-Clause
#include "runs/analysis/read_timeline.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <type_traits>
#include <utility>

#include <fmt/ostream.h>

#include "bus/logs/channel_types.h"
#include "bus/logs/foreign_message.h"
#include "bus/logs/log_series.h"
#include "bus/messages/channels.h"
#include "core/check.h"
#include "core/files/input_file.h"
#include "runs/analysis/run_files.h"
#include "runs/timeline/run_summary.h"

namespace halocline::clients {
namespace {

// Returns the text of a file; empty when there is no such file.
std::string text_of(const std::string& path) {
  if (!why_unreadable(path).empty()) return {};
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

void take_damage(const LogReader& log, LoggedTimeline& read) {
  std::stringstream report;
  read.is_whole = report_damage(report, log);
  for (std::string line; std::getline(report, line);) read.remarks.push_back(line);
}

}  // namespace

RunTimeBase time_of(LogReader& log) {
  std::vector<std::int64_t> utimes;
  std::int64_t clocks = 0, clocks_at_stamp = 0;
  for (LoggedEvent event; log.next(event);) {
    with_type_of(event.channel, [&]<class Message>() {
      if constexpr (std::is_same_v<Message, vehicle_state_t> || std::is_same_v<Message, sim_clock_t>) {
        Message message{};
        if (!decode_foreign(event.data, message).is_sound()) return;
        if constexpr (std::is_same_v<Message, vehicle_state_t>) {
          utimes.push_back(message.utime);
        } else {
          ++clocks;
          clocks_at_stamp += message.utime == event.stamp_us ? 1 : 0;
        }
      }
    });
  }
  RunTimeBase time;
  if (is_stamped_with_simulation_time(clocks, clocks_at_stamp) || utimes.empty()) return time;
  time.middle_us = middle_of(utimes);
  std::optional<std::int64_t> first;
  for (const std::int64_t utime : utimes) {
    if (time.is_sound(utime)) first = std::min(first.value_or(utime), utime);
  }
  time.zero_us = zero_of(first.value_or(0));
  return time;
}

namespace {

// Returns the name of the configuration beside a log; that of a later part is beside the first.
std::string config_of(const std::string& log) {
  const std::string own = config_beside(log);
  return std::filesystem::exists(own) ? own : config_beside(bus::first_part_of_log(log));
}

}  // namespace

bus::ConfigFile recorded_configuration(const std::vector<std::string>& logs,
                                       const std::vector<std::string>& overrides) {
  LogReader log(logs);
  RunTimeline timeline;
  for (LoggedEvent event; timeline.scenario().toml.empty() && log.next(event);) {
    if (event.channel.ends_with(bus::channels::kScenario))
      timeline.add(event.stamp_us, event.channel, event.data);
  }
  const std::string& recorded = timeline.scenario().toml;
  if (!recorded.empty())
    return bus::ConfigFile::parse(recorded, logs.front() + ", its configuration", overrides);
  const std::string beside = config_of(logs.front());
  require(std::filesystem::exists(beside),
          logs.front() + " does not hold the configuration that it was made with, and there is no " + beside +
              "; name one by --scenario");
  return bus::ConfigFile::load(beside, overrides);
}

void print_remarks(std::ostream& out, const LoggedTimeline& log) {
  for (const std::string& remark : log.remarks) out << remark << "\n";
}

void print_summary(std::ostream& out, const RunTimeline& timeline) {
  for (const SummaryRow& row : run_summary(timeline)) fmt::print(out, "{:<11} {}\n", row.key, row.text);
}

LoggedTimeline read_timeline(const std::vector<std::string>& logs, TimelineLimits limits) {
  const RunTimeBase time = [&] {
    LogReader log(logs);
    return time_of(log);
  }();
  LogReader log(logs);
  LoggedTimeline read{RunTimeline(time, limits), {}};
  RunTimeline& timeline = read.timeline;
  for (LoggedEvent event; log.next(event);) timeline.add(event.stamp_us, event.channel, event.data);
  if (timeline.scenario().toml.empty()) {
    RunScenario scenario = timeline.scenario();
    scenario.toml = text_of(config_of(logs.front()));
    timeline.set_scenario(std::move(scenario));
  }
  take_damage(log, read);
  const TimelineCounts& counts = timeline.counts();
  if (time.zero_us != 0)
    read.remarks.push_back(
        fmt::format("Times are moved: 0 is the recording's {} s.", time.zero_us / 1'000'000));
  if (counts.without_time > 0)
    read.remarks.push_back(
        fmt::format("{} messages carry the time of another clock, or none; they stand at the time that the "
                    "log had reached.",
                    counts.without_time));
  if (timeline.repeated_outcomes() > 0)
    read.remarks.push_back(fmt::format("{} outcomes are in the log more than once; each counts once.",
                                       timeline.repeated_outcomes()));
  if (counts.unknown > 0)
    read.remarks.push_back(fmt::format("{} messages on other channels are left out.", counts.unknown));
  return read;
}

}  // namespace halocline::clients
