// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/vehicles/vehicle_noise.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"

namespace halocline::channel_server {

VehicleNoise::VehicleNoise(std::vector<NoiseSource> sources, SimDuration lag) : lag_(lag) {
  for (NoiseSource& source : sources) {
    require(std::isfinite(source.reference) && source.reference > 0,
            "the reference speed of a vehicle's noise must be above 0");
    require_in_range(source.own_loss.value, 0, 200, "loss of own noise", "dB");
    are_heard_ = are_heard_ || source.is_heard_by_others;
    ids_.emplace(source.vehicle, source.id);
    sources_.emplace(source.id, std::move(source));
  }
}

void VehicleNoise::add_rate(std::string_view vehicle, SimTime at, double turns_per_s) {
  const auto known = ids_.find(vehicle);
  if (known == ids_.end()) return;
  rates_.try_emplace(known->second, 0.0, kMaxRates).first->second.set(at, std::abs(turns_per_s));
}

double VehicleNoise::rate_at(VehicleId id, SimTime at, SimTime decided_at) const {
  const auto known = rates_.find(id);
  return known == rates_.end() ? 0 : known->second.at(std::min(at, decided_at - lag_));
}

void VehicleNoise::forget_before(SimTime time) {
  for (auto& [id, rates] : rates_) rates.forget_before(time - lag_);
}

// The factor on power is 10^((60 log10 r) / 10) = r^6 with r = speed / reference.
double noise_power_at_1m(const NoiseSource& noise, double speed, double low_hz, double high_hz) {
  const double ratio = noise.driver == NoiseDriver::kNone ? 1 : std::abs(speed) / noise.reference;
  const double cube = ratio * ratio * ratio;
  return cube * cube * noise.at_1m.power_over_band(low_hz, high_hz).value;
}

}  // namespace halocline::channel_server
