// SPDX-License-Identifier: BSD-3-Clause
// Statistics of a run, counted from its messages: for the end of `halocline run` and for `halocline log
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
#include "clients/mission/outcome_ledger.h"

namespace halocline::clients {

struct LogStatistics {
  std::int64_t events = 0;
  std::int64_t bytes = 0;        // of payloads
  std::int64_t foreign = 0;      // on channels that are none of ours
  std::int64_t undecodable = 0;  // on our channels, but no sound message
  std::int64_t first_stamp_us = 0, last_stamp_us = 0;
  std::map<std::string, std::int64_t> by_channel;  // all channels
  std::map<std::string, std::int64_t> foreign_by_channel;
  struct Undecodable {
    std::int64_t count = 0;
    std::string first_at;  // "FILE, byte OFFSET"
  };
  std::map<std::string, Undecodable> undecodable_by_channel;
  std::vector<std::string> files;          // that the log consists of
  std::vector<BadStretch> bad_stretches;   // bytes that are no event
  std::vector<LogFlows::OfChannel> flows;  // that lack messages or have several sessions
  std::int64_t packets_sent = 0;           // that a receipt came for
  std::int64_t packets_delivered = 0;      // RECEIVEs
  std::array<std::int64_t, kReceiptResults> receipts{};
  OutcomeCounts outcomes{};
  std::vector<double> travel_times_s;  // of the delivered that carry their departure, as they came

  // `place` as place_of gives it; called only when the event does not decode.
  void count(const LoggedEvent& event, const std::function<std::string()>& place);

 private:
  template <class Message>
  void count_message(const LoggedEvent& event, const Message& message);
  // Names of the packets that a receipt was counted for: a duplicate receipt is not another packet.
  std::set<std::tuple<std::string, std::int64_t, std::int64_t>> answered_;
};

// Counts a whole log, and what of it is damaged.
LogStatistics statistics_of(LogReader& log);

// Writes them for a person.
void print(std::ostream& out, const LogStatistics& statistics);

// As JSON, one object.
std::string to_json(const LogStatistics& statistics);

}  // namespace halocline::clients
