// SPDX-License-Identifier: BSD-3-Clause
// Finds the messages that a log lacks, from (session, sequence): each publisher numbers its messages on a
// channel 0, 1, 2, ...
//
// A number between two recorded ones that was not recorded itself is missing. Messages that a publisher sent
// before the first and after the last recorded one are unknown. A flow whose numbers and time stamps go back
// starts again: the log holds two runs with the same sessions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "bus/logs/flow_head.h"
#include "core/hash.h"

namespace halocline::clients {

class LogFlows {
 public:
  // Counts an event; call it for the events of the log in order. An event on REPAIR.<channel> fills a gap; a
  // message that belongs to no flow is ignored.
  void count(std::string_view channel, std::span<const std::uint8_t> data);

  struct OfChannel {
    std::string channel;
    std::int64_t messages = 0, missing = 0;  // `missing` saturates
    std::size_t sessions = 0;                // counted if a channel has one publisher at a time; otherwise 1
  };
  // Returns the channels that lack messages or have several sessions, by name.
  std::vector<OfChannel> remarkable() const;
  std::int64_t missing() const;
  bool begins_anew() const { return begins_anew_; }

 private:
  struct Flow {
    std::int64_t first = 0, last = 0, last_utime = 0;
    std::set<std::int64_t> missing;  // the latest kMaxMissingOfFlow
    std::int64_t expired = 0;        // number of older missing messages
    void take(std::int64_t sequence);
    void note_missing(std::int64_t from, std::int64_t end);
  };
  struct Channel {
    bus::FlowType type;
    std::int64_t messages = 0;
    std::map<std::int64_t, Flow> flows = {};  // keyed by session
  };
  static std::int64_t missing_of(const Channel& channel);
  Channel& channel_of(std::string_view name);

  std::unordered_map<std::string, Channel, TextHash, std::equal_to<>> channels_;
  bool begins_anew_ = false;
};

// Writes a line about missing messages, and one about the channels with several sessions; none for a complete
// log of one run.
void report_flows(std::ostream& out, const LogFlows& flows);

}  // namespace halocline::clients
