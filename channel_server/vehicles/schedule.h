// SPDX-License-Identifier: BSD-3-Clause
// Piecewise constant value over time: each piece holds from an instant until the next piece.
//
// The value is a function of the pieces set, whatever their order: at every instant, the piece set for the
// latest instant not after it holds. A piece that repeats the value before it is kept, because another piece
// may still be set between the two. Storage is bounded: beyond `most` pieces the earliest repetition is
// dropped, and without repetitions the earliest piece. Not thread-safe.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <utility>

#include "core/sim_time.h"

namespace halocline::channel_server {

template <class Value>
class Schedule {
 public:
  // `before` holds before the first piece.
  explicit Schedule(Value before, std::size_t most = 64) : before_(std::move(before)), most_(most) {}

  void set(SimTime from, const Value& value) {
    pieces_.insert_or_assign(from, value);
    if (pieces_.size() > most_) make_room();
  }
  const Value& at(SimTime instant) const {
    const auto later = pieces_.upper_bound(instant);
    return later == pieces_.begin() ? before_ : std::prev(later)->second;
  }
  // Calls visit(value, first instant within the interval) for each value that holds at some instant of [from,
  // to].
  template <class Visit>
  void visit_during(SimTime from, SimTime to, Visit&& visit) const {
    const Value* last = &at(from);
    visit(*last, from);
    for (auto next = pieces_.upper_bound(from); next != pieces_.end() && next->first <= to; ++next) {
      if (next->second == *last) continue;
      last = &next->second;
      visit(*last, next->first);
    }
  }
  // Drops pieces that no instant from `time` on needs.
  void forget_before(SimTime time) {
    while (pieces_.size() > 1 && std::next(pieces_.begin())->first < time) pieces_.erase(pieces_.begin());
  }

 private:
  void make_room() {
    const auto repeats = [](const auto& a, const auto& b) { return a.second == b.second; };
    const auto first = std::adjacent_find(pieces_.begin(), pieces_.end(), repeats);
    pieces_.erase(first == pieces_.end() ? pieces_.begin() : std::next(first));
  }

  Value before_;
  std::size_t most_;
  std::map<SimTime, Value> pieces_;
};

}  // namespace halocline::channel_server
