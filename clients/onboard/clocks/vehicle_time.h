// SPDX-License-Identifier: BSD-3-Clause
// Time of the vehicles' own clocks: their readings at a simulation time, and when they will show a reading.
//
// A program that acts for a vehicle keeps its schedules and deadlines in the vehicle's own time. It converts
// them to simulation time when it states when it is due and when a packet starts. A vehicle without a clock
// of its own shows simulation time, exactly. The clocks are those of the channel server
// (channel_server/vehicles/vehicle_clocks.h): the same random draws, set by the same GPS fixes after the same
// lag, so that all programs agree on a clock's reading.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "bus/bus.h"
#include "channel_server/vehicles/vehicle_clocks.h"
#include "clients/onboard/clocks/clock_set_config.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::clients {

class VehicleTime {
 public:
  // Subscribes to the fixes that set clocks. An object of this class is a member of a node and is made with
  // its bus.
  VehicleTime(bus::Bus& bus, const ClockSetConfig& config);
  VehicleTime(const VehicleTime&) = delete;
  VehicleTime& operator=(const VehicleTime&) = delete;

  // Returns true when the vehicle's time differs from simulation time.
  bool has_clock(std::int32_t vehicle_id) const { return owners_.contains(vehicle_id); }
  SimTime shown(std::int32_t vehicle_id, SimTime at) const;
  // Returns the first simulation time, not before the latest set_now(), at which the clock shows `shown` or
  // more. It is a whole microsecond, and is late by at most what the clock's random walk gains meanwhile.
  // never() and at_once() are returned unchanged.
  SimTime due(std::int32_t vehicle_id, SimTime shown) const;
  // Returns the nominal simulation time of an action that was due at the reading `shown` and is done at
  // `now`.
  SimTime instant_of(std::int32_t vehicle_id, SimTime shown, SimTime now) const;

  // Returns by how much fixes set the clock after `from`, up to and including `to`; negative for back.
  SimDuration set_by(std::int32_t vehicle_id, SimTime from, SimTime to) const;
  // Returns the first instant after the latest set_now() at which a fix that was received sets the clock;
  // never() without one.
  SimTime next_set(std::int32_t vehicle_id) const;

  // Sets the simulation time of the node's step.
  void set_now(SimTime now) { now_ = now; }
  // Forgets the fixes, because another run has begun.
  void restart(SimTime now);
  // Saves or loads the fixes on which later readings depend.
  void archive(Archive& a);

 private:
  void add_fix(std::int32_t vehicle_id, SimTime fix);
  // Returns the instants at which fixes kept set the clock; empty for a vehicle without any.
  const std::set<SimTime>& sets_of(std::int32_t vehicle_id) const;

  ClockSetConfig config_;
  channel_server::VehicleClocks clocks_;
  std::map<std::int32_t, std::string> owners_;      // vehicles with a clock of their own: name by id
  std::map<std::int32_t, std::set<SimTime>> sets_;  // instants at which fixes kept set a vehicle's clock
  SimTime now_;
};

}  // namespace halocline::clients
