// SPDX-License-Identifier: BSD-3-Clause
// Node of the vehicle simulator: moves the vehicles of a scenario and publishes their states and sensor
// readings.
//
// Bus channels:
//   in   COMMAND, FAULT, SET_CURRENT
//   in   RAY_REPLY.<own client name>   echoes
//   in   OUTCOME, RECEIVE              for vehicles with a USBL array
//   in   MODEM_ENERGY                  energy of packets, for vehicles with a battery
//   out  STATE                         at multiples of its period since time 0 when needed
//   (state_selection.h) out  SENSORS, DVL, GPS, SONAR      at multiples of their periods since time 0 out
//   USBL                          when a packet was received out  FAULT                         when a fault
//   of the scenario begins or ends, or a battery is empty out  BATTERY                       once a second,
//   for vehicles with a battery out  RAY_QUERY                     beams to the seabed
//
// Messages are stamped with the instant to which they apply. A measurement waits for its echoes until the
// service answers or the time-out (250 ms of steady time) passes; the echoes are then unavailable.
//
// A node that is started into a running simulation puts its vehicles at their starts at that time. A node
// that was killed and has a journal (Node::keep_state_in) continues from the state that it published last: it
// integrates over the time of its absence, with the last commands until they time out, and publishes only
// what is at most two seconds old.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/config/scenario.h"
#include "bus/messages/channel_family.h"
#include "bus/numbered_publisher.h"
#include "bus/runtime/node.h"
#include "bus/runtime/thread_pool.h"
#include "bus/transport/node_identity.h"
#include "core/archive.h"
#include "core/sim_time.h"
#include "vehicle_sim/faults.h"
#include "vehicle_sim/fleet.h"
#include "vehicle_sim/pending_echoes.h"
#include "vehicle_sim/sensor_station.h"
#include "vehicle_sim/sensors/usbl_fix_assembler.h"
#include "vehicle_sim/state_selection.h"
#include "vehicle_sim/vehicle_sim_config.h"
#include "vehicle_sim/world/seabed.h"

namespace halocline::vehicle_sim {

class VehicleSimNode : public bus::Node {
 public:
  // `seabed`: surface that the hulls touch; null: no seabed. `scenario` is copied.
  VehicleSimNode(lcm::LCM& lcm, bus::NodeIdentity identity, const bus::Scenario& scenario,
                 const VehicleSimConfig& config, std::shared_ptr<const Seabed> seabed);

 protected:
  bus::Due on_due() const override;
  void on_step(const bus::Now& now) override;
  void on_restart(const bus::Now& now) override;
  void on_archive(Archive& a) override;
  std::string status_text() const override;

 private:
  void on_command(std::size_t vehicle, const vehicle_command_t& message);
  void on_fault(std::size_t vehicle, const vehicle_fault_t& message);
  void on_current(const current_change_t& message);
  void on_ray_reply(const ray_reply_t& reply);
  void begin(SimTime now);
  void make_fleet(SimTime start);
  void subscribe_vehicle(std::size_t vehicle);
  void subscribe_arrays();
  void publish_states(SimTime when);
  SimTime next_fault() const;
  SimTime next_sample() const;
  void publish_batteries(SimTime when);
  void publish_battery(SimTime when, std::size_t vehicle);
  void publish_faults(SimTime until);
  void measure_all(SimTime steady);
  void note_poses(SimTime when);
  void publish_bearings();
  void publish_measured(SimTime steady);
  void publish(const SensorTick& tick, const SensorJob& job);
  template <class Message>
  void publish(const bus::Family& family, std::size_t vehicle, const Message& message) {
    publisher_.publish(family.of(members_[vehicle].name), message);
  }
  void report_diverged();

  VehicleSimConfig config_;
  FleetSettings settings_;
  std::vector<FleetMember> members_;
  std::vector<std::pair<std::size_t, Fault>> scenario_faults_;  // in order of time
  std::size_t faults_published_ = 0;
  std::vector<std::int32_t> ids_;
  std::shared_ptr<const Seabed> seabed_;
  std::string ray_client_;

  bus::ThreadPool pool_;
  std::optional<Fleet> fleet_;  // empty until the simulation time is known
  SensorStation station_;
  std::map<std::size_t, UsblFixAssembler> arrays_;  // key: vehicle, if it has an array
  SimTime next_state_;
  SimTime next_battery_ = SimTime::never();  // never() without batteries
  std::vector<StateSelection> published_;
  SimTime last_step_;  // steady time
  PendingEchoes echoes_;
  std::int64_t ray_request_ = 0;
  bus::NumberedPublisher publisher_{bus()};
  std::vector<bool> reported_diverged_;
};

}  // namespace halocline::vehicle_sim
