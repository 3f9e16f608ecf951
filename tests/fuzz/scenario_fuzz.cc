// SPDX-License-Identifier: BSD-3-Clause
// A scenario as TOML, but for its terrain. Lines that begin with "#set " are overrides of the command line.
// What is accepted can be written as a scenario that is accepted.
#include <sstream>
#include <string>
#include <vector>

#include "bus/config/config.h"
#include "core/check.h"
#include "simulation/composition.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/scratch_file.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace halocline;
  static fuzz::ScratchFile file(".toml");
  const std::string text(reinterpret_cast<const char*>(data), size);
  file.write(text);
  std::vector<std::string> overrides;
  std::istringstream lines(text);
  constexpr std::string_view kSet = "#set ";
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(kSet)) overrides.push_back(line.substr(kSet.size()));
  }
  try {
    const clients::ScenarioConfig config = clients::load_scenario(file.path(), overrides);
    const std::string effective = clients::effective_toml(config);
    bus::ConfigFile again = bus::ConfigFile::parse(effective, "effective");
    clients::ScenarioConfig same;
    again.read([&](bus::ConfigVisitor& v) { visit(v, same); });
  } catch (const InvalidArgument&) {
  }
  return 0;
}
