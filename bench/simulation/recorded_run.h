// SPDX-License-Identifier: BSD-3-Clause
// Runs of scenarios that benchmarks read again.
#pragma once

#include <filesystem>
#include <string>

#include <lcm/lcm-cpp.hpp>
#include <unistd.h>

#include "bus/transport/event_log.h"
#include "core/sim_time.h"
#include "simulation/composition.h"
#include "simulation/embedded_run.h"

namespace halocline::clients {

inline std::string temporary(const std::string& name) {
  return (std::filesystem::temp_directory_path() / "halocline-bench-").string() + std::to_string(getpid()) +
         name;
}

// The log of a whole run, made once a process and scenario.
inline std::string recorded(const ScenarioConfig& config) {
  const std::string path = temporary("-" + config.scenario.name + ".lcm");
  if (std::filesystem::exists(path)) return path;
  bus::set_log_level(bus::LogLevel::kSilent);
  lcm::LCM lcm("memq://");
  Composition all(lcm, config, Composition::kRun);
  EmbeddedRun run{.end = SimTime() + config.scenario.duration, .log_path = path};
  run.quiet = true;
  run_embedded(all.nodes(), run);
  return path;
}

}  // namespace halocline::clients
