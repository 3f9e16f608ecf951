// A vehicle run along a table of commands and written as a table of states: `halocline vehicle replay`.
//
// Columns written: t (s), x_n y_e z_d (m, NED of the body's origin), phi theta psi (rad), u v w (m/s) and
// p q r (rad/s) (body, over ground), cmd_rudder cmd_stern cmd_rpm and act_rudder act_stern act_rpm (rad,
// rpm), then for each thruster of the model cmd_thruster_<i>_rpm and act_thruster_<i>_rpm. Twelve digits. A
// command stands in the row of the instant from which it holds, as given. psi counts whole turns on unless it
// is wrapped to -pi to pi. The water has no surface and no bottom.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "vehicle_sim/dynamics/open_loop.h"

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
};

// The schedule in a CSV table; its columns as in --help. Throws InvalidArgument with all that is wrong.
std::vector<vehicle_sim::ScheduledCommand> read_schedule(std::istream& in,
                                                         const std::string& name_for_errors);

// Writes the table; `thrusters`: how many the model has.
void write_samples(std::ostream& out, const std::vector<vehicle_sim::OpenLoopSample>& samples,
                   std::size_t thrusters, bool wrap_yaw);

// All of it: reads, runs and writes. Returns the exit code; throws InvalidArgument for what the user got wrong.
[[nodiscard]] int replay_vehicle(const VehicleReplay& replay);

}  // namespace halocline::clients
