// SPDX-License-Identifier: BSD-3-Clause
// Events of a log that cannot be read as what their channels say, and accepted packets without outcomes
// (packet_account.h).
//
// On a channel of ours an event of another fingerprint is of another version; one that does not decode, or
// holds what its type does not allow, is invalid, unless that is what vehicles of others leave out
// (foreign_message.h). A channel of one of our families whose vehicle is no name (core/names.h) is misnamed.
// Events on all other channels are other programs' and no fault, unless there are no others.
//
// Clocks. Stamps and times are microseconds. Where, from the first to the last event of a channel, stamps run
// a thousand times as fast as the times in the messages, and are a thousand times as great, they are
// nanoseconds; the other way round the times are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "bus/logs/packet_account.h"
#include "core/hash.h"

namespace halocline::clients {

class LogContents {
 public:
  struct Event {
    std::int64_t stamp_us = 0;
    std::string_view channel;
    std::span<const std::uint8_t> data;
    std::size_t file = 0;  // of the log
    std::int64_t offset = 0;
  };
  // The events of the log in its order.
  void count(const Event& event);

  // What is wrong, each a sentence without its full stop; empty for a log that is read whole. `files`: of the
  // log.
  std::vector<std::string> problems(const std::vector<std::string>& files) const;
  PacketAccount::Missing missing() const { return packets_.missing(); }

 private:
  struct Channel {
    using Read = void (LogContents::*)(Channel& channel, const Event& event);
    Read read = nullptr;  // null: none of ours
    bool is_misnamed = false;
    std::int64_t events = 0, other_version = 0, invalid = 0, timed = 0;
    std::string first_problem;  // of the invalid
    std::size_t first_file = 0;
    std::int64_t first_offset = 0;
    std::int64_t first_stamp_us = 0, last_stamp_us = 0, first_utime = 0, last_utime = 0;  // of the timed
  };
  using Counted = std::pair<std::string, std::int64_t>;  // a channel's events

  Channel& channel_of(std::string_view name);
  template <class Message>
  void read(Channel& channel, const Event& event);
  static void note_invalid(Channel& channel, const Event& event, const std::string& problem);
  static void note_time(Channel& channel, std::int64_t stamp_us, std::int64_t utime);
  std::vector<Counted> channels(const std::function<std::int64_t(const Channel&)>& count) const;
  void add_unread(std::vector<std::string>& problems) const;
  void add_invalid(const std::vector<std::string>& files, std::vector<std::string>& problems) const;
  void add_clocks(std::vector<std::string>& problems) const;
  void add_channels(std::vector<std::string>& problems) const;

  std::unordered_map<std::string, Channel, TextHash, std::equal_to<>> channels_;
  PacketAccount packets_;
};

}  // namespace halocline::clients
