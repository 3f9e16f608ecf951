// SPDX-License-Identifier: BSD-3-Clause
// Clocks of the vehicles: the time each shows at an instant t of simulation time.
//
// Model. A clock that was never set shows t + e(t),
//
//   e(t) = offset + drift t + W(t)
//
// where W is a random walk of its phase (white frequency noise, which dominates in quartz clocks over
// minutes) whose standard deviation after t seconds is random_walk sqrt(t) (Allan 1987, Time and frequency
// characterization). A GPS fix measured at u sets the clock to simulation time at s = u + fix_lag, except for
// a residual r. From s on, until the next fix,
//
//   e(t) = r + drift (t - s) + W(t) - W(s),   r normal with standard deviation gps_residual
//
// A fix sets only the phase; the drift continues. The lag is that of states (state_history.h): it is longer
// than the delay of a message, so no clock depends on which datagram was faster.
//
// Every value is a function of (seed, vehicle, instants of its fixes, t) because random numbers are drawn by
// address: it is the same in two servers and for any order of calls. Left out: temperature, ageing, and
// disciplining of the frequency by GPS. A vehicle without a clock of its own shows simulation time. Not
// thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "channel_server/vehicles/schedule.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/gauss_markov.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

struct ClockSettings {
  double offset_s = 0;           // ahead of simulation time at time 0, -1e5..1e5
  double drift = 0;              // seconds gained per second, -1e-3..1e-3
  double random_walk = 0;        // s/sqrt(s), 0..1e-3
  bool is_set_by_gps = true;     // set by the vehicle's own GPS fixes
  double gps_residual_s = 1e-6;  // standard deviation, 0..1; our choice: a message's microsecond
  bool operator==(const ClockSettings&) const = default;
};

// Clock of one vehicle, which is given by its name and id.
struct ClockOf {
  std::string vehicle;
  VehicleId id = 0;
  ClockSettings settings;
};

class VehicleClocks {
 public:
  // Limit for one vehicle; beyond it the oldest fixes are dropped.
  static constexpr std::size_t kMaxFixes = 4096;

  VehicleClocks() = default;  // no vehicle has a clock of its own
  VehicleClocks(const std::vector<ClockOf>& clocks, std::uint64_t seed, SimDuration fix_lag);

  bool need_fixes() const;
  // Adds a GPS fix of the vehicle, measured at `at`, in any order. No effect on a clock that GPS does not
  // set.
  void add_fix(std::string_view vehicle, SimTime at);
  // Returns the time that the vehicle's clock shows at `at`, minus `at`, s.
  double error_s(VehicleId id, SimTime at) const;

  // Drops fixes that no instant at or after `time` needs.
  void forget_before(SimTime time);

 private:
  struct Clock {
    std::string vehicle;
    ClockSettings settings;
    GaussMarkovProcess walk;
    Schedule<std::optional<SimTime>> fix{std::nullopt, kMaxFixes};  // the latest fix
  };
  double residual_s(VehicleId id, const Clock& clock, SimTime fix) const;

  std::map<VehicleId, Clock> clocks_;
  std::uint64_t seed_ = 0;
  SimDuration fix_lag_;
};

}  // namespace halocline::channel_server
