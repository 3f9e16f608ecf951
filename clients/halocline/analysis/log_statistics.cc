#include "clients/halocline/analysis/log_statistics.h"

#include <algorithm>
#include <iomanip>
#include <ostream>
#include <sstream>
#include <type_traits>

#include <nlohmann/json.hpp>

#include "bus/logs/channel_types.h"
#include "bus/message_fields.h"

namespace halocline::clients {
namespace {

constexpr auto& kReceiptNames = kModemReceiptReceiptResultNames;
constexpr auto& kFateNames = kPacketOutcomeOutcomeNames;

std::map<std::string, std::int64_t> by_family(const LogStatistics& s) {
  std::map<std::string, std::int64_t> families;
  for (const auto& [channel, count] : s.by_channel) families[std::string(family_of(channel))] += count;
  return families;
}

// Least, middle and greatest of a list that is not empty.
std::tuple<double, double, double> spread(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  const double median = values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
  return {values.front(), median, values.back()};
}

template <std::size_t N>
void print_named(std::ostream& out, const char* title, const std::array<std::int64_t, N>& counts,
                 const std::array<const char*, N>& names) {
  out << title;
  bool any = false;
  for (std::size_t i = 0; i < N; ++i) {
    if (counts[i] == 0) continue;
    out << (any ? ", " : "") << counts[i] << " " << names[i];
    any = true;
  }
  out << (any ? "\n" : "none\n");
}

}  // namespace

const char* receipt_name(std::size_t result) {
  return result < kReceiptNames.size() ? kReceiptNames[result] : "?";
}
const char* fate_name(std::size_t fate) { return fate < kFateNames.size() ? kFateNames[fate] : "?"; }

// What one sound message adds.
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
    ++outcomes.at(static_cast<std::size_t>(message.outcome));
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
  return statistics;
}

void print(std::ostream& out, const LogStatistics& s) {
  out << std::fixed;
  out << "messages    " << s.events << " (" << std::setprecision(1) << static_cast<double>(s.bytes) / 1e6
      << " MB), stamps " << std::setprecision(3) << static_cast<double>(s.first_stamp_us) * 1e-6 << " s to "
      << static_cast<double>(s.last_stamp_us) * 1e-6 << " s\n";
  for (const auto& [family, count] : by_family(s)) {
    out << "  " << std::left << std::setw(14) << family << std::right << std::setw(9) << count << "\n";
  }
  out << "packets     " << s.packets_sent << " sent, " << s.packets_delivered << " delivered\n";
  print_named(out, "  receipts  ", s.receipts, kReceiptNames);
  print_named(out, "  outcomes  ", s.outcomes, kFateNames);
  if (!s.travel_times_s.empty()) {
    const auto [least, median, greatest] = spread(s.travel_times_s);
    out << "  delay     " << std::setprecision(6) << least << " s least, " << median << " s median, "
        << greatest << " s greatest\n";
  }
  if (s.files.size() > 1)
    out << "files       " << s.files.size() << ", the first " << s.files.front() << "\n";
  if (s.foreign > 0) out << "foreign     " << s.foreign << " events on channels that are none of ours\n";
  for (const auto& [channel, count] : s.foreign_by_channel)
    out << "  " << std::left << std::setw(14) << channel << std::right << std::setw(9) << count << "\n";
  for (const auto& [channel, undecodable] : s.undecodable_by_channel) {
    out << "undecodable " << undecodable.count << " on " << channel << ", the first at "
        << undecodable.first_at << "\n";
  }
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
  for (std::size_t i = 0; i < s.receipts.size(); ++i) json["receipts"][kReceiptNames[i]] = s.receipts[i];
  for (std::size_t i = 0; i < s.outcomes.size(); ++i) json["outcomes"][kFateNames[i]] = s.outcomes[i];
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
  return json.dump(2);
}

}  // namespace halocline::clients
