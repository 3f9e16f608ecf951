// SPDX-License-Identifier: BSD-3-Clause
// Noise radiated by vehicles, and its level at an instant.
//
// Model. The spectrum at 1 m is given at a reference speed v_ref; at another speed v the level changes by
//
//   60 log10(v / v_ref) dB
//
// because broadband noise of propellers and flow grows with the fifth to sixth power of speed (Urick 1983,
// chapter 11). v is the greatest turn rate of propeller and thrusters, or the speed over ground, or the level
// is constant: a ship at her speed, a jammer. A vehicle that stands still is silent. At the vehicle's own
// hydrophone the level is own_loss below that at 1 m.
//
// Turn rates come from SENSORS messages. The rate at t, as decided at d, is the latest with an instant at or
// before both t and d - lag, with the lag of states (state_history.h); before the first it is 0. So it does
// not depend on which message was faster. Speeds come from the states. Not thread-safe.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "acoustics/noise/noise_spectrum.h"
#include "channel_server/vehicles/schedule.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {

enum class NoiseDriver {
  kPropeller,  // turn rate of propeller and thrusters
  kSpeed,      // speed over ground
  kNone,       // constant level
};

// Noise of one vehicle, which is given by its name and id.
struct NoiseSource {
  std::string vehicle;
  VehicleId id = 0;
  // Spectrum at the reference speed, dB re 1 uPa^2/Hz. Our choice for a small vehicle: it falls by 20 dB a
  // decade, as machinery and cavitation noise does above 1 kHz (Urick 1983, chapter 10).
  acoustics::NoiseSpectrum at_1m{{1e3, 1e5}, {100, 60}};
  NoiseDriver driver = NoiseDriver::kPropeller;
  double reference = 25;           // turns per second (1500 rpm, our choice), or m/s; above 0
  Decibels own_loss{20};           // from 1 m to its own hydrophone, 0..200
  bool is_heard_by_others = true;  // false: at its own hydrophone alone
};

class VehicleNoise {
 public:
  static constexpr std::size_t kMaxRates = 16'384;  // limit for one vehicle; beyond it the oldest are dropped

  VehicleNoise() = default;  // no vehicle radiates noise
  VehicleNoise(std::vector<NoiseSource> sources, SimDuration lag);

  // True when some vehicle is heard by others.
  bool are_heard() const { return are_heard_; }
  const std::map<VehicleId, NoiseSource>& sources() const { return sources_; }
  // Adds the turn rate of the vehicle's fastest propeller at `at`, turns per second. No effect for a vehicle
  // that radiates no noise.
  void add_rate(std::string_view vehicle, SimTime at, double turns_per_s);
  double rate_at(VehicleId id, SimTime at, SimTime decided_at) const;

  void forget_before(SimTime time);

 private:
  std::map<VehicleId, NoiseSource> sources_;
  std::map<std::string, VehicleId, std::less<>> ids_;  // ids of the sources by name
  std::map<VehicleId, Schedule<double>> rates_;
  SimDuration lag_;
  bool are_heard_ = false;
};

// Returns the power over the band at 1 m, uPa^2, when the driver has the value `speed`; 0 for a vehicle that
// stands still.
double noise_power_at_1m(const NoiseSource& noise, double speed, double low_hz, double high_hz);

}  // namespace halocline::channel_server
