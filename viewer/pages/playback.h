// SPDX-License-Identifier: BSD-3-Clause
// Playback position of a connection: it follows the newest message, advances at a speed, or is paused. Steady
// time is passed in, s.
#pragma once

#include "core/sim_time.h"

namespace halocline::monitor {

class Playback {
 public:
  static constexpr double kMinSpeed = 0.1, kMaxSpeed = 100;

  // `live`: follows a bus from the start; otherwise playback is paused at the beginning of a log.
  explicit Playback(bool live) : live_(live), playing_(live), follows_(live) {}

  // Advances to `steady_s` and clamps the position to begin..end.
  void advance(double steady_s, SimTime begin, SimTime end);

  // Starts playback; at the end of a log it restarts from `begin`.
  void play(SimTime begin, SimTime end);
  void pause();
  void set_speed(double speed);  // kMinSpeed to kMaxSpeed
  void seek(SimTime at);
  void follow();  // shows the newest message of a bus again

  SimTime at() const { return at_; }
  bool is_live() const { return live_; }
  bool is_playing() const { return playing_; }
  double speed() const { return speed_; }

 private:
  bool live_, playing_;
  bool follows_;  // the source is a bus, whose end advances
  double speed_ = 1, last_s_ = 0;
  bool advanced_ = false;
  SimTime at_ = SimTime();
};

}  // namespace halocline::monitor
