// SPDX-License-Identifier: BSD-3-Clause
#include "runs/analysis/simulation_output.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "bus/logs/channel_types.h"
#include "bus/logs/log_recorder.h"
#include "bus/logs/log_series.h"
#include "bus/messages/message_codec.h"
#include "core/atomic_file.h"
#include "core/check.h"
#include "core/sim_time.h"

namespace halocline::clients {
namespace {

using bus::Bytes;
using Output = std::pair<std::string, Bytes>;  // channel and message

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_between_programs(std::string_view channel) {
  return is_one_of(family_of(channel),
                   {"STATUS", "HEARTBEAT", "REPAIR_REQUEST", "REPAIR", "RAY_QUERY", "RAY_REPLY",
                    "TERRAIN_QUERY", "TERRAIN_REPLY", "MODEM_REPLY", "FOUND_PATHS"});
}

bool is_of_channel_server(std::string_view channel) {
  return is_one_of(family_of(channel),
                   {"SCENARIO", "ENVIRONMENT", "LINKS", "RECEIPT", "RECEIVE", "MODEM_EVENT", "MODEM_ENERGY",
                    "OUTCOME", "LINK_REPLY", "BEST_PLACE_REPLY"});
}

bool is_of_vehicle_sim(std::string_view channel) {
  return is_one_of(family_of(channel),
                   {"STATE", "SENSORS", "DVL", "GPS", "SONAR", "USBL", "BATTERY", "FAULT"});
}

template <class Message>
Bytes without_session(const Bytes& bytes) {
  Message message;
  if (!decode_checked(bytes, message)) return {};
  if constexpr (requires { message.session; }) message.session = 0;
  return bus::encoded(message);
}

template <class Message>
Bytes without_number(const Bytes& bytes) {
  Message message;
  if (!decode_checked(bytes, message)) return {};
  if constexpr (requires { message.session; }) message.session = 0;
  if constexpr (requires { message.sequence; }) message.sequence = 0;
  return bus::encoded(message);
}

// Returns the event as it is compared; empty when it is no simulation output.
std::optional<Output> output_of(const LogReader& log, const LoggedEvent& event) {
  if (is_between_programs(event.channel)) return std::nullopt;
  Bytes bytes = event.data;
  const bool is_ours = with_type_of(event.channel, [&]<class Message>() {
    if (is_of_channel_server(event.channel)) bytes = without_number<Message>(event.data);
    if (is_of_vehicle_sim(event.channel)) bytes = without_session<Message>(event.data);
  });
  if (!is_ours) return std::nullopt;
  require(!bytes.empty(), place_of(log, event) + ": an event on " + event.channel + " does not decode");
  return Output{event.channel, std::move(bytes)};
}

}  // namespace

std::int64_t write_simulation_output(LogReader& log, const std::string& path) {
  std::int64_t stamp_us = 0;
  AtomicFile replacement(path);
  bus::LogRecorder recorder(replacement.temporary_path());
  std::vector<Output> at_stamp;
  const auto write = [&] {
    std::sort(at_stamp.begin(), at_stamp.end());
    for (const auto& [channel, bytes] : at_stamp)
      recorder.record(SimTime::from_utime(stamp_us), channel, bytes);
    at_stamp.clear();
  };
  for (LoggedEvent event; log.next(event);) {
    require(event.stamp_us >= stamp_us || recorder.events() + std::ssize(at_stamp) == 0,
            place_of(log, event) +
                ": the stamp is before that of the event before; allowed are logs in "
                "simulation time, as ours are");
    if (event.stamp_us != stamp_us) write();
    stamp_us = event.stamp_us;
    if (auto output = output_of(log, event)) at_stamp.push_back(std::move(*output));
  }
  write();
  recorder.close();
  for (const std::string& part : bus::parts_of_log(path)) std::filesystem::remove(part);
  replacement.commit();
  return recorder.events();
}

}  // namespace halocline::clients
