// SPDX-License-Identifier: BSD-3-Clause
// Series of values over time, for data that come many times a second: kept in order, thinned when there are
// too many, dropped when old.
//
// Thinning drops every second value, and from then on keeps new values only at twice the former distance in
// time. The newest value is always kept. Extremes between two kept values are lost: the price of bounded
// memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/sim_time.h"

namespace halocline::clients {

template <class Value>
struct Timed {
  SimTime at;
  Value value;
};

template <class Value>
class TimedSeries {
 public:
  using Entry = Timed<Value>;

  // Adds a value; it replaces a value of the same time, and the newest one if that is too close to its
  // predecessor. Returns true when the number of values has grown.
  bool add(SimTime at, Value value) {
    if (entries_.empty() || at > entries_.back().at) {
      const bool is_too_near = entries_.size() > 1 && entries_.back().at - (entries_.end() - 2)->at < gap_;
      if (!is_too_near) entries_.emplace_back();
      entries_.back() = {at, std::move(value)};
      return !is_too_near;
    }
    const auto place = entries_.begin() + index_from(at);
    const bool is_there = place->at == at;
    if (is_there)
      place->value = std::move(value);
    else
      entries_.insert(place, {at, std::move(value)});
    return !is_there;
  }

  // Returns the value at exactly this time; null when there is none.
  Value* find(SimTime at) {
    const auto place = entries_.begin() + index_from(at);
    return place != entries_.end() && place->at == at ? &place->value : nullptr;
  }
  // Returns the last entry at or before this time; null when there is none.
  const Entry* at_or_before(SimTime at) const {
    const std::span<const Entry> before = between(SimTime::at_once(), at);
    return before.empty() ? nullptr : &before.back();
  }
  std::span<const Entry> between(SimTime from, SimTime to) const {
    const auto first = index_from(from);
    const auto last = std::upper_bound(entries_.begin(), entries_.end(), to,
                                       [](SimTime t, const Entry& entry) { return t < entry.at; }) -
                      entries_.begin();
    return {entries_.data() + first, static_cast<std::size_t>(std::max(last - first, std::ptrdiff_t{0}))};
  }
  std::span<const Entry> all() const { return entries_; }
  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }
  const Entry& front() const { return entries_.front(); }
  const Entry& back() const { return entries_.back(); }

  // Drops every second entry, unless there are fewer than four. Returns the number of entries dropped.
  std::size_t thin() {
    if (entries_.size() < 4) return 0;
    const std::size_t size = entries_.size();
    const std::int64_t spacing_ns =
        (entries_.back().at - entries_.front().at).nanoseconds() / static_cast<std::int64_t>(size - 1);
    std::vector<Entry> kept;
    for (std::size_t i = 0; i < size; ++i) {
      if (i % 2 == 0 || i == size - 1) kept.push_back(std::move(entries_[i]));
    }
    entries_ = std::move(kept);
    // The new gap is a little less than twice the mean spacing: with the full double, jitter would make a
    // steady series keep only every third value.
    gap_ = std::max(gap_, SimDuration::from_nanoseconds(spacing_ns * 2 - spacing_ns / 4));
    return size - entries_.size();
  }
  // Drops old entries, except the last one before `at`, which still holds at `at`. Returns the number
  // dropped.
  std::size_t drop_before(SimTime at) {
    const std::ptrdiff_t first = std::max(index_from(at) - 1, std::ptrdiff_t{0});
    entries_.erase(entries_.begin(), entries_.begin() + first);
    return static_cast<std::size_t>(first);
  }

 private:
  std::ptrdiff_t index_from(SimTime at) const {
    return std::lower_bound(entries_.begin(), entries_.end(), at,
                            [](const Entry& entry, SimTime t) { return entry.at < t; }) -
           entries_.begin();
  }

  std::vector<Entry> entries_;  // sorted by time
  SimDuration gap_;             // least distance in time between two kept entries
};

// Returns at most `max_points` >= 8 of the entries for drawing, in order: the first and the last, and the
// minimum and maximum of each quantity within each of equally long intervals of time. A quantity is a
// function of the value, such as its depth.
template <class Value, class... Quantities>
std::vector<Timed<Value>> decimated(std::span<const Timed<Value>> entries, std::size_t max_points,
                                    const Quantities&... quantities) {
  if (entries.size() <= max_points) return {entries.begin(), entries.end()};
  const std::size_t bins = std::max<std::size_t>((max_points - 2) / (2 * sizeof...(quantities)), 1);
  const std::int64_t first_ns = entries.front().at.nanoseconds();
  const std::int64_t span_ns = entries.back().at.nanoseconds() - first_ns + 1;
  const auto bin_of = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<double>(entries[i].at.nanoseconds() - first_ns) /
                                    static_cast<double>(span_ns) * static_cast<double>(bins));
  };
  std::vector<std::size_t> kept{0, entries.size() - 1};
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    for (end = begin; end < entries.size() && bin_of(end) == bin_of(begin);) ++end;
    const auto keep_extremes = [&](const auto& quantity) {
      const auto less = [&](const Timed<Value>& a, const Timed<Value>& b) {
        return quantity(a.value) < quantity(b.value);
      };
      const auto [least, greatest] =
          std::minmax_element(entries.begin() + static_cast<std::ptrdiff_t>(begin),
                              entries.begin() + static_cast<std::ptrdiff_t>(end), less);
      kept.push_back(static_cast<std::size_t>(least - entries.begin()));
      kept.push_back(static_cast<std::size_t>(greatest - entries.begin()));
    };
    (keep_extremes(quantities), ...);
  }
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  std::vector<Timed<Value>> chosen;
  for (const std::size_t i : kept) chosen.push_back(entries[i]);
  return chosen;
}

}  // namespace halocline::clients
