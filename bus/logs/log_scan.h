// SPDX-License-Identifier: BSD-3-Clause
// Finds the events of an LCM log in its bytes, sound or damaged.
//
// Format (LCM's event log): per event the word 0xEDA1DA01, then number and stamp (64 bit), length of the
// channel and of the data (32 bit), all big-endian, then channel and data. There is no checksum: bytes that
// changed within the data of an event do not show here. What shows is where events begin, and the lengths in
// their headers. Rules:
//
// - A header is plausible when the number is not negative, the stamp lies within a century of 0, the channel
//   has 1 to 63 bytes, no control characters, and the event ends within the log.
// - An event that is followed by another word, or by the end of the log, is sound; but when other events with
//   the numbers that follow fill its data exactly to the end, its length is corrupt and it is damage.
// - One that is followed by anything else is sound, too, unless a plausible header begins within its data:
//   then its length is corrupt, and the search continues behind its own word. Else what follows it is the
//   damage.
// - What lies between sound events is damage. At the end of a log it is an event that was cut short when it
//   begins with (the beginning of) a word and no whole event follows.
//
// So every event that does not overlap damaged bytes is found. Left out: a message that itself carries whole
// LCM events is taken for damage when the event after it is damaged, or when it carries the numbers that
// follow its own.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace halocline::clients {

using LogBytes = std::span<const std::uint8_t>;

// Where an event stands; `channel` and `data` look into the bytes of the log.
struct EventPlace {
  std::size_t offset = 0, size = 0;  // of the whole event, bytes
  std::int64_t number = 0, stamp_us = 0;
  std::string_view channel;
  LogBytes data;
};

// Bytes that belong to no event.
struct Damage {
  std::size_t offset = 0, size = 0;
  bool cut_short = false;  // the log ends within an event
};

// What comes next in `log` at or after `from`: damage (of size 0 when none), then an event unless `at_end`.
struct LogStep {
  Damage damage;
  EventPlace event;
  bool at_end = false;
};
LogStep next_event(LogBytes log, std::size_t from);

// False for bytes that hold no event and do not begin like one: some other file. Nothing at all is an empty
// log.
bool looks_like_a_log(LogBytes log);
// In words, of bytes that do not.
std::string why_no_log(LogBytes bytes);

}  // namespace halocline::clients
