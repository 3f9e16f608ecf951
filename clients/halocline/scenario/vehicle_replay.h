// SPDX-License-Identifier: BSD-3-Clause
// A vehicle run along a table of commands and written as a table of states: `halocline vehicle replay`.
//
// Columns written: t (s), x_n y_e z_d (m, NED of the body's origin), phi theta psi (rad), u v w (m/s) and
// p q r (rad/s) (body, over ground), cmd_rudder cmd_stern cmd_rpm and act_rudder act_stern act_rpm (rad,
// rpm), then for each thruster of the model cmd_thruster_<i>_rpm and act_thruster_<i>_rpm, of a buoyancy
// engine cmd_buoyancy_m3 and act_buoyancy_m3, of a moving mass cmd_moving_mass_m and act_moving_mass_m, of a
// drop weight weight_released (0 or 1). Twelve digits. A command stands in the row of the instant from which
// it holds, as given. psi counts whole turns on unless it is wrapped to -pi to pi. The water has no bottom,
// and a
// surface, at rest, where one is given.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "vehicle_sim/dynamics/open_loop.h"
#include "vehicle_sim/dynamics/vehicle_model.h"

namespace halocline::clients {

// Degrees, rpm and seconds as on the command line.
struct VehicleReplay {
  std::string model, commands, out;
  double duration_s = 0, step_ms = 10, sample_s = 1;
  bool hold_to_limits = false, wrap_yaw = false;
  std::vector<double> position_ned_m{0, 0, 0}, velocity_body_mps{0, 0, 0}, rates_body_radps{0, 0, 0};
  double heel_deg = 0, pitch_deg = 0, heading_deg = 0;
  bool velocity_through_water = false;
  double current_mps = 0, current_toward_deg = 0;
  std::string current_treatment;  // empty: the model's
  double buoyancy_over_weight = 1;
  std::optional<double> sea_surface_z_m;  // empty: no surface
};

// The schedule in a CSV table; its columns as in --help. Throws InvalidArgument with all that is wrong.
std::vector<vehicle_sim::ScheduledCommand> read_schedule(std::istream& in,
                                                         const std::string& name_for_errors);

// Writes the table, with columns for the actuators that the model has.
void write_samples(std::ostream& out, const std::vector<vehicle_sim::OpenLoopSample>& samples,
                   const vehicle_sim::ModelParameters& model, bool wrap_yaw);

// All of it: reads, runs and writes. Returns the exit code; throws InvalidArgument for what the user got
// wrong.
[[nodiscard]] int replay_vehicle(const VehicleReplay& replay);

}  // namespace halocline::clients
