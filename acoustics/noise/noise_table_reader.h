// SPDX-License-Identifier: BSD-3-Clause
// Ambient noise as a table by time and frequency, from a file.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "acoustics/noise/noise_spectrum.h"
#include "core/sim_time.h"

namespace halocline::acoustics {

struct TimedSpectrum {
  SimTime from;  // it holds until the next
  std::shared_ptr<const NoiseSpectrum> spectrum;
};

// A CSV with the columns t_s, frequency_khz and level_db (dB re 1 uPa^2/Hz), its rows by time, then by
// frequency. At least one spectrum; the first also holds before its time. Throws InvalidArgument, with the
// file and the line, where it cannot be read or is impossible.
std::vector<TimedSpectrum> read_noise_table(const std::string& path);

}  // namespace halocline::acoustics
