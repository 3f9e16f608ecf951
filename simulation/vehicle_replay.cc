// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/vehicle_replay.h"

#include <algorithm>
#include <fstream>
#include <iostream>
#include <sstream>

#include <fmt/ostream.h>

#include "core/check.h"
#include "core/csv_table.h"
#include "core/elementary.h"
#include "core/files/input_file.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "runs/analysis/run_files.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/model_config.h"

namespace halocline::clients {
namespace {

using vehicle_sim::ActuatorValues;
using vehicle_sim::ModelParameters;
using vehicle_sim::OpenLoopRun;
using vehicle_sim::OpenLoopSample;
using vehicle_sim::ScheduledCommand;
using vehicle_sim::VehicleState;

constexpr double kSecondsPerMinute = 60, kLongestRun_s = 1e6;

const std::vector<std::string>& command_columns() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list{"t_s", "propeller_rpm", "rudder_deg", "stern_plane_deg"};
    for (std::size_t i = 1; i <= vehicle_sim::kMaxThrusters; ++i)
      list.push_back("thruster_" + std::to_string(i) + "_rpm");
    list.insert(list.end(), {"buoyancy_m3", "moving_mass_m", "release_weight"});
    return list;
  }();
  return names;
}

// Converts the cells of a row, which are in the order of command_columns().
ScheduledCommand to_command(const std::vector<double>& cells) {
  ScheduledCommand command;
  command.from = SimTime::from_seconds(cells[0]);
  command.actuators.propeller_hz = cells[1] / kSecondsPerMinute;
  command.actuators.rudder_rad = to_radians(cells[2]);
  command.actuators.stern_planes_rad = to_radians(cells[3]);
  for (std::size_t i = 0; i < vehicle_sim::kMaxThrusters; ++i)
    command.actuators.thruster_hz[i] = cells[4 + i] / kSecondsPerMinute;
  constexpr std::size_t kNext = 4 + vehicle_sim::kMaxThrusters;
  command.actuators.buoyancy_m3 = cells[kNext];
  command.actuators.moving_mass_m = cells[kNext + 1];
  if (cells[kNext + 2] != 0) command.actuators.weight = vehicle_sim::DropWeightState::kReleased;
  return command;
}

void check_columns(const CsvTable& table, std::vector<std::string>& errors) {
  const auto& known = command_columns();
  for (const std::string& cell : table.header.cells) {
    if (std::find(known.begin(), known.end(), cell) == known.end())
      errors.push_back("column '" + cell + "' is unknown");
  }
  if (!table.column("t_s")) errors.emplace_back("there is no column t_s");
}

std::vector<double> numbers_of(const CsvTable& table, const CsvLine& row, std::vector<std::string>& errors) {
  std::vector<double> cells;
  for (const std::string& name : command_columns()) {
    const auto column = table.column(name);
    const auto number = column ? parse_number(row.cells[*column]) : 0;
    if (!number) errors.push_back("line " + std::to_string(row.number) + ": " + name + " is no number");
    cells.push_back(number.value_or(0));
  }
  if (cells[0] < 0 || cells[0] > kLongestRun_s)
    errors.push_back("line " + std::to_string(row.number) + ": t_s must be 0 to 1e6");
  return cells;
}

