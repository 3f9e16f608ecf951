// SPDX-License-Identifier: BSD-3-Clause
// Time as vehicles know it: what their clocks show at an instant of simulation time, and when they will show
// a time.
//
// A program that acts for a vehicle keeps its schedules and deadlines in the vehicle's own time, and turns
// them into simulation time where it says when it is due and when a packet starts. A vehicle without a clock
// of its own shows simulation time, to the last bit. The clocks are those of the channel server
// (channel_server/vehicles/vehicle_clocks.h): the same draws, set by the same GPS fixes after the same lag,
// so that all programs agree on what a clock shows.
#pragma once

#include <cstdint>
#include <deque>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "bus/bus.h"
#include "channel_server/vehicles/vehicle_clocks.h"
#include "clients/clocks/clock_set_config.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::clients {

class VehicleTime {
 public:
  // Subscribes to the fixes that set clocks. A member of a node, made with its bus.
  VehicleTime(bus::Bus& bus, const ClockSetConfig& config);
  VehicleTime(const VehicleTime&) = delete;
  VehicleTime& operator=(const VehicleTime&) = delete;

  // True where the vehicle's time is another than simulation time.
  bool has_clock(std::int32_t vehicle_id) const { return owners_.contains(vehicle_id); }
  // The reading of the vehicle's clock at the instant `at`.
  SimTime shown(std::int32_t vehicle_id, SimTime at) const;
  // The first instant, not before the latest set_now(), at which it shows `shown` or more: a whole
  // microsecond, late by what its random walk gains meanwhile at most. never() and at_once() stay as they
  // are.
  SimTime due(std::int32_t vehicle_id, SimTime shown) const;
  // The instant that an action due at `shown`, and done at `now`, stands for.
  SimTime instant_of(std::int32_t vehicle_id, SimTime shown, SimTime now) const;

  // Sets the instant of the node's step.
  void set_now(SimTime now) { now_ = now; }
  // Forgets the fixes: another run has begun.
  void restart(SimTime now);
  // Passes the fixes that later instants need.
  void archive(Archive& a);

 private:
  using Fix = std::pair<std::string, std::int64_t>;  // of a vehicle, microseconds
  void add_fix(std::string_view vehicle, std::int64_t utime);

  channel_server::VehicleClocks clocks_;
  SimDuration fix_lag_;
  std::set<std::int32_t> owners_;  // ids of the vehicles with a clock of their own
  std::deque<Fix> fixes_;
  SimTime now_;
};

}  // namespace halocline::clients
