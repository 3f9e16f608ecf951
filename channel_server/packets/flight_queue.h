// SPDX-License-Identifier: BSD-3-Clause
// A queue of the flights of a medium, in the order of their next events: by instant, then stage, receiver and
// packet.
//
// It is a binary heap of small entries, which are mostly compared without access to the flights. Flights stay
// at their place in memory, and an ended flight is reused for the next packet, so memory holds only as many
// flights as were ever under way at one time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "channel_server/packets/flight.h"
#include "channel_server/packets/packet.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class FlightQueue {
 public:
  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }
  // Returns the instant of the first flight's next event; requires a queue that is not empty.
  SimTime next_event() const { return entries_.front().at; }
  // Removes and returns the first flight; the caller adds it again or ends it.
  Flight& take_first();

  // Makes a flight of a packet to a receiver, not yet in the queue. `identity` is identity_for_draws() of the
  // packet.
  Flight& make_flight(PacketPointer packet, std::uint64_t identity, VehicleId receiver_id,
                      std::string receiver);
  // Adds a flight whose next event, in its present stage, is at `at`. No other flight may be of the same
  // packet to the same receiver.
  void add(SimTime at, Flight& flight);
  // Ends a flight that is not in the queue; its memory serves a later one.
  void end(Flight& flight);
  // Calls visit(instant of the next event, flight) for each flight, in no particular order.
  template <class Visit>
  void visit(Visit&& visit) const {
    for (const Entry& entry : entries_) visit(entry.at, *entry.flight);
  }
  // Returns the flights in one stage whose next event is at `time` or before, in no particular order.
  std::vector<Flight*> due_by(SimTime time, Flight::Stage stage) const;

 private:
  struct Entry {
    SimTime at;
    std::int64_t order;  // stage, then receiver
    Flight* flight;
  };
  struct IsLater {
    bool operator()(const Entry& a, const Entry& b) const;
  };

  std::vector<Entry> entries_;  // a heap, the earliest first
  std::deque<Flight> flights_;
  std::vector<Flight*> ended_;
};

}  // namespace halocline::channel_server
