// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <memory>
#include <string>

#include "halocline/commands.h"
#include "runs/analysis/run_files.h"
#include "simulation/vehicle_replay.h"
#include "vehicle_sim/model_config.h"
#include "vehicle_sim/model_library.h"

namespace halocline::clients {
namespace {

int list_models() {
  for (const std::string& name : vehicle_sim::built_in_models()) {
    std::cout << name << ": " << vehicle_sim::purpose_of_model(name) << "\n";
  }
  return kDone;
}

int show_model(const std::string& model) {
  std::cout << vehicle_sim::model_toml(vehicle_sim::load_model(model));
  return kDone;
}

void add_start_options(CLI::App* command, VehicleReplay& r) {
  command->add_option("--position-ned-m", r.position_ned_m, "start: north, east, down")->expected(3);
  command->add_option("--heel-deg", r.heel_deg, "start: roll, starboard down");
  command->add_option("--pitch-deg", r.pitch_deg, "start: nose up");
  command->add_option("--heading-deg", r.heading_deg, "start: clockwise from north");
  command->add_option("--velocity-body-mps", r.velocity_body_mps, "start: u v w")->expected(3);
  command->add_option("--rates-body-radps", r.rates_body_radps, "start: p q r")->expected(3);
  command->add_flag("--through-water", r.velocity_through_water,
                    "the velocity at the start is relative to the water, not over ground");
}

void add_water_options(CLI::App* command, VehicleReplay& r) {
  command->add_option("--current-mps", r.current_mps, "speed of a steady current, 0 to 10")
      ->check(CLI::Range(0., 10.));
  command->add_option("--current-toward-deg", r.current_toward_deg,
                      "where it flows to, clockwise from north");
  command
      ->add_option("--current-treatment", r.current_treatment,
                   "upstream: as published with remus100-pvs; galilean: exactly; default: the model's")
      ->check(CLI::IsMember({"upstream", "galilean"}));
  command->add_option("--sea-surface-z-m", r.sea_surface_z_m,
                      "a surface at rest, 0 for that of the datum; default: water without one");
  command
      ->add_option("--buoyancy-over-weight", r.buoyancy_over_weight, "times the model's buoyancy, 0.5 to 2")
      ->check(CLI::Range(0.5, 2.0));
}

void add_replay(CLI::App* parent, int& exit_code) {
  auto r = std::make_shared<VehicleReplay>();
  CLI::App* command =
      parent->add_subcommand("replay", "Run a vehicle along a schedule of commands, and sample it");
  command->add_option("--model", r->model, "built-in name or file .toml")->required();
  command->add_option(
      "--commands", r->commands,
      "CSV: t_s, propeller_rpm, rudder_deg, stern_plane_deg, thruster_1_rpm to thruster_4_rpm, buoyancy_m3, "
      "moving_mass_m, release_weight (1 drops it); each row holds until the next, absent columns are 0; "
      "none: all at 0");
  command->add_option("--duration-s", r->duration_s, "of the run")->required()->check(CLI::Range(0., 1e6));
  command->add_option("--step-ms", r->step_ms, "of the integration, 0.1 to 20")->check(CLI::Range(0.1, 20.));
  command->add_option("--sample-s", r->sample_s, "between rows of the result")->check(CLI::Range(1e-3, 1e6));
  command->add_option("--out", r->out, "CSV to write; default or -: stdout");
  command->add_flag(
      "--hold-to-limits", r->hold_to_limits,
      "hold commands to the vehicle's limits, as the simulator does; without it they act as given");
  command->add_flag("--wrap-yaw", r->wrap_yaw, "write psi within -pi to pi instead of counting turns");
  add_start_options(command, *r);
  add_water_options(command, *r);
  command->footer(
      footer("  halocline vehicle replay --model remus100-pvs --commands turn.csv --duration-s 210"));
  auto force = std::make_shared<bool>(false);
  add_force_option(*command, *force);
  command->callback([r, force, &exit_code] {
    require_free({{r->out}, *force}, {r->commands});
    exit_code = replay_vehicle(*r);
  });
}

}  // namespace

void add_vehicle_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "vehicle", "Vehicle models: list them, show their parameters, run them along commands");
  command->require_subcommand(1);
  command->footer(footer("  halocline vehicle show torpedo"));
  CLI::App* list = command->add_subcommand("list", "Name the built-in models");
  list->footer(footer("  halocline vehicle list"));
  list->callback([&exit_code] { exit_code = list_models(); });
  auto model = std::make_shared<std::string>();
  CLI::App* show = command->add_subcommand("show", "Print a model's parameters as a file");
  show->add_option("model", *model, "built-in name or file .toml")->required();
  show->footer(footer("  halocline vehicle show hover > my-hover.toml"));
  show->callback([model, &exit_code] { exit_code = show_model(*model); });
  add_replay(command, exit_code);
}

}  // namespace halocline::clients
