// SPDX-License-Identifier: BSD-3-Clause
// The vehicle simulator's node on memq, with what it published.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "bus/config/scenario.h"
#include "bus/runtime/lockstep_runner.h"
#include "bus/runtime/node.h"
#include "bus/transport/event_log.h"
#include "bus/transport/node_identity.h"
#include "core/sim_time.h"
#include "tests/bus/runtime/journal_files.h"
#include "tests/support/at_ms.h"
#include "tests/vehicle_sim/client_messages.h"
#include "tests/vehicle_sim/world/grounds.h"
#include "vehicle_sim/dynamics/currents.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/sensors/sensor_errors.h"
#include "vehicle_sim/vehicle_sim_config.h"
#include "vehicle_sim/vehicle_sim_messages.h"
#include "vehicle_sim/vehicle_sim_node.h"
#include "vehicle_sim/world/seabed.h"

namespace halocline::vehicle_sim {

using halocline::testing::at_ms;

inline bus::Scenario scenario_of_two() {
  bus::Scenario scenario;
  scenario.vehicles = {{.name = "sub", .id = 3, .start_ned_m = {0, 0, 20}},
                       {.name = "buoy", .id = 9, .model = "fixed", .start_ned_m = {50, 0, 5}},
                       {.name = "guest", .id = 4, .model = "external"}};
  return scenario;
}

// The bus, the node and what it published.
class VehicleSimNodeTest : public ::testing::Test {
 protected:
  VehicleSimNodeTest() {
    bus::set_log_level(bus::LogLevel::kSilent);
    ear_.subscribe<vehicle_state_t>(
        bus::channels::kState,
        [this](std::string_view name, const vehicle_state_t& m) { states_[std::string(name)].push_back(m); });
    ear_.subscribe<vehicle_sensors_t>(bus::channels::kSensors,
                                      [this](std::string_view name, const vehicle_sensors_t& m) {
                                        sensors_[std::string(name)].push_back(m);
                                      });
    ear_.subscribe<vehicle_dvl_t>(bus::channels::kDvl.of("sub"),
                                  [this](const vehicle_dvl_t& m) { pings_.push_back(m); });
    ear_.subscribe<vehicle_gps_t>(bus::channels::kGps, [this](std::string_view name, const vehicle_gps_t& m) {
      fixes_[std::string(name)].push_back(m);
    });
    ear_.subscribe<vehicle_sonar_t>(bus::channels::kSonar.of("sub"),
                                    [this](const vehicle_sonar_t& m) { fans_.push_back(m); });
    ear_.subscribe<vehicle_usbl_t>(bus::channels::kUsbl.of("sub"),
                                   [this](const vehicle_usbl_t& m) { bearings_.push_back(m); });
    ear_.subscribe<ray_query_t>(bus::channels::kRayQuery, [this](const ray_query_t& q) { on_query(q); });
  }

  void make_node(std::shared_ptr<const Seabed> seabed = nullptr) {
    node_ = std::make_unique<VehicleSimNode>(lcm_, bus::NodeIdentity{"vehicle-sim", 77}, scenario_of_two(),
                                             config_, std::move(seabed));
  }

  // As the runner of a process does it: dispatch, then step at the instants at which the node is due.
  void run_until(SimTime end) {
    drain();
    for (;;) {
      const bus::Due due = node_->due();
      const SimTime next = std::max(std::min(due.sim, due.steady), now_);
      if (next > end) break;
      now_ = next;
      node_->step({now_, now_});
      drain();
    }
    now_ = end;
  }
  void drain() {
    while (lcm_.handleTimeout(0) > 0) {
    }
  }

  void command(SimTime from, const ActuatorValues& actuators) {
    ear_.publish(bus::channels::kCommand.of("sub"), to_command_message({from, actuators}));
    drain();
  }

  // A service whose bottom lies at bottom_z_, straight below.
  void on_query(const ray_query_t& q) {
    ++queries_;
    last_client_ = q.client_name;
    if (!service_answers_) return;
    ray_reply_t reply{};
    reply.utime = q.utime;
    reply.session = 5;
    reply.request_id = q.request_id;
    reply.reply_status = ray_reply_t::OK;
    reply.num_rays = q.num_rays;
    for (int i = 0; i < q.num_rays; ++i) {
      const double altitude = (bottom_z_ - q.offset_m[i][2]) / q.direction[i][2];
      const bool hit = altitude <= q.max_range_m[i];
      reply.ray_status.push_back(hit ? ray_reply_t::HIT : ray_reply_t::MISS);
      reply.result_m.push_back(hit ? altitude : 0);
    }
    ear_.publish(bus::channels::kRayReply.of(q.client_name), reply);
  }

  lcm::LCM lcm_{"memq://"};
  bus::Bus ear_{lcm_, {"ear", 1}};
  VehicleSimConfig config_;
  std::unique_ptr<VehicleSimNode> node_;
  SimTime now_;
  std::map<std::string, std::vector<vehicle_state_t>> states_;
  std::map<std::string, std::vector<vehicle_sensors_t>> sensors_;
  std::vector<vehicle_dvl_t> pings_;
  std::map<std::string, std::vector<vehicle_gps_t>> fixes_;
  std::vector<vehicle_sonar_t> fans_;
  std::vector<vehicle_usbl_t> bearings_;
  bool service_answers_ = true;
  double bottom_z_ = 60;
  int queries_ = 0;
  std::string last_client_;
};

}  // namespace halocline::vehicle_sim
