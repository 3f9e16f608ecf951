// SPDX-License-Identifier: BSD-3-Clause
// The noise that vehicles make, and how loud each is at an instant.
//
// Model: a spectrum at 1 m at a reference speed, and 60 log10(v / v_ref) dB more at another (Urick 1983,
// chapter 11: broadband noise of propellers and flow grows with the fifth to sixth power of speed). v is the
// fastest turn rate of its propeller and thrusters, or its speed over ground, or nothing: a ship at her
// speed, a jammer. Standing still is silence. At the own hydrophone it is own_loss below that at 1 m.
//
// Turn rates are those of SENSORS. The one that holds at t, as decided at d, is the latest with an instant at
// or before both t and d - lag, the lag of states (state_history.h); before the first it is 0. So it does not
// depend on which message was quicker. Speeds are those of the states. Not thread-safe.
#pragma once

#include <cstddef>
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
  kSpeed,      // over ground
  kNone,       // always the same
};

// The noise of one vehicle, by its name and id.
struct NoiseOf {
  std::string vehicle;
  VehicleId id = 0;
  // At the reference, dB re 1 uPa^2/Hz. Our choice for a small vehicle: 20 dB less a decade, as machinery and
  // cavitation have above 1 kHz (Urick 1983, chapter 10).
  acoustics::NoiseSpectrum at_1m{{1e3, 1e5}, {100, 60}};
  NoiseDriver driver = NoiseDriver::kPropeller;
  double reference = 25;  // turns a second (1500 rpm, our choice), or m/s; above 0
  Decibels own_loss{20};  // from 1 m to its own hydrophone, 0..200
};

class VehicleNoise {
 public:
  static constexpr std::size_t kMaxRates = 16'384;  // of one vehicle; the oldest make room

  VehicleNoise() = default;  // nobody makes any
  VehicleNoise(std::vector<NoiseOf> sources, SimDuration lag);

  // By id.
  const std::map<VehicleId, NoiseOf>& sources() const { return sources_; }
  bool needs_rates() const;
  // The turn rate of its fastest propeller at `at`, turns a second; of a vehicle that makes no noise of no
  // effect.
  void add_rate(std::string_view vehicle, SimTime at, double turns_per_s);
  double rate_at(VehicleId id, SimTime at, SimTime decided_at) const;

  void forget_before(SimTime time);
  void clear();  // forgets all rates

 private:
  std::map<VehicleId, NoiseOf> sources_;
  std::map<VehicleId, Schedule<double>> rates_;
  SimDuration lag_;
};

// Power over the band at 1 m, uPa^2, where what drives it is `speed`; 0 of a vehicle that stands still.
double noise_power_at_1m(const NoiseOf& noise, double speed, double low_hz, double high_hz);

}  // namespace halocline::channel_server
