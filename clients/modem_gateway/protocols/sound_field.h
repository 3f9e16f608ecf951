// SPDX-License-Identifier: BSD-3-Clause
// The sound in the water as samples: what doors of waveforms emit and record.
//
// Whoever has the water of the scenario gives it (GatewayNode): the door of a waveform has no packets, and
// its sound is none to modems.
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

  // A sound of a vehicle: its first sample leaves at `begin`. A sine of amplitude 1 has the source level of
  // the vehicle's modem.
  virtual void emit(std::int32_t vehicle_id, SimTime begin, double rate_hz,
                    std::span<const float> samples) = 0;
  // Of what it emits all from that instant on is cut off.
  virtual void silence(std::int32_t vehicle_id, SimTime from) = 0;

  // How long after an instant its sound is known everywhere.
  virtual SimDuration lag() const = 0;
  // The pressure at a vehicle, uPa, without its own sounds, at the instants n / rate_hz of simulation time, n
  // = first, first + 1, ...; the last must be `lag` ago. Of one vehicle in the order of time.
  virtual std::vector<double> record(std::int32_t vehicle_id, double rate_hz, std::int64_t first,
                                     std::size_t count) = 0;
};

// On the bus of the node whose doors it is for, which outlives it.
using SoundFieldMaker = std::function<std::unique_ptr<SoundField>(bus::Bus& bus)>;

}  // namespace halocline::modem_gateway
