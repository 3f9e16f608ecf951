// SPDX-License-Identifier: BSD-3-Clause
// Sound in the water as samples, for modem interfaces that exchange waveforms instead of packets.
//
// The owner of the scenario's water provides it (GatewayNode). Such an interface sends and receives no
// packets, and modems do not receive its sound.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "bus/bus.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

class SoundField {
 public:
  virtual ~SoundField() = default;

  // Emits a sound of a vehicle, whose first sample leaves at `begin`. A sine of amplitude 1 has the source
  // level of the vehicle's modem.
  virtual void emit(std::int32_t vehicle_id, SimTime begin, double rate_hz,
                    std::span<const float> samples) = 0;
  // Cuts off everything that the vehicle emits from that time on.
  virtual void silence(std::int32_t vehicle_id, SimTime from) = 0;

  // Returns the delay after which the sound of a given time is known everywhere.
  virtual SimDuration lag() const = 0;
  // Returns the pressure at a vehicle, uPa, without its own sounds, at the simulation times n / rate_hz, n =
  // first, first + 1, ... The last one must be `lag` in the past. Calls for one vehicle must be in the order
  // of time.
  virtual std::vector<double> record(std::int32_t vehicle_id, double rate_hz, std::int64_t first,
                                     std::size_t count) = 0;
};

// Makes the sound field on the bus of the node whose modem interfaces use it; the bus outlives it.
using SoundFieldMaker = std::function<std::unique_ptr<SoundField>(bus::Bus& bus)>;

}  // namespace halocline::modem_gateway
