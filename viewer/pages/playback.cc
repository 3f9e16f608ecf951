// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/pages/playback.h"

#include <algorithm>
#include <utility>

namespace halocline::monitor {

void Playback::advance(double steady_s, SimTime begin, SimTime end) {
  const double passed_s = advanced_ ? steady_s - last_s_ : 0;
  last_s_ = steady_s;
  if (begin > end) return;  // nothing was received yet
  if (!std::exchange(advanced_, true)) at_ = begin;
  if (live_) at_ = end;
  if (playing_ && !live_) at_ = at_ + SimDuration::from_seconds(passed_s * speed_);
  at_ = std::clamp(at_, begin, end);
  if (at_ == end && !follows_) playing_ = false;
}

void Playback::play(SimTime begin, SimTime end) {
  if (!follows_ && at_ >= end) at_ = begin;
  playing_ = true;
}

void Playback::pause() {
  playing_ = false;
  live_ = false;
}

void Playback::set_speed(double speed) { speed_ = std::clamp(speed, kMinSpeed, kMaxSpeed); }

void Playback::seek(SimTime at) {
  live_ = false;
  advanced_ = true;
  at_ = at;
}

void Playback::follow() {
  live_ = true;
  playing_ = true;
}

}  // namespace halocline::monitor
