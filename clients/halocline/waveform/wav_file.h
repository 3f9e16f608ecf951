// SPDX-License-Identifier: BSD-3-Clause
// Sampled sound in files.
#pragma once

#include <string>

#include "acoustics/waveform/moving_link.h"

namespace halocline::clients {

// A file of one channel in any format that libsndfile reads (WAV, FLAC, ...), full scale 1; begin_s is 0.
// Throws InvalidArgument, with the path, where it cannot be read, has several channels or no sample, or holds
// a number that is none.
acoustics::Samples read_sound(const std::string& path);

// A WAV file of 32-bit floating-point samples; throws InvalidArgument, with the path, where it cannot be
// written.
void write_wav(const std::string& path, const acoustics::Samples& sound);

}  // namespace halocline::clients
