// SPDX-License-Identifier: BSD-3-Clause
// The flights of a medium, in the order of their next events: by instant, then by stage, receiver and packet.
//
// A binary heap of small entries, most of which are compared without a look at the flights. Flights stay
// where they are made; one that has ended serves the next packet, so there are as many as ever were under way
// at a time.
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
  // Of the first flight, only while not empty.
  SimTime next_event() const { return entries_.front().at; }
  // Removes it: to be added again, or to be ended.
  Flight& take_first();

  // Of a packet (`identity`: identity_for_draws) to a receiver; to be added.
  Flight& make_flight(PacketPointer packet, std::uint64_t identity, VehicleId receiver_id,
                      std::string receiver);
  // Its next event is at `at`, in the stage that it has. No other flight may be of the same packet to the
  // same receiver.
  void add(SimTime at, Flight& flight);
  void end(Flight& flight);
  void clear();
  // Calls visit(instant of the next event, flight) for each, in no order.
  template <class Visit>
  void visit(Visit&& visit) const {
    for (const Entry& entry : entries_) visit(entry.at, *entry.flight);
  }
  // The flights of one stage whose next event is at `time` or before, in no order.
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
