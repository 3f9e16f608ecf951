// SPDX-License-Identifier: BSD-3-Clause
// Reading and writing of sound files.
#pragma once

#include <string>

#include "acoustics/waveform/moving_link.h"

namespace halocline::clients {

// Reads a file with one channel in any format of libsndfile (WAV, FLAC, ...), full scale 1; begin_s is 0.
// Throws InvalidArgument that names the path when the file cannot be read, has several channels or no
// samples, or holds a sample that is not a finite number.
acoustics::Samples read_sound(const std::string& path);

// Writes a WAV file with 32-bit floating-point samples. Throws InvalidArgument that names the path when it
// cannot be written.
void write_wav(const std::string& path, const acoustics::Samples& sound);

}  // namespace halocline::clients
