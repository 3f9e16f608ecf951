// SPDX-License-Identifier: BSD-3-Clause
// The processing of a step's inputs: states, modems and their listening go to the registry, changes of the
// water to the timeline, transmissions and answers to pings to the packet medium.
//
// Within a step, states and transmissions are applied in the order of their time and the vehicle's name, not
// of arrival. When two vehicles claim one id at one time, the same one gets it in every run. Impossible
// inputs are refused on their channel.
#pragma once

#include <vector>

#include "bus/bus.h"
#include "channel_server/inbox.h"
#include "channel_server/packet_publisher.h"
#include "channel_server/packets/packet_medium.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class InputProcessor {
 public:
  // A state stamped later than this after the time by CLOCK is taken to come from a wrong clock.
  static constexpr SimDuration kMaxAhead = SimDuration::from_milliseconds(10'000);

  // The references must outlive this object.
  InputProcessor(bus::Bus& bus, VehicleRegistry& vehicles, EnvironmentTimeline& waters,
                 const Propagation& propagation, PacketMedium& medium, PacketPublisher& packets);

  // Applies the inputs and publishes the receipts that need no waiting. Returns the first instant from which
  // the inputs change the water; never() if they do not. `now` is the time of the step; `latest` the time by
  // CLOCK, which a step that catches up lags behind.
  SimTime apply(StepInputs inputs, SimTime now, SimTime latest);

 private:
  void apply_states(StepInputs::ByVehicle<vehicle_state_t> states, SimTime latest);
  void apply_listens(const StepInputs::ByVehicle<modem_listen_t>& listens, SimTime now);
  void apply_modems(const StepInputs::ByVehicle<modem_config_t>& modems, SimTime now);
  SimTime apply_changes(const std::vector<environment_change_t>& changes, SimTime now);
  void apply_sends(StepInputs::ByVehicle<modem_send_t> sends, SimTime now, SimTime latest);

  bus::Bus& bus_;
  VehicleRegistry& vehicles_;
  EnvironmentTimeline& waters_;
  const Propagation& propagation_;
  PacketMedium& medium_;
  PacketPublisher& packets_;
};

}  // namespace halocline::channel_server
