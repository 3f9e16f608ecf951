// Who steps when in lockstep: the one rule that the run in one process and the run in many both follow.
//
// Discrete events. Time goes to the earliest instant at which a participant is due. There the stages come in
// their order (who moves vehicles before who pilots them, the channel server last), and all participants of a
// stage that are due step together: none hears what the others of its stage say in that round. What they said
// is put in order (by participant, then as each said it) and delivered; then the next stage comes. Passes over
// the stages are repeated until nobody is due at that instant; then time goes on.
//
// So the order of all messages of a run depends on who takes part and on what they say alone, never on how
// long anything took or on who joined first.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/sim_time.h"

namespace halocline::bus {

struct LockstepSeat {
  int stage = 0;
  SimTime due = SimTime::never();
  // Something waits for it that may make it due: it must be asked.
  bool must_hear = false;
};

class LockstepSchedule {
 public:
  SimTime now() const { return now_; }

  // The earliest instant at which somebody is due, the present one at the earliest; never() when nobody is.
  // A seat that must hear is due at the present instant.
  SimTime next_instant(std::span<const LockstepSeat> seats) const;
  // Time goes to `instant`, which is not before now().
  void begin(SimTime instant);
  // The seats of the next round at now(), all of one stage, as indices in rising order; empty when the instant
  // is over. `seats` are in rising order of stage. Throws std::runtime_error when nobody comes to rest.
  std::vector<std::size_t> round(std::span<const LockstepSeat> seats);
  // A seat of `stage` that stepped alone went on by itself as far as `instant`: the instant goes on behind it.
  void resume_after(SimTime instant, int stage);

 private:
  SimTime now_;
  int next_stage_ = 0;
  int passes_ = 0;
};

// How far a seat that steps alone may go on by itself: all of its own instants before this one. A due instant is
// a promise to say nothing before it unless something is heard, so until the earliest of the others is due
// nobody can say anything that it would hear. at_once() when somebody must be asked at once.
SimTime lockstep_horizon(std::span<const LockstepSeat> seats, std::size_t alone);

}  // namespace halocline::bus
