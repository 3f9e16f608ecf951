// SPDX-License-Identifier: BSD-3-Clause
// What is known of one vehicle by time: where it was, what it was commanded, what it measured and estimated.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bus/messages.h"
#include "clients/mission/timed_series.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::clients {

struct TrackPoint {
  Vec3 position_ned_m = Vec3::Zero();
  EulerAngles attitude;
  double speed_mps = 0;  // over ground, horizontally
};

using Track = TimedSeries<TrackPoint>;

TrackPoint track_point_of(const vehicle_state_t& state);

struct TrackState {
  TrackPoint point;
  SimDuration age;  // since the last state of that time or before; 0 between two states
};

// Where it was: between two states linear in position and speed, along the shorter arc in angles; after the
// last one it stays there and ages. Empty before the first.
std::optional<TrackState> state_at(const Track& track, SimTime at);

// At most `max_points` for drawing a track from above and from the side: north, east and depth keep their
// extremes (timed_series.h).
std::vector<Timed<TrackPoint>> decimated_track(const Track& track, SimTime from, SimTime to,
                                               std::size_t max_points);

struct MissionVehicle {
  std::size_t index = 0;  // among the vehicles of the mission, in the order in which they were met
  std::string name;       // its id as text where only that is known
  std::int32_t id = 0;    // 0: not known
  std::optional<scenario_vehicle_t> described;  // by SCENARIO: model, start, modem
  std::optional<modem_config_t> modem;          // the last one that it published; empty: the scenario's
  Track track;
  TimedSeries<vehicle_command_t> commands;
  TimedSeries<vehicle_sensors_t> sensors;
  TimedSeries<position_estimate_t> estimates;
  TimedSeries<vehicle_gps_t> gps;
  TimedSeries<autopilot_status_t> activity;
  TimedSeries<vehicle_plan_t> plans;           // at each change
  std::vector<Timed<vehicle_fault_t>> faults;  // as they came; several may hold from one instant on

  // The plan of that time; null where none is known.
  const vehicle_plan_t* plan_at(SimTime at) const;
  // The scenario has it fixed, or it has not moved by a centimetre.
  bool is_at_rest() const;
  // Metres along the track, horizontally.
  double distance_m() const;
};

}  // namespace halocline::clients
