// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/packets/send_decision.h"

#include <memory>
#include <utility>

#include "channel_server/vehicles/modem_schedule.h"

namespace halocline::channel_server {

SendDecision decide_send(const SendRequest& request, const Framing& framing, const VehicleRegistry& fleet,
                         const SendRegister& sends) {
  const auto id = fleet.id_of(request.vehicle);
  const SimTime start = request.start;
  if (!id || !fleet.placement(*id, start, start)) return {SendResult::kUnknownVehicle, start};
  if (*id != request.source_id) return {SendResult::kWrongSource, start};
  const VehicleModem& modem = fleet.modem(request.vehicle, start);
  if (!modem.fitted || !fleet.equipment().power.has_power(*id, start)) return {SendResult::kNoModem, start};
  if (framing.problem != SendResult::kAccepted) return {framing.problem, start};
  if (!sends.is_busy(request.vehicle, start, framing.timing.duration)) return {SendResult::kAccepted, start};
  if (modem.when_busy == WhenBusy::kRefuse || is_answer(request.kind)) {
    return {SendResult::kBusy, start};
  }
  if (sends.waiting_at(request.vehicle, start) >= kMaxQueuedSends) return {SendResult::kQueueFull, start};
  return {SendResult::kQueued, sends.free_from(request.vehicle, start)};
}

PacketPointer at_its_departure(const Packet& queued, const VehicleRegistry& fleet) {
  Packet packet = queued;
  if (const auto place = fleet.prediction(packet.request.source_id, packet.departure, packet.departure)) {
    packet.departure_ned_m = place->position_ned_m;
    packet.velocity_ned_mps = place->velocity_ned_mps;
  }
  return std::make_shared<const Packet>(std::move(packet));
}

}  // namespace halocline::channel_server
