// SPDX-License-Identifier: BSD-3-Clause
// The noise at receivers as link tables and link queries state it: ambient noise, noise of the receiver's own
// vehicle, and the mean over fading of the noise that other vehicles radiate. The packet medium has the same
// noise, but with the fading of each instant (channel_server/packets/platform_noise.h).
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

// The interface to a model of the noise at receivers.
class ReceiverNoise {
 public:
  virtual ~ReceiverNoise() = default;

  // True when the noise may differ from the ambient noise of the environment.
  virtual bool differ() const = 0;
  // False when is_ready() holds for every link, so that none need be asked.
  virtual bool may_wait() const { return differ(); }
  // Returns by how much the noise exceeds the ambient noise over the transmitter's band, dB, for a link whose
  // sound leaves at `at`. `silent` is a vehicle whose noise is left out; 0 for none.
  virtual Decibels above_ambient(const EndPair& link, SimTime at, VehicleId silent) = 0;
  // True when the propagation knows all that above_ambient() needs; as Propagation::is_ready, it requests
  // what is missing.
  virtual bool is_ready(const EndPair& link, SimTime at, VehicleId silent) = 0;
};

// The noise at the receivers of links whose sound leaves at one instant. Each pair of receiver and band is
// computed once. Not thread-safe.
class NoiseOfLinks {
 public:
  // `model` must outlive this object.
  NoiseOfLinks(ReceiverNoise& model, SimTime at, VehicleId silent = 0)
      : model_(model), at_(at), silent_(silent) {}

  // True when ReceiverNoise::is_ready holds for all links; everything missing is requested at once.
  bool are_ready(const std::vector<EndPair>& links);
  // Sets LinkEnd::above_ambient of the link's receiver.
  void set(EndPair& link);

 private:
  using Key = std::pair<VehicleId, std::array<double, 5>>;  // receiver id; position, m, and band, Hz
  static Key key_of(const EndPair& link);

  ReceiverNoise& model_;
  SimTime at_;
  VehicleId silent_;
  std::map<Key, Decibels> found_;
};

}  // namespace halocline::channel_server
