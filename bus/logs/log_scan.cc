// SPDX-License-Identifier: BSD-3-Clause
#include "bus/logs/log_scan.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

#include "core/names.h"

namespace halocline::clients {
namespace {

constexpr std::array<std::uint8_t, 4> kWord{0xED, 0xA1, 0xDA, 0x01};
constexpr std::size_t kWordBytes = kWord.size(), kHeaderBytes = kWordBytes + 24;
constexpr std::size_t kLongestChannel = 63;  // limit of LCM
// A century: sums of times within it cannot overflow.
constexpr std::int64_t kLastStamp_us = 3'155'760'000'000'000;

std::uint64_t big_endian(LogBytes bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | bytes[at + i];
  return value;
}

bool word_at(LogBytes log, std::size_t at) {
  return at + kWordBytes <= log.size() &&
         std::equal(kWord.begin(), kWord.end(), log.begin() + static_cast<std::ptrdiff_t>(at));
}

// Returns the position of the next sync word that begins in [from, end); `end` if there is none.
std::size_t find_word(LogBytes log, std::size_t from, std::size_t end) {
  const std::size_t stop = std::min(log.size(), end + kWordBytes - 1);
  while (from + kWordBytes <= stop) {
    const void* found = std::memchr(log.data() + from, kWord[0], stop - from - (kWordBytes - 1));
    if (found == nullptr) return end;
    from = static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - log.data());
    if (word_at(log, from)) return from;
    ++from;
  }
  return end;
}

// Returns the event whose sync word is at `at`, if its header is plausible.
std::optional<EventPlace> plausible_at(LogBytes log, std::size_t at,
                                       std::int64_t last_stamp = kLastStamp_us) {
  if (!word_at(log, at) || log.size() - at < kHeaderBytes) return std::nullopt;
  EventPlace event;
  event.offset = at;
  event.number = static_cast<std::int64_t>(big_endian(log, at + 4, 8));
  event.stamp_us = static_cast<std::int64_t>(big_endian(log, at + 12, 8));
  const std::size_t channel_size = big_endian(log, at + 20, 4), data_size = big_endian(log, at + 24, 4);
  if (channel_size == 0 || channel_size > kLongestChannel) return std::nullopt;
  if (event.number < 0 || event.stamp_us < -last_stamp || event.stamp_us > last_stamp) return std::nullopt;
  event.size = kHeaderBytes + channel_size + data_size;
  if (log.size() - at < event.size) return std::nullopt;
  const std::size_t channel_at = at + kHeaderBytes;
  event.channel = {reinterpret_cast<const char*>(log.data()) + channel_at, channel_size};
  event.data = log.subspan(channel_at + channel_size, data_size);
  return is_one_line(event.channel) ? std::optional(event) : std::nullopt;
}

// Returns the first plausible event that begins within the data of `outer`, or in its last bytes.
std::optional<EventPlace> first_within(LogBytes log, const EventPlace& outer) {
  const std::size_t end = outer.offset + outer.size;
  for (std::size_t at = find_word(log, outer.offset + kWordBytes, end); at < end;
       at = find_word(log, at + 1, end)) {
    if (const auto event = plausible_at(log, at)) return event;
  }
  return std::nullopt;
}

// True if events from `first` on, each directly after the previous one, end exactly at `end`.
bool fill_exactly(LogBytes log, const EventPlace& first, std::size_t end) {
  std::size_t at = first.offset;
  while (at < end) {
    const auto event = plausible_at(log, at);
    if (!event) return false;
    at += event->size;
  }
  return at == end;
}

bool is_sound(LogBytes log, const EventPlace& event) {
  const auto inner = first_within(log, event);
  if (!inner) return true;
  const std::size_t end = event.offset + event.size;
  const bool followed = end == log.size() || word_at(log, end);
  return followed && !(inner->number - 1 == event.number && fill_exactly(log, *inner, end));
}

// True if the last bytes of a log are the beginning of an event.
bool begins_like_an_event(LogBytes rest) {
  const std::size_t size = std::min(rest.size(), kWordBytes);
  return size > 0 &&
         std::equal(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(size), kWord.begin());
}

}  // namespace

LogStep next_event(LogBytes log, std::size_t from) {
  LogStep step;
  step.damage.offset = from;
  for (std::size_t at = find_word(log, from, log.size()); at < log.size();
       at = find_word(log, at + 1, log.size())) {
    const auto event = plausible_at(log, at);
    if (!event || !is_sound(log, *event)) continue;
    step.event = *event;
    step.damage.size = at - from;
    return step;
  }
  step.at_end = true;
  step.damage.size = log.size() - from;
  step.damage.cut_short = begins_like_an_event(log.subspan(from));
  return step;
}

std::string why_no_log(LogBytes bytes) {
  constexpr std::array<std::uint8_t, 2> kGzip{0x1F, 0x8B};
  if (bytes.size() >= 2 && std::equal(kGzip.begin(), kGzip.end(), bytes.begin()))
    return "it is compressed by gzip; gunzip unpacks it";
  std::int64_t events = 0, first_stamp = 0;
  for (std::size_t at = find_word(bytes, 0, bytes.size()); at < bytes.size();) {
    const auto event = plausible_at(bytes, at, INT64_MAX);
    if (event && events++ == 0) first_stamp = event->stamp_us;
    at = find_word(bytes, at + (event ? event->size : 1), bytes.size());
  }
  if (events == 0) return "none of its bytes are an event";
  return "its " + std::to_string(events) + " events are stamped more than a century from 0, the first with " +
         std::to_string(first_stamp) + "; allowed are microseconds (these may be nanoseconds)";
}

bool looks_like_a_log(LogBytes log) {
  return log.empty() || begins_like_an_event(log) || !next_event(log, 0).at_end;
}

}  // namespace halocline::clients
