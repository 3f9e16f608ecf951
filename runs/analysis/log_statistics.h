// SPDX-License-Identifier: BSD-3-Clause
// Statistics of a run, counted from its messages: printed at the end of `halocline run` and by `halocline log
// info`.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "bus/logs/log_flows.h"
#include "bus/logs/log_reader.h"
#include "runs/timeline/outcome_ledger.h"

namespace halocline::clients {

// Counts of a log's events.
struct LogStatistics {
  std::int64_t events = 0;
  std::int64_t bytes = 0;        // size of all payloads
  std::int64_t foreign = 0;      // events on channels that are none of Halocline's
  std::int64_t undecodable = 0;  // events on Halocline's channels that are no valid message
  std::int64_t first_stamp_us = 0, last_stamp_us = 0;
  std::map<std::string, std::int64_t> by_channel;  // all channels
  std::map<std::string, std::int64_t> foreign_by_channel;
  struct Undecodable {
    std::int64_t count = 0;
    std::string first_at;  // "FILE, byte OFFSET"
  };
  std::map<std::string, Undecodable> undecodable_by_channel;
  std::vector<std::string> files;          // parts of the log
  std::vector<BadStretch> bad_stretches;   // parts of the files that are no valid event
  std::vector<LogFlows::OfChannel> flows;  // flows with missing messages or several sessions
  std::int64_t packets_sent = 0;           // packets with a receipt
  std::int64_t packets_delivered = 0;      // number of RECEIVEs
  std::array<std::int64_t, kReceiptResults> receipts{};
  OutcomeCounts outcomes{};
  std::vector<double> travel_times_s;  // received packets with a departure time, in log order

  // Counts an event. `place` is called only when the event does not decode, and returns its position as
  // place_of does.
  void count(const LoggedEvent& event, const std::function<std::string()>& place);

 private:
  template <class Message>
  void count_message(const LoggedEvent& event, const Message& message);
  // Names of the packets whose receipt was counted: a duplicate receipt is not another packet.
  std::set<std::tuple<std::string, std::int64_t, std::int64_t>> answered_;
};

// Counts a whole log, including its damaged parts.
LogStatistics statistics_of(LogReader& log);

void print(std::ostream& out, const LogStatistics& statistics);

std::string to_json(const LogStatistics& statistics);

}  // namespace halocline::clients