Vec3 vector_of(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

ModelParameters parameters_of(const VehicleReplay& r) {
  ModelParameters p = vehicle_sim::load_model(r.model).parameters;
  using vehicle_sim::CurrentTreatment;
  if (r.current_treatment == "upstream") p.current_treatment = CurrentTreatment::kUpstream;
  if (r.current_treatment == "galilean") p.current_treatment = CurrentTreatment::kGalilean;
  p.buoyancy_n *= r.buoyancy_over_weight;
  return r.hold_to_limits ? p : vehicle_sim::without_limits(p);
}

VehicleState start_of(const VehicleReplay& r, const Vec3& current_ned) {
  VehicleState s;
  s.position_ned_m = vector_of(r.position_ned_m);
  s.orientation = to_quaternion({to_radians(r.heel_deg), to_radians(r.pitch_deg), to_radians(r.heading_deg)});
  s.velocity_body << vector_of(r.velocity_body_mps), vector_of(r.rates_body_radps);
  if (r.velocity_through_water) s.velocity_body.head<3>() += s.orientation.conjugate() * current_ned;
  return s;
}

std::vector<ScheduledCommand> schedule_of(const VehicleReplay& r) {
  if (r.commands.empty()) return {};
  std::ifstream file = open_input(r.commands);
  return read_schedule(file, r.commands);
}

class RowWriter {
 public:
  explicit RowWriter(std::ostream& out) : out_(out) {}
  void number(double value) {
    fmt::print(out_, "{}{:.12g}", first_ ? "" : ",", value);
    first_ = false;
  }
  void numbers(const Eigen::Ref<const Eigen::VectorXd>& values) {
    for (const double value : values) number(value);
  }
  void actuators(const ActuatorValues& a) {
    number(a.rudder_rad);
    number(a.stern_planes_rad);
    number(a.propeller_hz * kSecondsPerMinute);
  }
  void end() {
    out_ << "\n";
    first_ = true;
  }

 private:
  std::ostream& out_;
  bool first_ = true;
};

// Writes the columns of further actuators: commanded and actual values of those that the model has.
void write_more_actuators(RowWriter& row, const OpenLoopSample& s, const ModelParameters& model) {
  const ActuatorValues &command = s.command, &actual = s.state.actuators;
  for (std::size_t i = 0; i < model.thrusters.size(); ++i) {
    row.number(command.thruster_hz[i] * kSecondsPerMinute);
    row.number(actual.thruster_hz[i] * kSecondsPerMinute);
  }
  if (model.buoyancy_engine.pump.limit > 0) {
    row.number(command.buoyancy_m3);
    row.number(actual.buoyancy_m3);
  }
  if (model.moving_mass.mass_kg > 0) {
    row.number(command.moving_mass_m);
    row.number(actual.moving_mass_m);
  }
  if (model.drop_weight.mass_kg > 0)
    row.number(actual.weight == vehicle_sim::DropWeightState::kReleased ? 1 : 0);
}

void write_names(std::ostream& out, const ModelParameters& model) {
  out << "t,x_n,y_e,z_d,phi,theta,psi,u,v,w,p,q,r,cmd_rudder,cmd_stern,cmd_rpm,act_rudder,act_stern,act_rpm";
  for (std::size_t i = 1; i <= model.thrusters.size(); ++i)
    out << ",cmd_thruster_" << i << "_rpm,act_thruster_" << i << "_rpm";
  if (model.buoyancy_engine.pump.limit > 0) out << ",cmd_buoyancy_m3,act_buoyancy_m3";
  if (model.moving_mass.mass_kg > 0) out << ",cmd_moving_mass_m,act_moving_mass_m";
  if (model.drop_weight.mass_kg > 0) out << ",weight_released";
  out << "\n";
}

void write_row(RowWriter& row, const OpenLoopSample& s, const ModelParameters& model, bool wrap_yaw) {
  const EulerAngles euler = to_euler(s.state.orientation);
  row.number(s.time.seconds());
  row.numbers(s.state.position_ned_m);
  row.numbers(Vec3(euler.roll, euler.pitch, wrap_yaw ? euler.yaw : s.yaw_unwrapped_rad));
  row.numbers(s.state.velocity_body);
  row.actuators(s.command);
  row.actuators(s.state.actuators);
  write_more_actuators(row, s, model);
  row.end();
}

}  // namespace

std::vector<ScheduledCommand> read_schedule(std::istream& in, const std::string& name_for_errors) {
  std::vector<std::string> errors;
  const CsvTable table = read_csv(in, errors);
  if (errors.empty()) check_columns(table, errors);
  std::vector<ScheduledCommand> schedule;
  for (const CsvLine& row : table.rows) {
    if (!errors.empty()) break;
    schedule.push_back(to_command(numbers_of(table, row, errors)));
    if (schedule.size() > 1 && !(schedule[schedule.size() - 2].from < schedule.back().from))
      errors.push_back("line " + std::to_string(row.number) + ": t_s must rise from row to row");
  }
  std::string text;
  for (const std::string& error : errors) text += (text.empty() ? "" : "\n") + name_for_errors + ": " + error;
  require(errors.empty(), text);
  return schedule;
}

void write_samples(std::ostream& out, const std::vector<OpenLoopSample>& samples,
                   const ModelParameters& model, bool wrap_yaw) {
  write_names(out, model);
  RowWriter row(out);
  for (const OpenLoopSample& sample : samples) write_row(row, sample, model, wrap_yaw);
}

int replay_vehicle(const VehicleReplay& r) {
  const double toward = to_radians(r.current_toward_deg);
  const Vec3 current = r.current_mps * Vec3(elementary::cos(toward), elementary::sin(toward), 0);
  OpenLoopRun run;
  run.start = start_of(r, current);
  run.schedule = schedule_of(r);
  run.water.current_ned_mps = current;
  if (r.sea_surface_z_m) run.water.sea_surface_z_m = *r.sea_surface_z_m;
  run.duration = SimDuration::from_seconds(r.duration_s);
  run.step = SimDuration::from_seconds(r.step_ms / 1000);
  run.sample_period = SimDuration::from_seconds(r.sample_s);
  const vehicle_sim::Model model(parameters_of(r));
  std::ostringstream text;
  write_samples(text, run_open_loop(model, run), model.parameters(), r.wrap_yaw);
  write_output(r.out, text.str());
  return 0;
}

}  // namespace halocline::clients
