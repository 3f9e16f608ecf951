// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/progress_line.h"

#include <algorithm>

#include <unistd.h>

#include "bus/runtime/node_process.h"

namespace halocline::clients {
namespace {
constexpr SimDuration kOnTerminal = SimDuration::from_milliseconds(200);
constexpr SimDuration kElsewhere = SimDuration::from_milliseconds(4000);
}  // namespace

ProgressLine::ProgressLine(std::FILE* out, SimTime end, bool quiet)
    : out_(out), end_(end), quiet_(quiet), terminal_(isatty(fileno(out)) != 0), started_(bus::steady_now()) {
  next_ = started_ + (terminal_ ? kOnTerminal : kElsewhere);
}

void ProgressLine::show(SimTime sim, SimTime steady) {
  if (quiet_ || steady < next_) return;
  write(sim, steady);
  next_ = steady + (terminal_ ? kOnTerminal : kElsewhere);
}

void ProgressLine::finish(SimTime sim, SimTime steady) {
  if (quiet_ || !written_) return;
  write(sim, steady);
  if (terminal_) std::fputs("\n", out_);
}

void ProgressLine::write(SimTime sim, SimTime steady) {
  const double wall_s = std::max((steady - started_).seconds(), 1e-3);
  const double share = end_ > SimTime() ? sim.seconds() / end_.seconds() : 1;
  std::fprintf(out_, "%s%3.0f %%  t=%.1f of %.1f s  %.1f x real time%s", terminal_ ? "\r" : "", 100 * share,
               sim.seconds(), end_.seconds(), sim.seconds() / wall_s, terminal_ ? "   " : "\n");
  std::fflush(out_);
  written_ = true;
}

}  // namespace halocline::clients
