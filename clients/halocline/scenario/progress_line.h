// SPDX-License-Identifier: BSD-3-Clause
// The progress of a run on stderr: one line that is rewritten on a terminal, and a new line every four
// seconds elsewhere.
#pragma once

#include <cstdio>

#include "core/sim_time.h"

namespace halocline::clients {

class ProgressLine {
 public:
  ProgressLine(std::FILE* out, SimTime end, bool quiet);

  // Cheap enough for every instant: writes only when enough wall time has passed.
  void show(SimTime sim, SimTime steady);
  // Ends the line.
  void finish(SimTime sim, SimTime steady);

 private:
  void write(SimTime sim, SimTime steady);

  std::FILE* out_;
  SimTime end_;
  bool quiet_, terminal_;
  SimTime started_;
  SimTime next_;
  bool written_ = false;
};

}  // namespace halocline::clients
