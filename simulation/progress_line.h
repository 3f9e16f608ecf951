// SPDX-License-Identifier: BSD-3-Clause
// Progress of a run on stderr: on a terminal one line that is rewritten, otherwise a new line every four
// seconds.
#pragma once

#include <cstdio>

#include "core/sim_time.h"

namespace halocline::clients {

class ProgressLine {
 public:
  ProgressLine(std::FILE* out, SimTime end, bool quiet);

  // Writes the progress when enough wall time has passed; cheap enough to be called at every instant.
  void show(SimTime sim, SimTime steady);
  // Writes the final progress and ends the line.
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
