// SPDX-License-Identifier: BSD-3-Clause
// Scanner for the events of an LCM log, intact or damaged.
//
// Format (LCM's event log): each event consists of the sync word 0xEDA1DA01, number and stamp (64 bit each),
// lengths of the channel and of the data (32 bit each), all big-endian, then channel and data. There is no
// checksum, so changed bytes within the data of an event cannot be detected. What can be checked are the
// beginnings of events and the lengths in their headers. Rules:
//
// - A header is plausible if the number is not negative, the stamp lies within a century of 0, the channel
//   has 1 to 63 bytes and no control characters, and the event ends within the log.
// - A plausible event that is followed by another sync word, or by the end of the log, is intact. Exception:
//   if other events, whose numbers continue its own, fill its data exactly to the end, its length is corrupt
//   and it is damage.
// - A plausible event that is followed by anything else is intact, too, and the bytes after it are damage.
//   Exception: if a plausible header begins within its data, its length is corrupt, and the search continues
//   after its own sync word.
// - Bytes between intact events are damage. At the end of a log they are an event that was cut off if they
//   begin with (the beginning of) a sync word and no complete event follows.
//
// Every event that does not overlap damaged bytes is thus found, with one exception: a message that itself
// carries complete LCM events is taken for damage if the event after it is damaged, or if it carries the
// numbers that follow its own.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace halocline::clients {

using LogBytes = std::span<const std::uint8_t>;

// Place of an event; `channel` and `data` refer to the bytes of the log.
struct EventPlace {
  std::size_t offset = 0, size = 0;  // complete event, bytes
  std::int64_t number = 0, stamp_us = 0;
  std::string_view channel;
  LogBytes data;
};

// Bytes that belong to no event.
struct Damage {
  std::size_t offset = 0, size = 0;
  bool cut_short = false;  // the log ends within an event
};

// Next part of `log` at or after `from`: damage (of size 0 if none), then an event unless `at_end`.
struct LogStep {
  Damage damage;
  EventPlace event;
  bool at_end = false;
};
LogStep next_event(LogBytes log, std::size_t from);

// Returns false for bytes that hold no event and do not begin like one, that is for another kind of file. An
// empty file is an empty log.
bool looks_like_a_log(LogBytes log);
// Returns the reason, in words, why bytes do not look like a log.
std::string why_no_log(LogBytes bytes);

}  // namespace halocline::clients
