// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/input_processor.h"

#include <algorithm>
#include <string>
#include <tuple>

#include "bus/messages/channels.h"
#include "channel_server/messages/packet_messages.h"
#include "channel_server/messages/world_messages.h"
#include "channel_server/vehicles/state_history.h"
#include "channel_server/vehicles/vehicle_equipment.h"
#include "core/check.h"

namespace halocline::channel_server {

namespace channels = bus::channels;

InputProcessor::InputProcessor(bus::Bus& bus, VehicleRegistry& vehicles, EnvironmentTimeline& waters,
                               const Propagation& propagation, PacketMedium& medium, PacketPublisher& packets)
    : bus_(bus),
      vehicles_(vehicles),
      waters_(waters),
      propagation_(propagation),
      medium_(medium),
      packets_(packets) {}

SimTime InputProcessor::apply(StepInputs inputs, SimTime now, SimTime latest) {
  apply_states(std::move(inputs.states), latest);
  apply_modems(inputs.modems, now);
  apply_listens(inputs.listens, now);
  VehicleEquipment& equipment = vehicles_.equipment();
  for (const auto& [vehicle, fix] : inputs.fixes)
    equipment.clocks.add_fix(vehicle, SimTime::from_utime(fix.utime));
  for (const auto& [vehicle, report] : inputs.batteries)
    equipment.power.add_report(vehicle, SimTime::from_utime(report.utime), report.battery_empty != 0);
  for (const auto& [vehicle, sensors] : inputs.sensors)
    equipment.noise.add_rate(vehicle, SimTime::from_utime(sensors.utime), turn_rate_hz(sensors));
  const SimTime changed_from = apply_changes(inputs.changes, now);
  apply_sends(std::move(inputs.sends), now, latest);
  for (const modem_reply_t& message : inputs.modem_replies) medium_.add_answer(to_answer(message));
  return changed_from;
}

void InputProcessor::apply_states(StepInputs::ByVehicle<vehicle_state_t> states, SimTime latest) {
  std::stable_sort(states.begin(), states.end(), [](const auto& a, const auto& b) {
    return std::tie(a.second.utime, a.first) < std::tie(b.second.utime, b.first);
  });
  for (const auto& [vehicle, message] : states) {
    const StampedState state = to_state(message);
    const std::string problem = state.time > latest + kMaxAhead
                                    ? "utime lies more than 10 s ahead of simulation time"
                                    : vehicles_.add_state(vehicle, message.vehicle_id, state);
    if (!problem.empty()) bus_.refuse(channels::kState.of(vehicle), problem);
  }
}

void InputProcessor::apply_modems(const StepInputs::ByVehicle<modem_config_t>& modems, SimTime now) {
  for (const auto& [vehicle, message] : modems) {
    try {
      vehicles_.announce_modem(vehicle, SimTime::from_utime(message.utime), to_modem(message), now);
    } catch (const InvalidArgument& error) {
      bus_.refuse(channels::kModem.of(vehicle), error.what());
    }
  }
}

void InputProcessor::apply_listens(const StepInputs::ByVehicle<modem_listen_t>& listens, SimTime now) {
  for (const auto& [vehicle, message] : listens) {
    const SimTime from = SimTime::from_utime(message.utime);
    vehicles_.announce_listening(vehicle, from, to_listening(message), now);
    medium_.on_listening_changed(vehicle, from);
  }
}

// Published messages stay valid, so a change announced for an earlier time takes effect from now on.
SimTime InputProcessor::apply_changes(const std::vector<environment_change_t>& changes, SimTime now) {
  SimTime changed_from = SimTime::never();
  for (const environment_change_t& message : changes) {
    try {
      const std::string problem =
          waters_.announce(SimTime::from_utime(message.utime), now, {message.session, message.sequence},
                           to_change(message, propagation_.environment(now)));
      if (!problem.empty()) bus_.refuse(channels::kSetEnvironment, problem);
    } catch (const InvalidArgument& error) {
      bus_.refuse(channels::kSetEnvironment, error.what());
    }
    changed_from = std::min(changed_from, waters_.next_change_after(now));
    if (SimTime::from_utime(message.utime) <= now) changed_from = std::min(changed_from, now);
  }
  return changed_from;
}

void InputProcessor::apply_sends(StepInputs::ByVehicle<modem_send_t> sends, SimTime now, SimTime latest) {
  std::stable_sort(sends.begin(), sends.end(), [](const auto& a, const auto& b) {
    return std::tie(a.second.utime, a.first, a.second.session, a.second.packet_sequence) <
           std::tie(b.second.utime, b.first, b.second.session, b.second.packet_sequence);
  });
  for (const auto& [vehicle, message] : sends) {
    if (const auto receipt = medium_.transmit(to_request(vehicle, message), now, latest))
      packets_.publish(*receipt, now);
  }
}

}  // namespace halocline::channel_server
