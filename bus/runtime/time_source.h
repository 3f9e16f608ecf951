// SPDX-License-Identifier: BSD-3-Clause
// Sources of a process's simulation time.
//
// Steady time (integer nanoseconds since the process started) and wall time are parameters; no clock is read
// here.
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
#include "bus/transport/event_log.h"
#include "bus/transport/subscription.h"
#include "core/sim_time.h"

namespace halocline::bus {

// Logs once that the time is unknown: after kSilence without the messages from which it is taken.
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
  // Call before messages are dispatched. `steady` is the steady time at that moment. `wall` is the Unix time,
  // from which LCM's receive stamps give the delay of each message; without it, messages count as received
  // now. `longest_wait` is the time since no message was waiting, so that none has waited for longer.
  void set_steady(SimTime steady, std::optional<SimTime> wall = {}, SimDuration longest_wait = kLongestWait) {
    steady_ = steady;
    wall_ = wall;
    longest_wait_ = std::max(longest_wait, kLongestWait);
  }
  // Returns the simulation time at `steady`; nothing while it is unknown. Never decreases unless restarted().
  virtual std::optional<SimTime> now(SimTime steady) = 0;
  // Returns the steady time at which simulation time will reach `sim`; never() if that is unknown.
  virtual SimTime steady_at(SimTime sim) const = 0;
  // True once after simulation time jumped back: another run has begun, and the state of the old one is void.
  [[nodiscard]] virtual bool restarted() { return false; }
  // Returns how many messages were refused because they contradict the accepted time.
  virtual std::int64_t num_refused() const { return 0; }
  // Returns the subscriptions of the time source itself; null: none.
  virtual const Subscriptions* receives() const { return nullptr; }

 protected:
  // Limit on the delay between network and handler that is assumed for a message, unless the process was
  // halted.
  static constexpr SimDuration kLongestWait = SimDuration::from_milliseconds(100);
  SimTime steady_;
  std::optional<SimTime> wall_;
  SimDuration longest_wait_ = kLongestWait;
};

// Time of a conductor's CLOCK; extrapolated at its last rate when the conductor falls silent.
//
// Each CLOCK carries a simulation time and a rate, and is received after an unknown delay. The best estimate
// of the offset between the clocks is therefore the smallest one of the last second:
//
//   offset = min(steady - utime / rate),    simulation time = (steady - offset) rate
//
// Anybody may publish CLOCK. A session is accepted when two of its CLOCKs agree: the second shows the time
// expected from the first, within kLeap behind and kLeapAhead ahead (of simulated or steady time, whichever
// is longer). It stays accepted until no CLOCK as expected has come from it for kSilence. Until then CLOCKs
// of other sessions, and CLOCKs of its own that leap or change the rate, are not used; they are counted as
// refused once the session is heard again. Within a session numbers and times rise, so a repeated old CLOCK
// changes nothing. A restarted conductor continues from the time of the other processes, which extrapolate
// until they accept it.
class ConductorTime : public TimeSource {
 public:
  static constexpr SimDuration kSilence = SimDuration::from_milliseconds(3000);
  // A forward step of the time cannot be undone, so the tolerance ahead is small.
  static constexpr SimDuration kLeap = SimDuration::from_milliseconds(60'000),
                               kLeapAhead = SimDuration::from_milliseconds(5'000);

  ConductorTime(lcm::LCM& lcm, const std::string& process_name);
  std::optional<SimTime> now(SimTime steady) override;
  SimTime steady_at(SimTime sim) const override;
  [[nodiscard]] bool restarted() override { return std::exchange(restarted_, false); }
  std::int64_t num_refused() const override { return bus_.counters().duplicate_publishers; }
  const Subscriptions* receives() const override { return &bus_.receives(); }

  // Processes a CLOCK that was received at `received` (steady).
  void on_clock(const sim_clock_t& clock, SimTime received);

 private:
  struct Sample {
    SimTime received;  // steady
    double offset_s;   // received - utime / rate, s
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
  // Returns when the current message was received (steady). The delay is bounded, as the wall clock may have
  // been set meanwhile.
  SimTime received() const;

  Bus bus_;
  SilenceWarning silence_;
  double rate_ = 0;
  std::optional<Heard> last_;                    // last CLOCK of the accepted session
  std::deque<Heard> witnesses_;                  // latest CLOCK of each session, not confirmed yet
  std::int64_t num_others_ = 0, num_leaps_ = 0;  // CLOCKs of other sessions, and leaps, since last_
  std::deque<Sample> samples_;
  std::optional<SimTime> paused_at_;
  SimTime latest_ = SimTime::at_once();
  bool restarted_ = false;
};

// Time from the highest utime received in a STATE or SEND: for a lone channel server next to a replayed log.
// It stands still between messages. A utime more than ten seconds before the highest one means that a log was
// restarted.
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

// Simulation time is the wall clock's Unix time: for a lone channel server next to real vehicles that use it
// for their time stamps.
class WallTime : public TimeSource {
 public:
  // `utime_at_start`: Unix time at steady time 0, us.
  explicit WallTime(std::int64_t utime_at_start) : start_(SimTime::from_utime(utime_at_start)) {}
  std::optional<SimTime> now(SimTime steady) override { return start_ + (steady - SimTime()); }
  SimTime steady_at(SimTime sim) const override {
    return sim == SimTime::never() || sim == SimTime::at_once() ? sim : SimTime() + (sim - start_);
  }

 private:
  SimTime start_;
};

// kLockstep has no TimeSource: the process takes turns that the conductor grants (lockstep_process.h).
enum class TimeSourceKind { kConductor, kMessages, kWall, kLockstep };
// Accepts "conductor", "messages", "wall" or "lockstep"; throws InvalidArgument that lists them otherwise.
TimeSourceKind time_source_from_name(std::string_view name);
// Makes the time source of process `name` on a bus that loses datagrams. `wall_at_start`: Unix time at steady
// time 0. kLockstep gives the same as kWall.
std::unique_ptr<TimeSource> make_time_source(TimeSourceKind kind, lcm::LCM& lcm, const std::string& name,
                                             SimTime wall_at_start);

}  // namespace halocline::bus
