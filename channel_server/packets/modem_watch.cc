// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/packets/modem_watch.h"

#include "acoustics/modem/modem.h"
#include "channel_server/packets/flight_outcome.h"
#include "channel_server/packets/reception_decision.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "core/units.h"

namespace halocline::channel_server {
namespace {

// Sets what the modem knows once it has decoded the packet's header.
void set_header(const Flight& flight, ModemEvent& event) {
  event.source_id = flight.packet->request.source_id;
  event.destination_id = flight.packet->request.destination_id;
  event.packet_duration = flight.packet->timing.duration;
  event.packet_end = flight.signal.end;
}

}  // namespace

void ModemWatch::begin_transmission(const Packet& packet, std::vector<MediumEvent>& events) {
  const SendRequest& request = packet.request;
  update_carrier_sense_at(request.source_id, packet.departure);
  if (!fleet_.listening(request.source_id, packet.departure).events) return;
  ModemEvent event{request.vehicle, ModemEventKind::kTransmissionBegan};
  event.session = request.session;
  event.packet_sequence = request.packet_sequence;
  events.push_back({packet.departure, event});
  event.kind = ModemEventKind::kTransmissionEnded;
  ends_.emplace(std::pair(packet.departure + packet.timing.duration, request.source_id), std::move(event));
}

void ModemWatch::end_transmission_or_header(std::vector<MediumEvent>& events) {
  if (next_of(ends_) <= next_of(headers_)) {
    auto end = ends_.extract(ends_.begin());
    events.push_back({end.key().first, std::move(end.mapped())});
    return;
  }
  const auto header = headers_.extract(headers_.begin());
  const SimTime at = header.key().first;
  const Flight& flight = *header.mapped();
  if (!has_header(flight, at)) return;
  ModemEvent event{flight.receiver, ModemEventKind::kHeaderReceived};
  event.level = flight.reception.budget.received_level;
  event.rate_number = flight.packet->rate_number;
  set_header(flight, event);
  events.push_back({at, std::move(event)});
}

bool ModemWatch::has_header(const Flight& flight, SimTime end) const {
  const ReceivedSignal& signal = flight.signal;
  const ReceiverState& receiver = *flight.sounds_at;
  return fleet_.equipment().power.has_power(flight.receiver_id, end) &&
         !fleet_.sleeps_during(flight.receiver_id, signal.begin, end) &&
         receiver.transmitted_during(signal.begin, end).empty() &&
         is_header_right(signal, interferers_of(flight, receiver, signal.begin, end), flight.draws);
}

void ModemWatch::detect(Flight& flight, std::vector<MediumEvent>& events) {
  const SimTime at = flight.signal.preamble_end;
  flight.reports = fleet_.listening(flight.receiver_id, at).events;
  if (!flight.reports) return;
  ModemEvent event{flight.receiver, ModemEventKind::kPacketDetected};
  event.level = flight.reception.budget.received_level;
  event.rate_number = flight.packet->rate_number;
  event.measured_arrival = measured_arrival(flight, fleet_.equipment().clocks);
  events.push_back({at, std::move(event)});
  if (flight.packet->format.header_bits > 0)
    headers_.insert_or_assign({header_end(flight.signal), flight.receiver_id}, &flight);
}

void ModemWatch::end(const Flight& flight, SimTime at, OutcomeKind outcome,
                     std::vector<MediumEvent>& events) {
  if (!flight.reports) return;
  ModemEvent event{flight.receiver, ModemEventKind::kPacketEnded};
  event.level = flight.reception.budget.received_level;
  event.sinr = flight.statistics.sinr;
  event.outcome = outcome;
  event.rate_number = flight.packet->rate_number;
  if (outcome == OutcomeKind::kReceived) set_header(flight, event);
  events.push_back({at, std::move(event)});
}

void ModemWatch::update_carrier_sense_at(VehicleId id, SimTime at) {
  if (at == SimTime::never()) return;
  if (carriers_.contains(id) || fleet_.listening(id, at).events) due_.insert({at, id});
}

void ModemWatch::update_carrier_sense(const ReceiverState& heard, std::vector<MediumEvent>& events) {
  const auto [at, id] = *due_.begin();
  due_.erase(due_.begin());
  Carrier& carrier = carriers_[id];
  const Listening& listening = fleet_.listening(id, at);
  if (!listening.events || listening.is_asleep(at) || heard.transmits_at(at)) {
    if (carrier.sensed) change(id, carrier, at, 0, events);
    if (listening.is_asleep(at) && listening.wakes) update_carrier_sense_at(id, *listening.wakes);
    return update_carrier_sense_at(id, heard.transmission_end(at));
  }
  const SimTime from = carrier.changed == SimTime::at_once() ? at : carrier.changed + kCarrierHold;
  if (from > at) return update_carrier_sense_at(id, from);
  const acoustics::Modem& modem = fleet_.modem(id, at).modem;
  const Decibels noise = sounds_.noise_level(id, modem.band(), at, at) - modem.directivity_index;
  // Carrier is sensed where the summed power exceeds 10^(threshold / 10) N, N less the directivity index.
  const double threshold = to_power_ratio(noise + listening.carrier_threshold).value;
  const PowerCrossing crossing = heard.next_crossing(at, modem.band(), threshold, !carrier.sensed);
  if (crossing.at > at) return update_carrier_sense_at(id, crossing.at);
  change(id, carrier, at, crossing.power, events);
  update_carrier_sense_at(id, at + kCarrierHold);
}

void ModemWatch::change(VehicleId id, Carrier& carrier, SimTime at, double power,
                        std::vector<MediumEvent>& events) {
  carrier.sensed = !carrier.sensed;
  carrier.changed = at;
  ModemEvent event{fleet_.name_of(id),
                   carrier.sensed ? ModemEventKind::kCarrierBegan : ModemEventKind::kCarrierEnded};
  event.level = level_of(power);
  events.push_back({at, std::move(event)});
}

void ModemWatch::forget_before(SimTime time) {
  std::erase_if(carriers_, [&](const auto& entry) {
    const Carrier& carrier = entry.second;
    return !carrier.sensed && carrier.changed < time;
  });
}

}  // namespace halocline::channel_server
