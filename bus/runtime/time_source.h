// SPDX-License-Identifier: BSD-3-Clause
// Sources of a process's simulation time.
//
// Steady time (integer nanoseconds since the process started) and wall time are parameters, never read here.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <lcm/lcm-cpp.hpp>

#include "bus/bus.h"
#include "bus/event_log.h"
#include "bus/subscription.h"
#include "core/sim_time.h"

namespace halocline::bus {

// Logs once that the time is unknown: after kSilence without the messages that it is taken from.
class SilenceWarning {
 public:
  static constexpr SimDuration kSilence = SimDuration::from_milliseconds(3000);

  // `awaited` names the messages, such as "CLOCK".
  SilenceWarning(std::string process_name, std::string awaited);
  void on_unknown_time(SimTime steady);

 private:
  EventLog log_;
  std::string awaited_;
  std::optional<SimTime> since_;
  bool logged_ = false;
};

class TimeSource {
 public:
  virtual ~TimeSource() = default;
  // Called before messages are dispatched: the steady time at which that begins, and the wall time (Unix),
  // against which LCM's receive stamps give the delay of each message; without it they count as received now.
  // `longest_wait`: since all had been dispatched before, so that none has waited for longer.
  void set_steady(SimTime steady, std::optional<SimTime> wall = {}, SimDuration longest_wait = kLongestWait) {
    steady_ = steady;
    wall_ = wall;
    longest_wait_ = std::max(longest_wait, kLongestWait);
  }
  // Simulation time at `steady`; empty while none is known yet. Never goes back unless restarted().
  virtual std::optional<SimTime> now(SimTime steady) = 0;
  // The steady time at which simulation time will reach `sim`; never() where that is unknown.
  virtual SimTime steady_at(SimTime sim) const = 0;
  // True once after simulation time jumped back: another run has begun, state of the old one is void.
  [[nodiscard]] virtual bool restarted() { return false; }
  // How many messages it refused so far because they contradict the time that it follows.
  virtual std::int64_t num_refused() const { return 0; }
  // What it receives by itself; null: nothing.
  virtual const Subscriptions* receives() const { return nullptr; }

 protected:
  // Longest delay between the network and a handler that is credited to a message of a process that was not
  // halted.
  static constexpr SimDuration kLongestWait = SimDuration::from_milliseconds(100);
  SimTime steady_;
  std::optional<SimTime> wall_;
  SimDuration longest_wait_ = kLongestWait;
};

// Follows the CLOCK of a conductor, and coasts at its last rate when the conductor falls silent.
//
// Each CLOCK carries a simulation time and a rate, and is received after an unknown delay; so the smallest
// (steady - utime / rate) of the last second is the best estimate of the offset between the clocks.
//
// Anybody may publish CLOCK. A session is taken up when two of its CLOCKs agree: the second tells the time
// that the first lets expect, to kLeap behind and kLeapAhead ahead (of simulated or of steady time, whichever
// is longer). It stays until nothing as expected has come of it for kSilence. CLOCKs of other sessions, and
// of its own that leap or have another rate, are refused until then, and count as refused once it is heard
// again. Within a session numbers and times rise: an old CLOCK that comes again changes nothing. A restarted
// conductor goes on from the time of the others, who coast until they take it up.
class ConductorTime : public TimeSource {
 public:
  static constexpr SimDuration kSilence = SimDuration::from_milliseconds(3000);
  // Time that has gone ahead cannot be taken back, so little is believed.
  static constexpr SimDuration kLeap = SimDuration::from_milliseconds(60'000),
                               kLeapAhead = SimDuration::from_milliseconds(5'000);

  ConductorTime(lcm::LCM& lcm, const std::string& process_name);
  std::optional<SimTime> now(SimTime steady) override;
  SimTime steady_at(SimTime sim) const override;
  [[nodiscard]] bool restarted() override { return std::exchange(restarted_, false); }
  std::int64_t num_refused() const override { return bus_.counters().rivals; }
  const Subscriptions* receives() const override { return &bus_.receives(); }

  // A CLOCK that was received at `received` (steady).
  void on_clock(const sim_clock_t& clock, SimTime received);

 private:
  struct Sample {
    SimTime received;  // steady
    double offset_s;   // received - utime / rate, seconds
  };
  struct Heard {
    sim_clock_t clock;
    SimTime received;  // steady
  };
  static bool agree(const Heard& before, const sim_clock_t& clock, SimTime received);
  static bool goes_on(const Heard& before, const sim_clock_t& clock);
  bool is_old(const sim_clock_t& clock) const;
  bool is_witnessed(const sim_clock_t& clock, SimTime received);
  void refuse_unexpected();
  void take(const sim_clock_t& clock, SimTime received);
  // When the message being handled was received (steady); bounded, as the wall clock may have been set
  // meanwhile.
  SimTime received() const;

  Bus bus_;
  SilenceWarning silence_;
  double rate_ = 0;
  std::optional<Heard> last_;    // of the session that is followed
  std::deque<Heard> witnesses_;  // the latest of each session that nothing has agreed with yet
  std::int64_t num_others_ = 0, num_leaps_ = 0;  // CLOCKs of other sessions, and leaps, since the last one
  std::deque<Sample> samples_;
  std::optional<SimTime> paused_at_;
  SimTime latest_ = SimTime::at_once();
  bool restarted_ = false;
};

// The greatest utime received in a STATE or SEND: for a lone channel server beside a replayed log. Stands
// still between messages. A utime more than ten seconds before the greatest one means that a log was started
// anew.
class MessageTime : public TimeSource {
 public:
  MessageTime(lcm::LCM& lcm, const std::string& process_name);
  std::optional<SimTime> now(SimTime steady) override;
  SimTime steady_at(SimTime sim) const override;
  [[nodiscard]] bool restarted() override { return std::exchange(restarted_, false); }
  const Subscriptions* receives() const override { return &bus_.receives(); }

  void on_utime(std::int64_t utime);

 private:
  Bus bus_;
  SilenceWarning silence_;
  std::optional<SimTime> latest_;
  bool restarted_ = false;
};

// Simulation time is the wall clock's Unix time: for a lone channel server beside real vehicles that stamp
// so.
class WallTime : public TimeSource {
 public:
  // Unix time, microseconds, at steady time 0.
  explicit WallTime(std::int64_t utime_at_start) : start_(SimTime::from_utime(utime_at_start)) {}
  std::optional<SimTime> now(SimTime steady) override { return start_ + (steady - SimTime()); }
  SimTime steady_at(SimTime sim) const override {
    return sim == SimTime::never() || sim == SimTime::at_once() ? sim : SimTime() + (sim - start_);
  }

 private:
  SimTime start_;
};

// kLockstep is no TimeSource: the process takes turns that the conductor grants (lockstep_process.h).
enum class TimeSourceKind { kConductor, kMessages, kWall, kLockstep };
// "conductor", "messages", "wall" or "lockstep"; throws InvalidArgument that lists them otherwise.
TimeSourceKind time_source_from_name(std::string_view name);
// For process `name` on a bus that loses datagrams; `wall_at_start`: Unix time at steady time 0. kLockstep:
// as kWall.
std::unique_ptr<TimeSource> make_time_source(TimeSourceKind kind, lcm::LCM& lcm, const std::string& name,
                                             SimTime wall_at_start);

}  // namespace halocline::bus
