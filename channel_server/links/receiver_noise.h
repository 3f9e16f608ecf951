// SPDX-License-Identifier: BSD-3-Clause
// The noise that receivers hear, as link tables and link queries state it: ambient, that of the receiver's
// own vehicle, and the mean over fading of what other vehicles radiate. The packet medium has the same, but
// with the fading of each instant (channel_server/packets/vehicle_sounds.h).
#pragma once

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {

class ReceiverNoise {
 public:
  virtual ~ReceiverNoise() = default;

  // Whether it may be another than the ambient one of the environment.
  virtual bool differ() const = 0;
  // By how much it exceeds that over the transmitter's band, dB, where a link's sound leaves at `at`.
  // `silent`: a vehicle whose noise is left out; 0: none.
  virtual Decibels above_ambient(const EndPair& link, SimTime at, VehicleId silent) = 0;
  // Whether the propagation knows all that above_ambient() needs, as Propagation::is_ready.
  virtual bool is_ready(const EndPair& link, SimTime at, VehicleId silent) = 0;
};

// At the receivers of links whose sound leaves at one instant; each receiver and band is computed once. Not
// thread-safe.
class NoiseOfLinks {
 public:
  // `model` outlives it.
  NoiseOfLinks(ReceiverNoise& model, SimTime at, VehicleId silent = 0)
      : model_(model), at_(at), silent_(silent) {}

  // As ReceiverNoise::is_ready for all of them; what is not known is requested at once.
  bool are_ready(const std::vector<EndPair>& links);
  // Sets LinkEnd::above_ambient of the receiver.
  void set(EndPair& link);

 private:
  using Key = std::pair<VehicleId, std::array<double, 5>>;  // place and band
  static Key key_of(const EndPair& link);

  ReceiverNoise& model_;
  SimTime at_;
  VehicleId silent_;
  std::map<Key, Decibels> found_;
};

}  // namespace halocline::channel_server
