// SPDX-License-Identifier: BSD-3-Clause
// Reads ambient noise by time and frequency, or by frequency alone, from a table in a file.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "acoustics/noise/noise_spectrum.h"
#include "core/sim_time.h"

namespace halocline::acoustics {

// A noise spectrum and the time from which it applies.
struct TimedSpectrum {
  SimTime from;  // it applies until the next one
  std::shared_ptr<const NoiseSpectrum> spectrum;
};

// Reads a CSV file with the columns t_s, frequency_khz and level_db (dB re 1 uPa^2/Hz), sorted by time, then
// by frequency. Returns at least one spectrum; the first one also applies before its time. Throws
// InvalidArgument, with the file and the line, when the file cannot be read or a value is out of range.
std::vector<TimedSpectrum> read_noise_table(const std::string& path);

// Reads a CSV file with the columns frequency_khz and level_db (dB re 1 uPa^2/Hz), by rising frequency.
// Throws InvalidArgument as read_noise_table() does.
std::shared_ptr<const NoiseSpectrum> read_noise_spectrum(const std::string& path);

}  // namespace halocline::acoustics
