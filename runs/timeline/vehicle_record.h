// SPDX-License-Identifier: BSD-3-Clause
// Record of one vehicle over time: its states, commands, measurements, estimates, plans and faults.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bus/messages/messages.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "runs/timeline/timed_series.h"

namespace halocline::clients {

// Position (NED, m), attitude (rad) and speed of a vehicle at an instant.
struct TrackPoint {
  Vec3 position_ned_m = Vec3::Zero();
  EulerAngles attitude;
  double speed_mps = 0;  // horizontally, over ground
};

using Track = TimedSeries<TrackPoint>;

TrackPoint track_point_of(const vehicle_state_t& state);

// State of a vehicle at an instant, interpolated or held.
struct TrackState {
  TrackPoint point;
  SimDuration age;  // time since the last state at or before that instant; 0 between two states
};

// Returns the state at an instant. Between two states position and speed are interpolated linearly, and
// angles along the shorter arc. After the last state it is held and ages. Empty before the first state.
std::optional<TrackState> state_at(const Track& track, SimTime at);

// Returns at most `max_points` of the track, for drawing it from above and from the side: the extremes of
// north, east and depth remain (timed_series.h).
std::vector<Timed<TrackPoint>> decimated_track(const Track& track, SimTime from, SimTime to,
                                               std::size_t max_points);

struct VehicleRecord {
  std::size_t index = 0;  // position in the list of vehicles, in the order of their first message
  std::string name;       // the id as text while only that is known
  std::int32_t id = 0;    // 0: unknown
  std::optional<scenario_vehicle_t> described;  // entry in SCENARIO: model, start, modem
  std::optional<modem_config_t> modem;          // last one published; empty: the scenario's holds
  Track track;
  TimedSeries<vehicle_command_t> commands;
  TimedSeries<vehicle_sensors_t> sensors;
  TimedSeries<position_estimate_t> estimates;
  TimedSeries<vehicle_gps_t> gps;
  TimedSeries<autopilot_status_t> activity;
  TimedSeries<vehicle_plan_t> plans;  // one entry for each change
  // Faults in the order of their messages; several may start at one instant.
  std::vector<Timed<vehicle_fault_t>> faults;

  // Returns the plan that holds at that time; null when none is known.
  const vehicle_plan_t* plan_at(SimTime at) const;
  // True when the scenario fixes the vehicle in place, or its track stays within 1 cm of its first point.
  bool is_at_rest() const;
  // Returns the length of the track, horizontally, m.
  double distance_m() const;
};

}  // namespace halocline::clients
