#include "channel_server/packet_medium.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/names.h"

namespace halocline::channel_server {
namespace {

// A fixed point of the arrival is exact enough when a round moves it by less than this; at v/c = 0.07 (100
// m/s, the fastest a state may tell) that takes 9 rounds.
constexpr double kSettledS = 1e-10;
constexpr int kMostRounds = 50;
// An arrival solved at an instant no further before it than this stands: the receiver moves by micrometres.
constexpr SimDuration kSolvedInTime = SimDuration::from_microseconds(1);
// Each solution a little later halves the rest at least; this many mean a receiver that runs from the sound.
constexpr int kMostSolutions = 64;

}  // namespace

PacketMedium::PacketMedium(const Fleet& fleet, Propagation& propagation, MediumRule rule)
    : fleet_(fleet), propagation_(propagation), rule_(rule) {
  require(rule.greatest_lateness >= SimDuration(), "the greatest lateness must not be negative");
  require(rule.greatest_earliness >= SimDuration(), "the greatest earliness must not be negative");
}

std::optional<Receipt> PacketMedium::transmit(const SendRequest& request, SimTime now) {
  if (!register_.enter(request)) {
    const Receipt* given = register_.receipt_of(request);
    return given ? std::optional(*given) : std::nullopt;
  }
  Receipt refusal{request.vehicle, request.session, request.packet_sequence, SendResult::kStale, {}, {}};
  if (request.start >= now - rule_.greatest_lateness && request.start <= now + rule_.greatest_earliness) {
    departures_.insert_or_assign(
        DepartureKey{request.start, request.vehicle, request.session, request.packet_sequence}, request);
    return std::nullopt;
  }
  if (request.start > now) refusal.result = SendResult::kTooEarly;
  register_.decide(request, refusal);
  return refusal;
}

SimTime PacketMedium::next_event() const {
  SimTime next = SimTime::never();
  if (!departures_.empty()) next = std::get<0>(departures_.begin()->first);
  if (!flights_.empty()) next = std::min(next, std::get<0>(flights_.begin()->first));
  return next;
}

std::vector<MediumEvent> PacketMedium::advance_to(SimTime time) {
  std::vector<MediumEvent> events;
  for (SimTime next = next_event(); next <= time && next != SimTime::never(); next = next_event()) {
    if (!departures_.empty() && std::get<0>(departures_.begin()->first) == next) {
      depart(departures_.extract(departures_.begin()).mapped(), events);
    } else {
      on_flight_event(std::move(flights_.extract(flights_.begin()).mapped()), next, events);
    }
  }
  advanced_to_ = std::max(advanced_to_, time);
  return events;
}

void PacketMedium::depart(const SendRequest& request, std::vector<MediumEvent>& events) {
  const VehicleModem& modem = fleet_.modem(request.vehicle, request.start);
  // A payload beyond the largest is refused, so its duration is of no consequence.
  const std::size_t payload_bytes = std::min(request.payload.size(), largest_payload_bytes(modem));
  const SimDuration duration = packet_timing(modem.modem, payload_bytes).duration;
  Receipt receipt{
      request.vehicle, request.session, request.packet_sequence, judge(request, duration), {}, {}};
  if (receipt.result == SendResult::kAccepted) {
    receipt.start = request.start;
    receipt.duration = duration;
    register_.occupy(request.vehicle, request.start, duration);
    const auto from = fleet_.placement(request.source_id, request.start, request.start);
    launch(std::make_shared<const Packet>(Packet{request, duration, modem.modem, from->position_ned_m}));
  }
  register_.decide(request, receipt);
  events.push_back({request.start, request.start < advanced_to_, std::move(receipt)});
}

SendResult PacketMedium::judge(const SendRequest& request, SimDuration duration) const {
  const auto id = fleet_.id_of(request.vehicle);
  if (!id || !fleet_.placement(*id, request.start, request.start)) return SendResult::kUnknownVehicle;
  if (*id != request.source_id) return SendResult::kWrongSource;
  const std::size_t largest = largest_payload_bytes(fleet_.modem(request.vehicle, request.start));
  if (request.payload.size() > largest) return SendResult::kTooLarge;
  if (register_.is_busy(request.vehicle, request.start, duration)) return SendResult::kBusy;
  return SendResult::kAccepted;
}

void PacketMedium::launch(std::shared_ptr<const Packet> packet) {
  const SimTime start = packet->request.start;
  for (const VehicleId receiver : fleet_.present(start)) {
    if (receiver == packet->request.source_id) continue;
    Flight flight;
    flight.packet = packet;
    flight.receiver_id = receiver;
    flight.receiver = fleet_.name_of(receiver);
    solve(flight, start);
    const SimTime arrival = start + SimDuration::from_seconds(flight.travel_time_s);
    schedule(arrival, std::move(flight));
  }
}

// t = s + delay(sender at s, receiver at t), from the last solution on. A receiver that is forgotten keeps the
// last one.
void PacketMedium::solve(Flight& flight, SimTime decided_at) const {
  const Packet& packet = *flight.packet;
  ++flight.times_solved;
  for (int round = 0; round < kMostRounds; ++round) {
    const SimTime arrival = packet.request.start + SimDuration::from_seconds(flight.travel_time_s);
    const auto receiver = fleet_.prediction(flight.receiver_id, arrival, decided_at);
    if (!receiver) return;
    flight.arrival_ned_m = receiver->position_ned_m;
    const double travel_time_s = propagation_.delay_s(
        packet.request.start, {packet.request.source_id, packet.departure_ned_m, Vec3::Zero(), &packet.modem},
        {flight.receiver_id, flight.arrival_ned_m, Vec3::Zero(), &packet.modem});
    const double change_s = std::abs(travel_time_s - flight.travel_time_s);
    flight.travel_time_s = travel_time_s;
    if (change_s < kSettledS) return;
  }
}

void PacketMedium::on_flight_event(Flight flight, SimTime at, std::vector<MediumEvent>& events) {
  if (flight.first_bit_arrived) {
    events.push_back({at, at < advanced_to_, end_of(flight, at)});
    return;
  }
  solve(flight, at);
  const SimTime arrival = flight.packet->request.start + SimDuration::from_seconds(flight.travel_time_s);
  if (arrival > at + kSolvedInTime && flight.times_solved < kMostSolutions) {
    schedule(arrival, std::move(flight));
    return;
  }
  meet_first_bit(flight, arrival, at);
  // A packet without a duration ends when its arrival is decided, should that be a little later.
  const SimTime last_bit = std::max(arrival + flight.packet->duration, at);
  schedule(last_bit, std::move(flight));
}

void PacketMedium::meet_first_bit(Flight& flight, SimTime arrival, SimTime decided_at) {
  const acoustics::Modem& receiver = fleet_.modem(flight.receiver, arrival).modem;
  flight.first_bit_arrived = true;
  flight.gone = !fleet_.placement(flight.receiver_id, arrival, decided_at);
  flight.cutoff = receiver.least_receivable_level;
  flight.budget = propagation_
                      .reception(flight.packet->request.start,
                                 {flight.packet->request.source_id, flight.packet->departure_ned_m,
                                  Vec3::Zero(), &flight.packet->modem},
                                 {flight.receiver_id, flight.arrival_ned_m, Vec3::Zero(), &receiver})
                      .budget;
}

PacketEnd PacketMedium::end_of(const Flight& flight, SimTime at) const {
  const bool gone = flight.gone || !fleet_.placement(flight.receiver_id, at, at);
  const VehicleId destination = flight.packet->request.destination_id;
  PacketEnd end;
  end.packet = flight.packet;
  end.receiver_id = flight.receiver_id;
  end.receiver = flight.receiver;
  end.fate = gone                       ? PacketFate::kReceiverGone
             : flight.budget.receivable ? PacketFate::kReceived
                                        : PacketFate::kBelowCutoff;
  end.deliver =
      end.fate == PacketFate::kReceived && (destination == flight.receiver_id || destination == kBroadcastId);
  end.travel_time_s = flight.travel_time_s;
  end.budget = flight.budget;
  end.cutoff = flight.cutoff;
  return end;
}

void PacketMedium::schedule(SimTime at, Flight flight) {
  const SendRequest& request = flight.packet->request;
  const FlightKey key{
      at, flight.receiver_id, request.source_id, request.session, request.packet_sequence, request.start};
  const bool fresh = flights_.emplace(key, std::move(flight)).second;
  ensure(fresh, "two flights of one packet to one receiver");
}

void PacketMedium::clear() {
  register_ = SendRegister();
  departures_.clear();
  flights_.clear();
  advanced_to_ = SimTime::at_once();
}

}  // namespace halocline::channel_server
