// SPDX-License-Identifier: BSD-3-Clause
// What a log lacks, by the (session, sequence) of its messages: each publisher numbers its messages on a
// channel 0, 1, 2, ...
//
// A number between two that are there, and not there itself, is missing. What a publisher sent before the
// first and after the last is not known. A flow whose numbers and stamps go back begins anew: the log holds
// two runs of the same sessions.
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
  // An event of the log, in its order; on REPAIR.<channel> it fills a gap. What is no message of a flow is
  // ignored.
  void count(std::string_view channel, std::span<const std::uint8_t> data);

  struct OfChannel {
    std::string channel;
    std::int64_t messages = 0, missing = 0;  // `missing` saturates
    std::size_t sessions = 0;                // where a channel has one publisher at a time; otherwise 1
  };
  // The channels of which messages are missing, or that have several sessions, by name.
  std::vector<OfChannel> remarkable() const;
  std::int64_t missing() const;
  bool begins_anew() const { return begins_anew_; }

 private:
  struct Flow {
    std::int64_t first = 0, last = 0, last_utime = 0;
    std::set<std::int64_t> missing;  // the latest kMostMissing
    std::int64_t given_up = 0;       // missing, and forgotten
    void take(std::int64_t sequence);
    void note_missing(std::int64_t from, std::int64_t end);
  };
  struct Channel {
    bus::FlowType type;
    std::int64_t messages = 0;
    std::map<std::int64_t, Flow> flows = {};  // by session
  };
  static std::int64_t missing_of(const Channel& channel);
  Channel& channel_of(std::string_view name);

  std::unordered_map<std::string, Channel, TextHash, std::equal_to<>> channels_;
  bool begins_anew_ = false;
};

// A line about what is missing, and one about the channels with several sessions; none for a whole log of one
// run.
void report_flows(std::ostream& out, const LogFlows& flows);

}  // namespace halocline::clients
