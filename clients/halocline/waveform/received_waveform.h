// SPDX-License-Identifier: BSD-3-Clause
// What a hydrophone of a scenario records while others transmit waveforms.
//
// Each sender's sound goes along the paths of its link to the receiver, as packets' does (scenario_links.h):
// with the ends where a recorded run had them, the receiver when the sound arrives; with their phases, and
// their fading at the arrival of the first by the model (acoustics/fading/link_fading.h) or a measured
// channel; delayed, turned and summed by acoustics/waveform/moving_link.h. To that comes the noise of the sea
// and of vehicles (recorded_noise.h). All draws are those of the scenario's seed: the same file every time.
//
// Levels. A sine of amplitude 1 in a sender's samples has the source level (rms, dB re 1 uPa at 1 m).
// Received pressure p becomes the sample 10^(sensitivity / 20) p, p in uPa: at -190 dB re 1/uPa a sine of
// amplitude 1 has 187 dB re 1 uPa. Left out: a path's own echoes beyond those that the scenario's model of
// propagation finds.
#pragma once

#include <string>
#include <vector>

#include "acoustics/waveform/moving_link.h"
#include "bathymetry/rasters/terrain_recipe.h"
#include "clients/halocline/analysis/recording.h"
#include "clients/halocline/scenario/composition.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::clients {

struct SentWaveform {
  std::string vehicle;
  acoustics::Samples sound;  // begin_s: simulation time at which the first leaves, 0 and up
  Decibels source_level;     // of a sine of amplitude 1, dB re 1 uPa at 1 m
};

struct WaveformRules {
  std::string receiver;        // a vehicle
  double begin_s = 0;          // simulation time of the first sample recorded
  double tail_s = 0.5;         // recorded after the last sound has arrived
  Decibels sensitivity{-190};  // dB re 1/uPa
  bool has_noise = true;
};

// Of one rate. Throws InvalidArgument where senders' rates differ, a vehicle is not of the scenario, or has
// no state.
acoustics::Samples received_waveform(const ScenarioConfig& config, const bathymetry::PreparedTerrain& terrain,
                                     const Recording& run, const std::vector<SentWaveform>& sent,
                                     const WaveformRules& rules);

}  // namespace halocline::clients
