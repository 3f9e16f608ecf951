// SPDX-License-Identifier: BSD-3-Clause
// Readers of tables (CSV), by the first byte: water, noise, bottom, links, the calculator's.
#include <array>
#include <sstream>
#include <string>
#include <vector>

#include "acoustics/noise/noise_table_reader.h"
#include "acoustics/sea/profile_reader.h"
#include "core/check.h"
#include "halocline/calc/calc.h"
#include "halocline/calc/quantity.h"
#include "simulation/arrivals/sea_files.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/scratch_file.h"

namespace {

using namespace halocline;

void calculate(fuzz::Input& input) {
  // Of what computes in no time.
  static const std::array<std::string, 4> kQuantities{"sound-speed", "absorption", "noise",
                                                      "transmission-loss"};
  clients::CalcOptions options;
  options.quantity = kQuantities[input.below(kQuantities.size())];
  std::istringstream in(std::string(input.rest_as_text()));
  std::ostringstream out, problems;
  const int code = clients::run_calc(options, in, out, problems);
  ensure(code == clients::kCalcDone || !problems.str().empty(), "what is refused is explained");
}

void read(fuzz::Input& input) {
  const std::size_t kind = input.below(5);
  if (kind == 0) return calculate(input);
  std::string text(input.rest_as_text());
  std::istringstream in(text);
  switch (kind) {
    case 1:
      acoustics::read_csv_profile(in, "water.csv", {});
      break;
    case 2:
      static fuzz::ScratchFile file(".csv");
      acoustics::read_noise_table(file.write(text));
      break;
    case 3:
      clients::read_bottom_profile(in, "bottom.csv");
      break;
    default:
      clients::read_links(in, "links.csv");
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  try {
    read(input);
  } catch (const halocline::InvalidArgument&) {
  }
  return 0;
}
