// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/packets/flight_queue.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/check.h"

namespace halocline::channel_server {

bool FlightQueue::IsLater::operator()(const Entry& a, const Entry& b) const {
  if (a.at != b.at) return a.at > b.at;
  if (a.order != b.order) return a.order > b.order;
  return a.flight->packet->name() > b.flight->packet->name();
}

void FlightQueue::add(SimTime at, Flight& flight) {
  const std::int64_t order = (std::int64_t{static_cast<int>(flight.stage)} << 32) + flight.receiver_id;
  entries_.push_back({at, order, &flight});
  std::push_heap(entries_.begin(), entries_.end(), IsLater());
}

Flight& FlightQueue::take_first() {
  std::pop_heap(entries_.begin(), entries_.end(), IsLater());
  const Entry first = entries_.back();
  entries_.pop_back();
  ensure(entries_.empty() || IsLater()(entries_.front(), first), "two flights of one packet to one receiver");
  return *first.flight;
}

Flight& FlightQueue::make_flight(PacketPointer packet, std::uint64_t identity, VehicleId receiver_id,
                                 std::string receiver) {
  if (ended_.empty()) ended_.push_back(&flights_.emplace_back());
  Flight& flight = *ended_.back();
  ended_.pop_back();
  flight.packet = std::move(packet);
  flight.identity = identity;
  flight.receiver_id = receiver_id;
  flight.receiver = std::move(receiver);
  return flight;
}

std::vector<Flight*> FlightQueue::due_by(SimTime time, Flight::Stage stage) const {
  std::vector<Flight*> due;
  for (const Entry& entry : entries_)
    if (entry.at <= time && entry.flight->stage == stage) due.push_back(entry.flight);
  return due;
}

void FlightQueue::end(Flight& flight) {
  std::destroy_at(&flight);
  ended_.push_back(std::construct_at(&flight));
}

}  // namespace halocline::channel_server
