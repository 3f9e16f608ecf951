// SPDX-License-Identifier: BSD-3-Clause
// The instant that a connection shows: it follows the newest message, plays at a speed, or stands. Pure:
// steady time is passed in, in seconds.
#pragma once

#include "core/sim_time.h"

namespace halocline::monitor {

class Playback {
 public:
  static constexpr double kMinSpeed = 0.1, kMaxSpeed = 100;

  // `live`: follows a bus from the start; otherwise it stands at the beginning of a log.
  explicit Playback(bool live) : live_(live), playing_(live), follows_(live) {}

  // Advances to `steady_s`; the instant lies within begin..end.
  void advance(double steady_s, SimTime begin, SimTime end);

  // At the end of a log it begins again at `begin`.
  void play(SimTime begin, SimTime end);
  void pause();
  void set_speed(double speed);  // kMinSpeed to kMaxSpeed
  void seek(SimTime at);
  void follow();  // of a bus: the newest message again

  SimTime at() const { return at_; }
  bool is_live() const { return live_; }
  bool is_playing() const { return playing_; }
  double speed() const { return speed_; }

 private:
  bool live_, playing_;
  bool follows_;  // a bus, whose end moves
  double speed_ = 1, last_s_ = 0;
  bool advanced_ = false;
  SimTime at_ = SimTime();
};

}  // namespace halocline::monitor
