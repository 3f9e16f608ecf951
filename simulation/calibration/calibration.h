// SPDX-License-Identifier: BSD-3-Clause
// Calibration of a scenario by the first days of a trial: up to five numbers that are fitted to packets,
// levels and signal-to-noise ratios of its pairs.
//
//   number          acts on                                          prior
//   offset_db       noise up, or receivers worse, of all links       0 with 6 dB; 10 above 40 kHz
//   boundary_scale  rms height and slope of the bottom, as a factor  logarithm 0 with ln 2
//   slow_db         spread of levels over hours                      logarithm ln 4.2 with 0.5
//   echo_scale      share of late echoes that disturbs, as a factor  logarithm 0 with ln 2
//
// Noise and receivers cannot be told apart by packets, so the offset is one number of noise; where packets
// and SNRs were measured it is two, `noise` with what 6 or 10 dB leave beside the 2 dB of `receiver`. A
// number whose deviation after the fit is above 0.8 of its prior's is not told by the data and keeps its
// prior. Fewer than 3 pairs, or 30 packets and levels, fit the offset alone. Bins of time are a third of the
// correlation time of the slow fading (6 h where the scenario has none). trial_likelihood.h and trial_fit.h
// have the model.
//
// Left out: vehicles that move, tides, biases of single pairs, and whatever differs between the trial and the
// scenario beside these numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "simulation/calibration/left_out_pairs.h"
#include "simulation/calibration/trial_data.h"
#include "simulation/calibration/trial_fit.h"
#include "simulation/calibration/trial_likelihood.h"
#include "simulation/composition.h"

namespace halocline::clients {

// A number after the fit, decibels or factors; of a factor `deviation` is that of its logarithm.
struct CalibratedNumber {
  std::string name;
  SeaNumber number = kNoiseDb;
  bool is_logarithmic = false;
  bool is_told = false;  // false: it keeps its prior
  double value = 0, deviation = 0;
  double prior_value = 0, prior_deviation = 0;
  double fitted_deviation = 0;  // before it was put aside
};

struct CorrelatedNumbers {
  std::string one, other;
  double correlation = 0;  // beyond 0.9 either way
};

struct Calibration {
  std::vector<CalibratedNumber> numbers;  // those that the trial may tell
  bool is_offset_alone = false;           // too few pairs or packets for more
  double noise_bottom_correlation = 0;    // of noise and the bottom's factor; 0 unless both are told
  std::vector<CorrelatedNumbers> correlated;
  std::vector<PairCheck> checks;  // in the order of the pairs; empty with a single pair
  std::size_t pairs = 0, bins = 0;
  std::int64_t packets = 0, levels = 0;
  SlowTimes times;

  // Returns the number of that kind if the trial tells it, else null.
  const CalibratedNumber* told(SeaNumber number) const;
};

// Fits the rows (at least one) to the scenario, whose vehicles are where they start. Throws InvalidArgument
// when a row's end is none.
Calibration calibrate(const ScenarioConfig& config, const std::vector<TrialRow>& rows);

// Fits pairs whose forecasts are known; `frequency_hz` is that of their modems. The forecasts of all pairs
// have the same numbers: a bottom's factor, and an echoes' factor where `has_echoes`.
Calibration calibrate_forecasts(const std::vector<ForecastPair>& pairs, double frequency_hz, bool has_bottom,
                                bool has_echoes);

}  // namespace halocline::clients
