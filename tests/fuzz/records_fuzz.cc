// SPDX-License-Identifier: BSD-3-Clause
// A measured channel (HDF5) through our reader: the receiver by the first byte, then the file.
#include "acoustics/fading/channel_record.h"
#include "acoustics/fading/channel_record_reader.h"
#include "core/check.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/scratch_file.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace halocline;
  static fuzz::ScratchFile file(".mat");
  fuzz::Input input(data, size);
  const std::size_t receiver = input.below(3);
  try {
    acoustics::read_channel_record(file.write(input.rest_as_text()), receiver);
  } catch (const InvalidArgument&) {
  }
  return 0;
}
