// SPDX-License-Identifier: BSD-3-Clause
// Checks that each vehicle model has the actuators that its pilot uses, and holds the set speeds.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "bus/config/config.h"
#include "clients/onboard/autopilot/autopilot_config.h"
#include "clients/onboard/autopilot/plan.h"
#include "core/csv_table.h"
#include "simulation/composition.h"
#include "simulation/scenario_checks.h"
#include "simulation/speed_trial.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/fleet.h"
#include "vehicle_sim/vehicle_sim_config.h"

namespace halocline::clients {
namespace {

// Checks set speeds by trials; vehicles of the same kind share a trial.
class SpeedJudge {
 public:
  SpeedJudge(const ScenarioConfig& config, bus::ConfigFile& file) : config_(config), file_(file) {}

  void check(std::size_t i, const vehicle_sim::Model& model) {
    const PilotConfig& pilot = config_.autopilot.vehicles.at(i);
    bool uses_mission_speed = pilot.behaviours.empty();
    for (std::size_t k = 0; k < pilot.behaviours.size(); ++k) {
      const double speed = pilot.behaviours[k].speed_mps;
      uses_mission_speed = uses_mission_speed || speed <= 0;
      if (speed > 0)
        check(key_of(i, "mission.behaviour." + std::to_string(k) + ".speed_mps"), speed, model, pilot);
    }
    if (uses_mission_speed) check(key_of(i, "mission.speed_mps"), pilot.mission.speed_mps, model, pilot);
  }

 private:
  void check(const std::string& key, double speed_mps, const vehicle_sim::Model& model,
             const PilotConfig& pilot) {
    const double held = held_speed(speed_mps, model, pilot);
    if (held < speed_mps)
      file_.refuse(key, format_number(speed_mps),
                   "allowed is at most " + format_number(rounded_down(held)) + " m/s, which " + model.name() +
                       " holds at its depth in still water");
  }

  // Returns the set speed when it is held, otherwise the greatest speed below it that is held, by bisection.
  double held_speed(double speed_mps, const vehicle_sim::Model& model, const PilotConfig& pilot) {
    const auto bytes_of = [](const auto& gains) {
      return std::string(reinterpret_cast<const char*>(&gains), sizeof gains);
    };
    const bool by_thrusters = pilot.steering == Steering::kThrusters;
    const auto [known, is_new] = held_.try_emplace(
        {&model, speed_mps, by_thrusters ? bytes_of(pilot.hover_gains) : bytes_of(pilot.gains)}, speed_mps);
    if (!is_new || holds(speed_mps, model, pilot)) return known->second;
    constexpr int kHalvings = 8;
    double held = 0, not_held = speed_mps;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (held + not_held);
      (holds(middle, model, pilot) ? held : not_held) = middle;
    }
    return known->second = held;
  }

  bool holds(double speed_mps, const vehicle_sim::Model& model, const PilotConfig& pilot) const {
    constexpr double kSlower = 0.05, kFarthestOff_m = 1;
    const SpeedTrial trial = try_speed(model, pilot, config_.autopilot.command_period, speed_mps);
    const bool keeps_depth = pilot.steering == Steering::kFins || trial.depth_error_m < kFarthestOff_m;
    return keeps_depth && trial.speed_mps > (1 - kSlower) * speed_mps;
  }

  const ScenarioConfig& config_;
  bus::ConfigFile& file_;
  std::map<std::tuple<const vehicle_sim::Model*, double, std::string>, double> held_;
};

const char* to_text(Steering steering) {
  return steering == Steering::kFins ? "fins" : steering == Steering::kThrusters ? "thrusters" : "buoyancy";
}

// Returns the kinds of steering that a model supports.
std::vector<Steering> steerings_of(const vehicle_sim::ModelParameters& model) {
  constexpr std::size_t kHorizontal = 2;  // the fewest thrusters that steer on the surface
  const bool has_thrusters = model.thrusters.size() == vehicle_sim::kMaxThrusters ||
                             (!model.floats.empty() && model.thrusters.size() >= kHorizontal);
  std::vector<Steering> all;
  if (model.propeller.diameter_m > 0 && model.rudder.area_m2 > 0 && model.stern_planes.area_m2 > 0)
    all.push_back(Steering::kFins);
  if (has_thrusters) all.push_back(Steering::kThrusters);
  if (model.buoyancy_engine.pump.limit > 0 || model.drop_weight.mass_kg > 0)
    all.push_back(Steering::kBuoyancy);
  return all;
}

// Returns a reason why the model cannot be steered this way; empty when it can.
std::string lacking(const vehicle_sim::ModelParameters& model, Steering steering) {
  const std::vector<Steering> all = steerings_of(model);
  if (std::find(all.begin(), all.end(), steering) != all.end()) return "";
  std::string allowed;
  for (const Steering other : all)
    allowed += (allowed.empty() ? "\"" : " or \"") + std::string(to_text(other)) + "\"";
  const std::string lack = steering == Steering::kFins ? " has no propeller, rudder and stern planes"
                           : steering == Steering::kThrusters
                               ? " has no thrusters to steer by: four, or two where it floats on the surface"
                               : " has no buoyancy engine and no drop weight";
  return lack + "; allowed for it is " + (allowed.empty() ? "neither: it cannot be piloted" : allowed);
}

// Refuses behaviours other than waiting for a vehicle without a buoyancy engine: it can only wait before it
// surfaces.
void check_glide(std::size_t i, const vehicle_sim::ModelParameters& model, const PilotConfig& pilot,
                 bus::ConfigFile& file) {
  if (model.buoyancy_engine.pump.limit > 0) return;
  for (std::size_t k = 0; k < pilot.behaviours.size(); ++k) {
    if (pilot.behaviours[k].kind == BehaviourKind::kWait) continue;
    file.refuse(key_of(i, "mission.behaviour." + std::to_string(k) + ".kind"), "",
                "the model " + model.name + " has no buoyancy engine; allowed for it is \"wait\"");
  }
  if (pilot.behaviours.empty())
    file.refuse(key_of(i, "mission.waypoints"), "",
                "the model " + model.name +
                    " has no buoyancy engine; allowed for it are behaviours of kind \"wait\"");
}

}  // namespace

void check_pilots(const ScenarioConfig& config, bus::ConfigFile& file) {
  const auto members = vehicle_sim::members_of(config.scenario, config.vehicle_sim);
  SpeedJudge judge(config, file);
  std::size_t member = 0;
  for (std::size_t i = 0; i < config.scenario.vehicles.size(); ++i) {
    if (config.scenario.vehicles[i].model == "external") continue;
    const std::shared_ptr<const vehicle_sim::Model> model = members.at(member++).model;
    const PilotConfig& pilot = config.autopilot.vehicles.at(i);
    if (!model || !pilot.is_piloted()) continue;
    const std::string lack = lacking(model->parameters(), pilot.steering);
    if (!lack.empty()) {
      file.refuse(key_of(i, "mission.steering"), to_text(pilot.steering),
                  "the model " + model->name() + lack);
    } else if (pilot.steering == Steering::kBuoyancy) {
      check_glide(i, model->parameters(), pilot, file);
    } else {
      judge.check(i, *model);
    }
  }
}

}  // namespace halocline::clients
