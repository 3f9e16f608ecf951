// SPDX-License-Identifier: BSD-3-Clause
#include "runs/analysis/log_statistics.h"

#include <algorithm>
#include <type_traits>

#include <fmt/ostream.h>
#include <nlohmann/json.hpp>

#include "bus/logs/channel_types.h"

namespace halocline::clients {
namespace {

std::map<std::string, std::int64_t> by_family(const LogStatistics& s) {
  std::map<std::string, std::int64_t> families;
  for (const auto& [channel, count] : s.by_channel) families[std::string(family_of(channel))] += count;
  return families;
}

// Returns the minimum, median and maximum of a list that is not empty.
std::tuple<double, double, double> spread(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  const double median = values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
  return {values.front(), median, values.back()};
}

template <std::size_t N>
void print_named(std::ostream& out, const char* title, const std::array<std::int64_t, N>& counts,
                 const char* (*name)(std::size_t)) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < N; ++i) {
    if (counts[i] > 0) texts.push_back(fmt::format("{} {}", counts[i], name(i)));
  }
  fmt::print(out, "{}{}\n", title, texts.empty() ? "none" : fmt::format("{}", fmt::join(texts, ", ")));
}

}  // namespace

template <class Message>
void LogStatistics::count_message(const LoggedEvent& event, const Message& message) {
  if constexpr (std::is_same_v<Message, modem_receipt_t>) {
    if (!answered_.emplace(event.channel, message.send_session, message.packet_sequence).second) return;
    ++receipts.at(static_cast<std::size_t>(message.receipt_result));
    ++packets_sent;
  } else if constexpr (std::is_same_v<Message, modem_receive_t>) {
    ++packets_delivered;
    if (message.stamped != 0) travel_times_s.push_back(message.travel_time_s);
  } else if constexpr (std::is_same_v<Message, packet_outcome_t>) {
    outcomes.at(static_cast<std::size_t>(message.outcome)) += message.num_receivers;
  }
}

void LogStatistics::count(const LoggedEvent& event, const std::function<std::string()>& place) {
  if (events++ == 0) first_stamp_us = event.stamp_us;
  last_stamp_us = event.stamp_us;
  bytes += static_cast<std::int64_t>(event.data.size());
  ++by_channel[event.channel];
  const bool ours = with_type_of(event.channel, [&]<class Message>() {
    Message message;
    if (decode_checked(event.data, message)) return count_message(event, message);
    ++undecodable;
    Undecodable& on_channel = undecodable_by_channel[event.channel];
    if (on_channel.count++ == 0) on_channel.first_at = place();
  });
  if (ours) return;
  ++foreign;
  ++foreign_by_channel[event.channel];
}

LogStatistics statistics_of(LogReader& log) {
  LogStatistics statistics;
  LoggedEvent event;
  while (log.next(event)) statistics.count(event, [&] { return place_of(log, event); });
  statistics.files = log.files();
  statistics.bad_stretches = log.bad_stretches();
  statistics.flows = log.flows().remarkable();
  return statistics;
}

void print(std::ostream& out, const LogStatistics& s) {
  fmt::print(out, "messages    {} ({:.1f} MB), stamps {:.3f} s to {:.3f} s\n", s.events,
             static_cast<double>(s.bytes) / 1e6, static_cast<double>(s.first_stamp_us) * 1e-6,
             static_cast<double>(s.last_stamp_us) * 1e-6);
  for (const auto& [family, count] : by_family(s)) fmt::print(out, "  {:<14}{:>9}\n", family, count);
  fmt::print(out, "packets     {} sent, {} delivered\n", s.packets_sent, s.packets_delivered);
  print_named(out, "  receipts  ", s.receipts, receipt_name);
  print_named(out, "  outcomes  ", s.outcomes, outcome_name);
  if (!s.travel_times_s.empty()) {
    const auto [least, median, greatest] = spread(s.travel_times_s);
    fmt::print(out, "  delay     {:.6f} s least, {:.6f} s median, {:.6f} s greatest\n", least, median,
               greatest);
  }
  if (s.files.size() > 1) fmt::print(out, "files       {}, the first {}\n", s.files.size(), s.files.front());
  if (s.foreign > 0) fmt::print(out, "foreign     {} events on channels that are none of ours\n", s.foreign);
  for (const auto& [channel, count] : s.foreign_by_channel)
    fmt::print(out, "  {:<14}{:>9}\n", channel, count);
  for (const auto& [channel, undecodable] : s.undecodable_by_channel)
    fmt::print(out, "undecodable {} on {}, the first at {}\n", undecodable.count, channel,
               undecodable.first_at);
}

std::string to_json(const LogStatistics& s) {
  nlohmann::ordered_json json;
  json["events"] = s.events;
  json["bytes"] = s.bytes;
  json["first_stamp_us"] = s.first_stamp_us;
  json["last_stamp_us"] = s.last_stamp_us;
  json["by_channel"] = s.by_channel;
  json["packets_sent"] = s.packets_sent;
  json["packets_delivered"] = s.packets_delivered;
  for (std::size_t i = 0; i < s.receipts.size(); ++i) json["receipts"][receipt_name(i)] = s.receipts[i];
  for (std::size_t i = 0; i < s.outcomes.size(); ++i) json["outcomes"][outcome_name(i)] = s.outcomes[i];
  if (!s.travel_times_s.empty()) {
    const auto [least, median, greatest] = spread(s.travel_times_s);
    json["delay_s"] = {{"least", least}, {"median", median}, {"greatest", greatest}};
  }
  json["foreign"] = s.foreign;
  json["foreign_by_channel"] = s.foreign_by_channel;
  json["undecodable"] = nlohmann::ordered_json::object();
  for (const auto& [channel, undecodable] : s.undecodable_by_channel)
    json["undecodable"][channel] = {{"count", undecodable.count}, {"first_at", undecodable.first_at}};
  json["files"] = s.files;
  json["bad_stretches"] = nlohmann::ordered_json::array();
  for (const BadStretch& bad : s.bad_stretches) {
    json["bad_stretches"].push_back({{"file", s.files.at(bad.file)},
                                     {"offset", bad.offset},
                                     {"bytes", bad.bytes},
                                     {"cut_short", bad.cut_short}});
  }
  json["missing"] = nlohmann::ordered_json::object();
  json["sessions"] = nlohmann::ordered_json::object();
  for (const LogFlows::OfChannel& one : s.flows) {
    if (one.missing > 0) json["missing"][one.channel] = one.missing;
    if (one.sessions > 1) json["sessions"][one.channel] = one.sessions;
  }
  return json.dump(2);
}

}  // namespace halocline::clients
