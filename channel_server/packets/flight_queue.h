// The flights of a medium, in the order of their next events: by instant, then by stage, receiver and packet.
//
// A binary heap of small entries: which of them come first is decided in most cases without a look at the flights. A flight
// that has ended is kept for the next packet, so that its memory is not asked for again.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "channel_server/packets/flight.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

using FlightPointer = std::unique_ptr<Flight>;

class FlightQueue {
 public:
  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }
  // Of the first, only while not empty.
  SimTime next_event() const { return entries_.front().at; }
  const Flight& first() const { return *entries_.front().flight; }
  FlightPointer take_first();

  // Its next event is at `at`, in the stage that it has. No other flight may be the same packet's to the same receiver.
  void add(SimTime at, FlightPointer flight);

  // As made by default.
  FlightPointer make_flight();
  void reuse(FlightPointer ended);
  void clear();

 private:
  struct Entry {
    SimTime at;
    Flight::Stage stage;
    VehicleId receiver_id;
    FlightPointer flight;
  };
  static bool is_later(const Entry& a, const Entry& b);

  std::vector<Entry> entries_;  // a heap, the earliest first
  std::vector<FlightPointer> ended_;
};

}  // namespace halocline::channel_server
