// SPDX-License-Identifier: BSD-3-Clause
// Recording of a hydrophone in a scenario while vehicles transmit waveforms.
//
// Model. Each sender's sound follows the paths of its link to the receiver, as packets do (scenario_links.h):
// with the ends where a recorded run had them, the receiver at the arrival of the sound; with the phases of
// the paths and their fading at the arrival of the first, either by the model
// (acoustics/fading/link_fading.h) or as a measured channel; delayed, rotated in phase and summed by
// acoustics/waveform/moving_link.h. The noise of the sea and of vehicles is added (recorded_noise.h). All
// random draws derive from the scenario's seed: the file is the same every time. Only the paths that the
// scenario's propagation model finds are included.
//
// Levels. A sine of amplitude 1 in a sender's samples has the source level (rms, dB re 1 uPa at 1 m). With
// the sensitivity S in dB re 1/uPa, a received pressure p in uPa becomes the sample
//
//   10^(S / 20) p
//
// so that at S = -190 dB a sine of amplitude 1 has a level of 187 dB re 1 uPa.
#pragma once

#include <string>
#include <vector>

#include "acoustics/waveform/moving_link.h"
#include "bathymetry/rasters/terrain_recipe.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "runs/analysis/recording.h"
#include "simulation/composition.h"

namespace halocline::clients {

struct SentWaveform {
  std::string vehicle;
  acoustics::Samples sound;  // begin_s: simulation time of its first sample, 0 or later
  Decibels source_level;     // level of a sine of amplitude 1, dB re 1 uPa at 1 m
};

struct WaveformRules {
  std::string receiver;        // name of a vehicle
  double begin_s = 0;          // simulation time of the first recorded sample
  double tail_s = 0.5;         // recorded time after the end of the last arrival
  Decibels sensitivity{-190};  // dB re 1/uPa
  bool has_noise = true;
};

// Returns the recording, at the sampling rate of the senders. Throws InvalidArgument when their rates differ,
// or when a vehicle is not in the scenario or has no state.
acoustics::Samples received_waveform(const ScenarioConfig& config, const bathymetry::PreparedTerrain& terrain,
                                     const Recording& run, const std::vector<SentWaveform>& sent,
                                     const WaveformRules& rules);

}  // namespace halocline::clients
