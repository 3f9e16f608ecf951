// SPDX-License-Identifier: BSD-3-Clause
// Checks the contents of a log: finds events that cannot be read as the type of their channel, and accepted
// packets without outcomes (packet_account.h).
//
// On a channel of Halocline, an event with another fingerprint belongs to another version. An event that does
// not decode, or has values that its type does not permit, is invalid, except for the fields that third-party
// vehicles may leave out (foreign_message.h). A channel of a Halocline family whose vehicle name is invalid
// (core/names.h) is misnamed. Events on all other channels belong to other programs and are no fault, unless
// the log holds nothing else.
//
// Stamps and times are in microseconds. If, from the first to the last event of a channel, the stamps run a
// thousand times as fast as the times in the messages, and are a thousand times as large, the stamps are in
// nanoseconds; in the opposite case the times are.
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
    std::size_t file = 0;  // index in the files of the log
    std::int64_t offset = 0;
  };
  // Counts an event; call it for the events of the log in order.
  void count(const Event& event);

  // Returns the faults, each a sentence without its full stop; empty for a log that can be read completely.
  // `files`: names of the files of the log.
  std::vector<std::string> problems(const std::vector<std::string>& files) const;
  PacketAccount::Missing missing() const { return packets_.missing(); }

 private:
  struct Channel {
    using Read = void (LogContents::*)(Channel& channel, const Event& event);
    Read read = nullptr;  // null: not a channel of Halocline
    bool is_misnamed = false;
    std::int64_t events = 0, other_version = 0, invalid = 0, timed = 0;
    std::string first_problem;  // description of the first invalid event
    std::size_t first_file = 0;
    std::int64_t first_offset = 0;
    // First and last of the timed events.
    std::int64_t first_stamp_us = 0, last_stamp_us = 0, first_utime = 0, last_utime = 0;
  };
  using Counted = std::pair<std::string, std::int64_t>;  // channel and number of events

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
