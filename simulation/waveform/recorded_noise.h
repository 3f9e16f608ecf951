// SPDX-License-Identifier: BSD-3-Clause
// Noise that a hydrophone of a scenario records: that of the sea, and that of vehicles.
//
// The noise of the sea is shaped over the whole band of the samples, with its slow variation and its bursts
// (acoustics/noise/noise_variation.h). Vehicles that make noise (channel_server/vehicles/vehicle_noise.h)
// have a level that follows their speed at each instant: the receiver's own noise is heard directly, that of
// others along the paths of their links to it. Random draws are indexed by sample: the noise is the same
// every time.
#pragma once

#include <string>

#include "acoustics/waveform/moving_link.h"
#include "runs/analysis/recording.h"
#include "simulation/composition.h"
#include "simulation/waveform/scenario_links.h"

namespace halocline::clients {

// Adds the noise of the sea to `sound`, a pressure in uPa.
void add_sea_noise(const ScenarioConfig& config, const ScenarioLinks& links, const std::string& receiver,
                   acoustics::Samples& sound);
// Adds the noise of vehicles. `run` must contain SENSORS, which hold the turn rates of propellers.
void add_vehicle_noise(const ScenarioConfig& config, ScenarioLinks& links, const Recording& run,
                       const std::string& receiver, acoustics::Samples& sound);

}  // namespace halocline::clients
