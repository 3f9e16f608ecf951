// Moves the vehicles of a scenario and speaks for them on the bus.
//
// Hears COMMAND.<vehicle>, SET_CURRENT and RAY_REPLY.<its own client name>; publishes STATE.<vehicle> and SENSORS.<vehicle> at
// multiples of their periods since time 0, stamped with that instant, and RAY_QUERY for the altitudes. A SENSORS
// waits for its altitude until the service answers or the node's patience (steady time) ends; then altitude is
// unavailable. A node that is started into a running simulation puts its vehicles where they start, at that time.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/node.h"
#include "vehicle_sim/altimeter_desk.h"
#include "vehicle_sim/fleet.h"
#include "vehicle_sim/vehicle_sim_config.h"

namespace halocline::vehicle_sim {

class VehicleSimNode : public bus::Node {
 public:
  // `seabed`: what the vehicles touch; null is no ground. `scenario` is copied.
  VehicleSimNode(lcm::LCM& lcm, bus::NodeIdentity identity, const bus::Scenario& scenario,
                 const VehicleSimConfig& config, std::shared_ptr<const Seabed> seabed);

 protected:
  bus::Due on_due() const override;
  void on_step(const bus::Now& now) override;
  void on_restart(const bus::Now& now) override;
  std::string status_text() const override;

 private:
  void on_command(std::size_t vehicle, const vehicle_command_t& message);
  void on_current(const current_change_t& message);
  void on_ray_reply(const ray_reply_t& reply);
  void begin(SimTime now);
  void publish_states(SimTime when);
  void measure_all(SimTime when, SimTime steady);
  void publish_sensors(SimTime steady);
  void report_lost();

  VehicleSimConfig config_;
  FleetSettings settings_;
  std::vector<FleetMember> members_;
  std::vector<std::int32_t> ids_;
  std::shared_ptr<const Seabed> seabed_;
  std::string ray_client_;

  std::optional<Fleet> fleet_;  // empty until the simulation time is known
  SimTime next_state_, next_sensors_;
  SimTime last_step_;  // steady
  AltimeterDesk desk_;
  std::int64_t ray_request_ = 0;
  std::vector<std::int64_t> state_sequence_, sensors_sequence_;
  std::vector<bool> reported_lost_;
};

}  // namespace halocline::vehicle_sim
