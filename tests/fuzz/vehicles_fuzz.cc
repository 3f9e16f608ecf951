// SPDX-License-Identifier: BSD-3-Clause
// Vehicles out of files: a model (TOML), which is written and read again, or a table of commands (CSV).
#include <sstream>
#include <string>

#include "core/check.h"
#include "simulation/vehicle_replay.h"
#include "tests/fuzz/fuzz_input.h"
#include "vehicle_sim/model_config.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace halocline;
  fuzz::Input input(data, size);
  const bool is_model = input.below(2) == 0;
  const std::string text(input.rest_as_text());
  try {
    if (is_model) {
      vehicle_sim::parse_model(vehicle_sim::model_toml(vehicle_sim::parse_model(text, "model")), "again");
    } else {
      std::istringstream in(text);
      clients::read_schedule(in, "commands");
    }
  } catch (const InvalidArgument&) {
  }
  return 0;
}
