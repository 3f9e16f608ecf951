#include "bus/lockstep/lockstep_schedule.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/check.h"

namespace halocline::bus {
namespace {

// A chain of answers to answers at one instant is a handful; this many means that it never ends.
constexpr int kMaxPassesPerInstant = 100'000;
constexpr int kFirstStage = std::numeric_limits<int>::min();

bool is_due(const LockstepSeat& seat, SimTime now) { return seat.must_hear || seat.due <= now; }

}  // namespace

SimTime LockstepSchedule::next_instant(std::span<const LockstepSeat> seats) const {
  SimTime next = SimTime::never();
  for (const LockstepSeat& seat : seats) next = std::min(next, seat.must_hear ? now_ : seat.due);
  return std::max(next, now_);
}

void LockstepSchedule::begin(SimTime instant) {
  ensure(instant >= now_, "time does not go back");
  now_ = instant;
  next_stage_ = kFirstStage;
  passes_ = 0;
}

void LockstepSchedule::resume_after(SimTime instant, int stage) {
  if (instant > now_) begin(instant);
  next_stage_ = stage + 1;
}

std::vector<std::size_t> LockstepSchedule::round(std::span<const LockstepSeat> seats) {
  const auto first_from = [&](int stage) {
    return std::find_if(seats.begin(), seats.end(),
                        [&](const LockstepSeat& seat) { return seat.stage >= stage && is_due(seat, now_); });
  };
  auto first = first_from(next_stage_);
  if (first == seats.end()) {
    first = first_from(kFirstStage);
    if (++passes_ == kMaxPassesPerInstant) {
      throw std::runtime_error(
          "nodes keep each other busy without end at t=" + std::to_string(now_.seconds()) + " s");
    }
  }
  std::vector<std::size_t> round;
  if (first == seats.end()) return round;
  next_stage_ = first->stage + 1;
  for (auto seat = first; seat != seats.end() && seat->stage == first->stage; ++seat) {
    if (is_due(*seat, now_)) round.push_back(static_cast<std::size_t>(seat - seats.begin()));
  }
  return round;
}

SimTime lockstep_horizon(std::span<const LockstepSeat> seats, std::size_t alone) {
  SimTime horizon = SimTime::never();
  for (std::size_t i = 0; i < seats.size(); ++i) {
    if (i == alone) continue;
    horizon = std::min(horizon, seats[i].must_hear ? SimTime::at_once() : seats[i].due);
  }
  return horizon;
}

}  // namespace halocline::bus
