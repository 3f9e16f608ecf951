// SPDX-License-Identifier: BSD-3-Clause
// What a hydrophone of a scenario records where nobody transmits: the sea's noise, and that of vehicles.
//
// The sea's is shaped over the whole band of the samples, with its slow variation and its bursts
// (acoustics/noise/noise_variation.h). Vehicles that make noise (channel_server/vehicles/vehicle_noise.h) are
// as loud as they are fast, at each instant: the receiver's own is heard directly, that of others along the
// paths of their links to it. Draws are addressed by sample: the same noise every time.
#pragma once

#include <string>

#include "acoustics/waveform/moving_link.h"
#include "clients/halocline/analysis/recording.h"
#include "clients/halocline/scenario/composition.h"
#include "clients/halocline/waveform/scenario_links.h"

namespace halocline::clients {

// Adds to `sound`, pressure, uPa.
void add_sea_noise(const ScenarioConfig& config, const ScenarioLinks& links, const std::string& receiver,
                   acoustics::Samples& sound);
// `run`: with SENSORS, by which propellers go.
void add_vehicle_noise(const ScenarioConfig& config, ScenarioLinks& links, const Recording& run,
                       const std::string& receiver, acoustics::Samples& sound);

}  // namespace halocline::clients
