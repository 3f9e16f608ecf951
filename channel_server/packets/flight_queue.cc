#include "channel_server/packets/flight_queue.h"

#include <algorithm>
#include <compare>
#include <tuple>
#include <utility>

#include "channel_server/packets/packet.h"
#include "core/check.h"

namespace halocline::channel_server {
namespace {

constexpr std::size_t kMostKept = 1024;  // flights that have ended: a megabyte

}  // namespace

bool FlightQueue::is_later(const Entry& a, const Entry& b) {
  const auto order = std::tie(a.at, a.stage, a.receiver_id) <=> std::tie(b.at, b.stage, b.receiver_id);
  return order != 0 ? order > 0 : a.flight->packet->name() > b.flight->packet->name();
}

void FlightQueue::add(SimTime at, FlightPointer flight) {
  const Flight& added = *flight;
  entries_.push_back({at, added.stage, added.receiver_id, std::move(flight)});
  std::push_heap(entries_.begin(), entries_.end(), is_later);
}

FlightPointer FlightQueue::take_first() {
  std::pop_heap(entries_.begin(), entries_.end(), is_later);
  Entry first = std::move(entries_.back());
  entries_.pop_back();
  ensure(entries_.empty() || is_later(entries_.front(), first), "two flights of one packet to one receiver");
  return std::move(first.flight);
}

FlightPointer FlightQueue::make_flight() {
  if (ended_.empty()) return std::make_unique<Flight>();
  FlightPointer flight = std::move(ended_.back());
  ended_.pop_back();
  return flight;
}

void FlightQueue::reuse(FlightPointer ended) {
  if (ended_.size() == kMostKept) return;
  *ended = Flight();
  ended_.push_back(std::move(ended));
}

void FlightQueue::clear() {
  entries_.clear();
  ended_.clear();
}

}  // namespace halocline::channel_server
