// SPDX-License-Identifier: BSD-3-Clause
// The clocks of the vehicles: what each shows at an instant of simulation time.
//
// Model: a clock that was never set shows t + e(t),
//     e(t) = offset + drift t + W(t),
// W a random walk of its phase (white frequency noise, the common one of quartz over minutes), of which the
// standard deviation after t seconds is random_walk sqrt(t) (Allan 1987, Time and frequency
// characterization). A GPS fix measured at u sets it at s = u + fix_lag to simulation time, but for a
// residual: from s on
//     e(t) = r + drift (t - s) + W(t) - W(s),   r normal with gps_residual,
// until the next fix. A fix sets the phase alone; the drift goes on. The lag is that of states
// (state_history.h): longer than a message takes, so that no clock depends on which datagram was quicker.
//
// All is a function of (seed, vehicle, instants of its fixes, t), drawn by address: of two servers, or in any
// order of calls, the same. Left out: temperature, ageing, frequency that GPS disciplines. A vehicle without
// a clock of its own shows simulation time. Not thread-safe.
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
  double offset_s = 0;           // ahead of simulation time at 0, -1e5..1e5
  double drift = 0;              // seconds gained a second, -1e-3..1e-3
  double random_walk = 0;        // s/sqrt(s), 0..1e-3
  bool is_set_by_gps = true;     // by the vehicle's own fixes
  double gps_residual_s = 1e-6;  // standard deviation, 0..1; our choice: a message's microsecond
  bool operator==(const ClockSettings&) const = default;
};

// The clock of one vehicle, by its name and id.
struct ClockOf {
  std::string vehicle;
  VehicleId id = 0;
  ClockSettings settings;
};

class VehicleClocks {
 public:
  // Of one vehicle; the oldest make room.
  static constexpr std::size_t kMaxFixes = 4096;

  VehicleClocks() = default;  // nobody has one
  VehicleClocks(const std::vector<ClockOf>& clocks, std::uint64_t seed, SimDuration fix_lag);

  // Whether GPS sets any of them.
  bool need_fixes() const;
  // A GPS fix of the vehicle, measured at `at`, in any order; of one whose clock it does not set of no
  // effect.
  void add_fix(std::string_view vehicle, SimTime at);
  // What the vehicle's clock shows at `at`, less `at`, s.
  double error_s(VehicleId id, SimTime at) const;

  // Drops fixes that no instant at or after `time` needs.
  void forget_before(SimTime time);
  void clear();  // forgets all fixes

 private:
  struct Clock {
    std::string vehicle;
    ClockSettings settings;
    GaussMarkovProcess walk;
    Schedule<std::optional<SimTime>> fix{std::nullopt, kMaxFixes};  // the latest
  };
  double residual_s(VehicleId id, const Clock& clock, SimTime fix) const;

  std::map<VehicleId, Clock> clocks_;
  std::uint64_t seed_ = 0;
  SimDuration fix_lag_;
};

}  // namespace halocline::channel_server
