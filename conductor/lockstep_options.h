// SPDX-License-Identifier: BSD-3-Clause
// Command line options of `halocline-conductor --lockstep`.
#pragma once

#include <string>
#include <vector>

#include "bus/runtime/node_process.h"

namespace halocline::conductor {

class LockstepOptions {
 public:
  // The options point into this object, which must outlive the parsing.
  std::vector<bus::ProgramOption> options();
  // Coordinates a lockstep run if --lockstep was given; returns false otherwise. Throws InvalidArgument for
  // impossible values, and for options that need --lockstep if it was not given.
  [[nodiscard]] bool run_if_requested(const bus::NodeProgram::Context& context) const;

 private:
  void require_none() const;

  bool lockstep_ = false, no_lookahead_ = false, bridge_bus_ = false;
  std::string expect_ = "bathymetry,vehicle-sim,autopilot,traffic,localiser,channel-server";
  std::string log_, journal_, rate_ = "0", drop_after_ = "0";
};

}  // namespace halocline::conductor
