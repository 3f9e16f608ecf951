// SPDX-License-Identifier: BSD-3-Clause
#include "bus/transport/event_log.h"

#include <array>
#include <memory>

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "core/check.h"
#include "core/names.h"

namespace halocline::bus {
namespace {

constexpr std::array<std::pair<std::string_view, LogLevel>, 5> kLevels{{{"debug", LogLevel::kDebug},
                                                                        {"info", LogLevel::kInfo},
                                                                        {"warning", LogLevel::kWarning},
                                                                        {"error", LogLevel::kError},
                                                                        {"silent", LogLevel::kSilent}}};

spdlog::logger& logger() {
  static const std::shared_ptr<spdlog::logger> instance = [] {
    auto made =
        std::make_shared<spdlog::logger>("halocline", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    made->set_pattern("%L %v");
    made->set_level(spdlog::level::info);
    made->flush_on(spdlog::level::debug);
    return made;
  }();
  return *instance;
}

spdlog::level::level_enum to_spdlog(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug:
      return spdlog::level::debug;
    case LogLevel::kInfo:
      return spdlog::level::info;
    case LogLevel::kWarning:
      return spdlog::level::warn;
    case LogLevel::kError:
      return spdlog::level::err;
    case LogLevel::kSilent:
      return spdlog::level::off;
  }
  return spdlog::level::info;
}

void write(LogLevel level, SimTime now, const std::string& node, std::string_view event,
           std::string_view details) {
  logger().log(to_spdlog(level), "t={:.3f} {} {}{}{}", now.seconds(), node, event, details.empty() ? "" : " ",
               printable(details));
}

}  // namespace

void set_log_level(LogLevel level) { logger().set_level(to_spdlog(level)); }

bool worth_a_report(std::int64_t count) {
  while (count % 10 == 0) count /= 10;
  return count == 1;
}

LogLevel log_level_from_name(std::string_view name) {
  for (const auto& [known, level] : kLevels) {
    if (known == name) return level;
  }
  throw InvalidArgument("log level is '" + std::string(name) +
                        "'; allowed are debug, info, warning, error, silent");
}

void EventLog::debug(std::string_view event, std::string_view details) const {
  write(LogLevel::kDebug, now_, node_name_, event, details);
}
void EventLog::info(std::string_view event, std::string_view details) const {
  write(LogLevel::kInfo, now_, node_name_, event, details);
}
void EventLog::warning(std::string_view event, std::string_view details) const {
  write(LogLevel::kWarning, now_, node_name_, event, details);
}
void EventLog::error(std::string_view event, std::string_view details) const {
  write(LogLevel::kError, now_, node_name_, event, details);
}

}  // namespace halocline::bus
