// SPDX-License-Identifier: BSD-3-Clause
// A sound file, of any kind that libsndfile knows, through our reader.
#include "core/check.h"
#include "simulation/waveform/wav_file.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/scratch_file.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace halocline;
  static fuzz::ScratchFile file(".wav");
  fuzz::Input input(data, size);
  try {
    clients::read_sound(file.write(input.rest_as_text()));
  } catch (const InvalidArgument&) {
  }
  return 0;
}
