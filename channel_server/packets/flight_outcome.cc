// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/packets/flight_outcome.h"

#include <algorithm>
#include <cmath>

#include "channel_server/packets/platform_noise.h"
#include "channel_server/packets/reception_decision.h"
#include "channel_server/propagation/propagation.h"
#include "core/elementary.h"
#include "core/frames.h"
#include "core/names.h"
#include "core/units.h"

namespace halocline::channel_server {
namespace {

// Sets the direction towards the source, as the receiver sees it.
void set_direction(const Flight& flight, PacketOutcome& outcome) {
  const Vec3 back = flight.packet->departure_ned_m - flight.place.position_ned_m;
  outcome.arrival_azimuth_rad = elementary::atan2(back.y(), back.x());
  const auto& paths = flight.reception.paths;
  // A path that travels downwards arrives from above, so the elevation of its source equals its arrival
  // angle, which is positive down.
  outcome.arrival_elevation_rad = paths.empty()
                                      ? elementary::atan2(-back.z(), elementary::hypot(back.x(), back.y()))
                                      : paths[first_significant(paths)].arrival_angle_rad;
}

bool is_for(const SendRequest& request, VehicleId receiver) {
  return request.destination_id == receiver || request.destination_id == kBroadcastId;
}

// Returns what a vehicle's clock gains from one instant to another, s.
double gain_s(const VehicleClocks& clocks, VehicleId id, SimTime from, SimTime to) {
  return clocks.error_s(id, to) - clocks.error_s(id, from);
}

// Returns the two-way travel time that the vehicle that asked measures with its clock from an answer: the
// elapsed time less the packet's duration and the turnaround, which both ends know, s.
double two_way_travel_time_s(const Flight& answer, const VehicleClocks& clocks) {
  const Packet& asked = *answer.packet->answers;
  //   two-way time = (s_a - s - T - R) + t_a + g
  // with the departure s_a of the answer and its travel time t_a, the departure s and duration T of the
  // packet that it answers, the turnaround R, and the gain g of the clock between s and the answer's arrival.
  const SimDuration waited =
      answer.packet->departure - asked.departure - asked.timing.duration - kReplyTurnaround;
  return waited.seconds() + answer.travel_time_s +
         gain_s(clocks, answer.receiver_id, asked.departure, answer.arrival());
}

// Returns the receiver's clock at the arrival less the sender's clock at the departure, s.
double one_way_travel_time_s(const Flight& flight, const VehicleClocks& clocks) {
  const Packet& packet = *flight.packet;
  return flight.travel_time_s + clocks.error_s(flight.receiver_id, flight.arrival()) -
         clocks.error_s(packet.request.source_id, packet.departure);
}

// Returns a time as the receiver's modem measures it: with the timing error, rounded to its time quantum, s.
double measured(const Flight& flight, double time_s) {
  const double quantum_s = flight.modem.time_quantum.seconds(), noisy_s = time_s + flight.timing_error_s;
  return quantum_s > 0 ? std::round(noisy_s / quantum_s) * quantum_s : noisy_s;
}

OutcomeKind outcome_without_path(PathState state) {
  switch (state) {
    case PathState::kBlocked:
      return OutcomeKind::kBlocked;
    case PathState::kTooWeak:
      return OutcomeKind::kTooWeak;
    case PathState::kTooSteep:
      return OutcomeKind::kTooSteep;
    case PathState::kNoTerrain:
      return OutcomeKind::kNoTerrain;
    case PathState::kOpen:
    case PathState::kShadow:
      break;
  }
  return OutcomeKind::kShadow;
}

// Returns the packet's departure by its sender's clock.
SimTime departure_stamp(const Flight& flight, const VehicleClocks& clocks) {
  const Packet& packet = *flight.packet;
  return packet.departure +
         SimDuration::from_seconds(clocks.error_s(packet.request.source_id, packet.departure));
}

}  // namespace

SimTime measured_arrival(const Flight& flight, const VehicleClocks& clocks) {
  return departure_stamp(flight, clocks) +
         SimDuration::from_seconds(measured(flight, one_way_travel_time_s(flight, clocks)));
}

OutcomeKind outcome_before_acquisition(const Flight& flight) {
  const Reception& reception = flight.reception;
  if (flight.receiver_absent) return OutcomeKind::kReceiverGone;
  if (!same_family(flight.packet->modem, flight.modem)) return OutcomeKind::kForeign;
  if (band_share(flight.packet->modem.band(), flight.modem.band()) == 0) return OutcomeKind::kOutOfBand;
  if (flight.out_of_water) return OutcomeKind::kOutOfWater;
  if (reception.paths.empty()) return outcome_without_path(reception.state);
  if (reception.budget.received_level < flight.modem.min_receivable_level) return OutcomeKind::kBelowCutoff;
  return OutcomeKind::kReceived;
}

bool is_shifted_too_far(const Flight& flight) {
  return !flight.signal.fades && std::abs(flight.doppler_factor() - 1) > flight.modem.doppler_tolerance;
}

void evaluate_signals(Flight& first, std::vector<Flight*> soon, const acoustics::FadingModel& fading,
                      std::uint64_t seed, const ForEach& for_each) {
  std::erase_if(soon, [](const Flight* flight) {
    return flight->is_evaluated || outcome_before_acquisition(*flight) != OutcomeKind::kReceived ||
           is_shifted_too_far(*flight) ||
           flight->sounds_at->followed_at(flight->signal.preamble_end, *flight->packet);
  });
  soon.push_back(&first);
  for_each(soon.size(), [&](std::size_t i) { evaluate_signal(*soon[i], fading, seed); });
}

OutcomeKind decide_outcome(Flight& flight, SimTime at, const VehicleRegistry& fleet,
                           const ReceiverState& receiver) {
  const ReceivedSignal& signal = flight.signal;
  DecisionStatistics& statistics = flight.statistics;
  statistics.acquisition_draw = flight.draws.acquisition;
  statistics.success_draw = flight.draws.success;
  flight.receiver_absent = flight.receiver_absent || !fleet.placement(flight.receiver_id, at, at);
  const OutcomeKind before = outcome_before_acquisition(flight);
  const VehiclePower& power = fleet.equipment().power;
  const bool has_power =
      power.has_power(flight.receiver_id, signal.begin) && power.has_power(flight.receiver_id, signal.end);
  if (!has_power && before != OutcomeKind::kReceiverGone) return OutcomeKind::kNoPower;
  if (before != OutcomeKind::kReceived) return before;
  if (fleet.sleeps_during(flight.receiver_id, signal.begin, signal.end)) return OutcomeKind::kAsleep;
  for (const PacketPointer& own : receiver.transmitted_during(signal.begin, signal.end)) {
    if (statistics.colliders.size() < kMaxColliders) statistics.colliders.push_back(own->name());
  }
  if (!statistics.colliders.empty()) return OutcomeKind::kHalfDuplex;
  if (is_shifted_too_far(flight)) return OutcomeKind::kDoppler;
  if (flight.followed) {
    statistics.colliders.push_back(flight.followed->name());
    return OutcomeKind::kCollided;
  }
  const auto others = interferers_of(flight, receiver, signal.begin, signal.end);
  return decide_reception(signal, others, flight.draws, flight.acquired, statistics);
}

PacketOutcome outcome_of(const Flight& flight, OutcomeKind kind, const VehicleEquipment& equipment,
                         bool promiscuous) {
  const VehicleClocks& clocks = equipment.clocks;
  PacketOutcome outcome;
  outcome.kind = kind;
  outcome.packet = flight.packet;
  outcome.receiver_id = flight.receiver_id;
  outcome.receiver = flight.receiver;
  outcome.deliver = outcome.kind == OutcomeKind::kReceived &&
                    (promiscuous || is_for(flight.packet->request, flight.receiver_id));
  outcome.travel_time_s = flight.travel_time_s;
  outcome.departure_stamp = departure_stamp(flight, clocks);
  outcome.measured_travel_time_s = measured(flight, one_way_travel_time_s(flight, clocks));
  if (flight.packet->answers) {
    outcome.two_way_travel_time_s = measured(flight, two_way_travel_time_s(flight, clocks));
  }
  outcome.budget = flight.reception.budget;
  outcome.cutoff = flight.modem.min_receivable_level;
  outcome.propagation = flight.reception.used;
  outcome.path_count = flight.reception.paths.size();
  outcome.delay_spread_s = flight.reception.delay_spread_s;
  outcome.doppler_factor = flight.doppler_factor();
  set_direction(flight, outcome);
  outcome.statistics = flight.statistics;
  outcome.conflicts_with_past = flight.conflicts_with_past;
  if (const PowerOf* battery = flight.acquired ? equipment.power.battery_of(flight.receiver_id) : nullptr)
    outcome.receive_energy_j = battery->receiving_w * (flight.signal.end - flight.signal.begin).seconds();
  return outcome;
}

PacketOutcome outcome_out_of_reach(const PacketPointer& packet, double range_m, VehicleId receiver_id,
                                   std::string receiver) {
  PacketOutcome outcome;
  outcome.receiver_id = receiver_id;
  outcome.receiver = std::move(receiver);
  outcome.kind = OutcomeKind::kOutOfReach;
  outcome.packet = packet;
  outcome.budget.range_m = range_m;
  outcome.budget.received_level = kSilence;
  outcome.budget.transmission_loss = packet->modem.source_level - kSilence;
  return outcome;
}

void add_sending(const Packet& packet, const VehiclePower& power, std::vector<MediumEvent>& events) {
  if (power.battery_of(packet.request.source_id) == nullptr) return;
  events.push_back(
      {packet.departure, EnergyUse{packet.request.vehicle, true, packet.energy_j, packet.name()}});
}

void add_receiving(const Flight& flight, const PacketOutcome& outcome, SimTime at, const VehiclePower& power,
                   std::vector<MediumEvent>& events) {
  if (!flight.acquired || power.battery_of(flight.receiver_id) == nullptr) return;
  events.push_back({at, EnergyUse{flight.receiver, false, outcome.receive_energy_j, flight.packet->name()}});
}

bool asks_for_answer(const PacketOutcome& outcome, const VehicleEquipment& equipment) {
  const SendRequest& request = outcome.packet->request;
  const bool is_asked =
      request.destination_id == outcome.receiver_id ||
      (request.destination_id == kBroadcastId && equipment.transponders.contains(outcome.receiver_id));
  return outcome.deliver && is_asked && wants_answer(request);
}

// A clock that gains g over the turnaround makes it g shorter, to first order in its drift.
ModemReply answer_of(const Flight& flight, SimTime at, const VehicleClocks& clocks) {
  const Packet& asked = *flight.packet;
  SendRequest answer;
  answer.vehicle = flight.receiver;
  answer.source_id = flight.receiver_id;
  answer.destination_id = asked.request.source_id;
  answer.session = asked.request.session;
  answer.packet_sequence = asked.request.packet_sequence;
  const SimTime measured_arrival = flight.arrival() + SimDuration::from_seconds(flight.timing_error_s);
  const SimTime due = measured_arrival + asked.timing.duration + kReplyTurnaround;
  const double gained_s = gain_s(clocks, flight.receiver_id, measured_arrival, due);
  answer.start = std::max(due - SimDuration::from_seconds(gained_s), at);
  answer.kind = asked.request.kind == PacketKind::kPing ? PacketKind::kPingReply : PacketKind::kAck;
  if (answer.kind == PacketKind::kAck) {
    for (std::size_t frame = 0; frame < asked.frame_bytes.size(); frame += 8)
      answer.payload.push_back(static_cast<std::uint8_t>(flight.statistics.frames_good >> frame));
  }
  answer.stamped = false;
  return {answer, asked.departure, asked.timing.duration};
}

}  // namespace halocline::channel_server
