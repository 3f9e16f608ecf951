// Hears STATE and SENSORS of the vehicles that have a mission, and publishes their COMMAND on the time grid.
//
// Position and attitude come from STATE (the vehicle knows where it is), speed through the water and altitude
// from SENSORS where a vehicle publishes it. A vehicle whose state is older than the time-out gets no
// commands, and so falls into its safe state.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/node.h"
#include "clients/autopilot/autopilot_config.h"

namespace halocline::clients {

class AutopilotNode : public bus::Node {
 public:
  // Pilots the vehicles of `config` that have waypoints. Throws InvalidArgument when config.only_vehicle is
  // none of them.
  AutopilotNode(lcm::LCM& lcm, bus::NodeIdentity identity, const AutopilotConfig& config);

 protected:
  bus::Due on_due() const override;
  void on_step(const bus::Now& now) override;
  void on_restart(const bus::Now& now) override;
  std::string status_text() const override;

 private:
  struct Pilot {
    PilotConfig config;
    std::optional<vehicle_state_t> state;
    std::optional<vehicle_sensors_t> sensors;
    std::optional<Progress> progress;
    Integrals integrals;
    HoverIntegrals hover_integrals;
    std::int64_t sequence = 0;
  };

  void add_pilot(const PilotConfig& config);
  bool is_fresh(std::int64_t utime, SimTime now) const;
  void steer(Pilot& pilot, SimTime instant);
  vehicle_command_t steer_with_thrusters(Pilot& pilot, const SetPoints& points) const;
  void report_progress(const Pilot& pilot, const Progress& before);

  SimDuration period_, state_timeout_;
  SimTime next_command_;
  std::vector<std::unique_ptr<Pilot>> pilots_;  // in the scenario's order; handlers hold their addresses
};

}  // namespace halocline::clients
