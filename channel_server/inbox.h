// SPDX-License-Identifier: BSD-3-Clause
// The messages that the channel server has received and no step has taken yet. Their number is bounded.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bus/bus.h"
#include "bus/messages/channel_family.h"
#include "channel_server/vehicles/shard.h"
#include "channel_server/vehicles/vehicle_equipment.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

// The inputs of one step, in order of arrival.
struct StepInputs {
  template <class Message>
  using ByVehicle = std::vector<std::pair<std::string, Message>>;

  ByVehicle<vehicle_state_t> states;
  ByVehicle<modem_config_t> modems;
  ByVehicle<modem_listen_t> listens;
  ByVehicle<modem_send_t> sends;
  ByVehicle<vehicle_gps_t> fixes;
  ByVehicle<vehicle_battery_t> batteries;
  ByVehicle<vehicle_sensors_t> sensors;
  std::vector<environment_change_t> changes;
  std::vector<modem_reply_t> modem_replies;  // from other shards
};

class Inbox {
 public:
  // Subscribes to STATE, MODEM, LISTEN, SEND, SET_ENVIRONMENT, LINK_QUERY and BEST_PLACE_QUERY; to
  // MODEM_REPLY if there are several shards; and to GPS, BATTERY and SENSORS as the equipment needs them. The
  // bus must outlive the inbox.
  Inbox(bus::Bus& bus, const Shard& shard, const VehicleEquipment& equipment);
  Inbox(const Inbox&) = delete;
  Inbox& operator=(const Inbox&) = delete;

  StepInputs take_inputs() { return std::exchange(inputs_, {}); }
  std::vector<link_query_t> take_queries() { return std::exchange(queries_, {}); }
  std::vector<best_place_query_t> take_place_queries() { return std::exchange(place_queries_, {}); }

  // Returns the simulation time at which a step is needed for the messages; states and modems alone need
  // none.
  SimTime due() const;
  // Returns the start of the first requested packet that a modem may answer; never() without one.
  SimTime next_answerable() const;
  // Removes messages stamped after `latest`, because another run has begun. Other messages may belong to the
  // new run.
  void forget_after(SimTime latest);

 private:
  template <class Query>
  void subscribe_queries(std::string_view channel, const Shard& shard, std::vector<Query>& queries,
                         std::size_t most);
  void subscribe_equipment(const VehicleEquipment& equipment);
  template <class Message>
  void keep(StepInputs::ByVehicle<Message>& messages, std::string_view vehicle, const Message& message,
            const bus::Family& family);

  bus::Bus& bus_;
  StepInputs inputs_;
  std::vector<link_query_t> queries_;
  std::vector<best_place_query_t> place_queries_;
};

}  // namespace halocline::channel_server
