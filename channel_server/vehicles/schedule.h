// A value over time, told in pieces: each holds from an instant on, until the next.
//
// With set() it is a function of what was told, whatever the order. Bounded: beyond `most` the earliest make room. Not thread-safe.
#pragma once

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

  // `value` holds from `from` on.
  void set(SimTime from, const Value& value) {
    pieces_.insert_or_assign(from, value);
    if (pieces_.size() > most_) pieces_.erase(pieces_.begin());
  }
  // The same; a repetition of what holds already changes nothing.
  void announce(SimTime from, const Value& value) {
    if (at(from) != value) set(from, value);
  }
  const Value& at(SimTime instant) const {
    const auto later = pieces_.upper_bound(instant);
    return later == pieces_.begin() ? before_ : std::prev(later)->second;
  }
  // Calls visit(value, first instant within the interval) for each that holds at some instant of [from, to].
  template <class Visit>
  void visit_during(SimTime from, SimTime to, Visit&& visit) const {
    visit(at(from), from);
    for (auto next = pieces_.upper_bound(from); next != pieces_.end() && next->first <= to; ++next) {
      visit(next->second, next->first);
    }
  }
  // Drops what no instant from `time` on needs.
  void forget_before(SimTime time) {
    while (pieces_.size() > 1 && std::next(pieces_.begin())->first < time) pieces_.erase(pieces_.begin());
  }
  void clear() { pieces_.clear(); }

 private:
  Value before_;
  std::size_t most_;
  std::map<SimTime, Value> pieces_;
};

}  // namespace halocline::channel_server
