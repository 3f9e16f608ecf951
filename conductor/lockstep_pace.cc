// SPDX-License-Identifier: BSD-3-Clause
#include "conductor/lockstep_pace.h"

#include <algorithm>

#include "bus/lockstep/sequencer.h"

namespace halocline::conductor {
namespace {
constexpr SimDuration kMinPeriod = SimDuration::from_milliseconds(1);
}  // namespace

void LockstepPace::keep(LockstepConductor& conductor, SimTime steady) {
  const Sequencer& sequencer = conductor.sequencer();
  if (rate_ <= 0) return;
  if (sequencer.rounds() == 0) return conductor.set_pace(SimTime());
  if (!origin_) origin_ = {steady, sequencer.now()};
  conductor.set_pace(origin_->simulation +
                     SimDuration::from_seconds((steady - origin_->steady).seconds() * rate_));
  next_due_ = steady + kMinPeriod;
  const SimTime next = sequencer.next_instant();
  if (sequencer.in_round() || next == SimTime::never()) return;
  next_due_ = std::max(
      next_due_, origin_->steady + SimDuration::from_seconds((next - origin_->simulation).seconds() / rate_));
}

}  // namespace halocline::conductor
