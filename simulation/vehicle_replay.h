// SPDX-License-Identifier: BSD-3-Clause
// Open-loop run of a vehicle along a table of commands, written as a table of states: `halocline vehicle
// replay`.
//
// Columns written, with twelve digits:
//
//   t                               s
//   x_n y_e z_d                     m, NED, of the body's origin
//   phi theta psi                   rad
//   u v w                           m/s, body axes, over ground
//   p q r                           rad/s, body axes
//   cmd_rudder cmd_stern cmd_rpm    rad, rad, rpm: as commanded
//   act_rudder act_stern act_rpm    rad, rad, rpm: actual
//   cmd_thruster_<i>_rpm            for each thruster of the model; as commanded
//   act_thruster_<i>_rpm            actual
//   cmd_buoyancy_m3                 for a model with a buoyancy engine; as commanded
//   act_buoyancy_m3                 actual
//   cmd_moving_mass_m               for a model with a moving mass; as commanded
//   act_moving_mass_m               actual
//   weight_released                 for a model with a drop weight: 0 or 1
//
// A command is written in the row of the instant from which it holds, as given. psi accumulates whole turns
// unless it is wrapped to -pi to pi. The water is bottomless and at rest, with a surface if one is given.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "vehicle_sim/dynamics/open_loop.h"
#include "vehicle_sim/dynamics/vehicle_model.h"

namespace halocline::clients {

// Options of the replay in degrees, rpm and seconds, as on the command line.
struct VehicleReplay {
  std::string model, commands, out;
  double duration_s = 0, step_ms = 10, sample_s = 1;
  bool hold_to_limits = false, wrap_yaw = false;
  std::vector<double> position_ned_m{0, 0, 0}, velocity_body_mps{0, 0, 0}, rates_body_radps{0, 0, 0};
  double heel_deg = 0, pitch_deg = 0, heading_deg = 0;
  bool velocity_through_water = false;
  double current_mps = 0, current_toward_deg = 0;
  std::string current_treatment;  // empty: as in the model
  double buoyancy_over_weight = 1;
  std::optional<double> sea_surface_z_m;  // empty: no surface
};

// Reads the schedule from a CSV table with the columns described in --help. Throws InvalidArgument with
// everything that is wrong.
std::vector<vehicle_sim::ScheduledCommand> read_schedule(std::istream& in,
                                                         const std::string& name_for_errors);

// Writes the table, with columns for the actuators that the model has.
void write_samples(std::ostream& out, const std::vector<vehicle_sim::OpenLoopSample>& samples,
                   const vehicle_sim::ModelParameters& model, bool wrap_yaw);

// Reads the schedule, runs the vehicle and writes the table. Returns the exit code; throws InvalidArgument
// for errors of the user.
[[nodiscard]] int replay_vehicle(const VehicleReplay& replay);

}  // namespace halocline::clients
