// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/packets/packet_medium.h"

#include <algorithm>

#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "channel_server/packets/flight_outcome.h"
#include "channel_server/packets/reception_decision.h"
#include "channel_server/packets/send_decision.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "core/check.h"
#include "core/frames.h"
#include "core/names.h"
#include "core/units.h"

namespace halocline::channel_server {
namespace {

// Largest error of a first sound's instant that ends the iteration: within it the receiver moves by
// micrometres.
constexpr SimDuration kSolvedInTime = SimDuration::from_microseconds(1);
// Signals that are likely to be needed within this time are evaluated together.
constexpr SimDuration kSoon = SimDuration::from_milliseconds(100);
// Largest number of solutions for one arrival. Each solution, a little later than the one before, at least
// halves the remaining error; this many mean a receiver that outruns the sound.
constexpr int kMaxSolutions = 64;

}  // namespace

PacketMedium::PacketMedium(const VehicleRegistry& fleet, Propagation& propagation, MediumRule rule,
                           ReachModel* reach, ForEach for_each)
    : fleet_(fleet),
      propagation_(propagation),
      rule_(std::move(rule)),
      reach_(reach),
      for_each_(std::move(for_each)),
      sounds_(fleet, propagation, reach, rule_.fading, rule_.noise, rule_.seed),
      watch_(fleet, sounds_) {
  require(rule_.max_lateness >= SimDuration(), "the greatest lateness must not be negative");
  require(rule_.max_earliness >= SimDuration(), "the greatest earliness must not be negative");
  validate(rule_.noise);
}

std::optional<Receipt> PacketMedium::transmit(const SendRequest& request, SimTime now, SimTime latest) {
  if (!register_.enter(request)) {
    const Receipt* given = register_.receipt_of(request);
    return given && rule_.shard.serves(request.source_id) ? std::optional(*given) : std::nullopt;
  }
  Receipt refusal{request.vehicle, request.session, request.packet_sequence, SendResult::kStale, {}, {}};
  const SimTime last_start = std::max(now, latest) + rule_.max_earliness;
  if (request.start >= now - rule_.max_lateness && request.start <= last_start) {
    add_departure(request.start, {request, nullptr, nullptr});
    return std::nullopt;
  }
  if (request.start > now) refusal.result = SendResult::kTooEarly;
  register_.decide(request, refusal);
  return rule_.shard.serves(request.source_id) ? std::optional(refusal) : std::nullopt;
}

void PacketMedium::add_answer(const ModemReply& answer) {
  const SendRequest& request = answer.request;
  if (!answered_
           .insert({request.start, request.source_id, request.destination_id, request.session,
                    request.packet_sequence})
           .second) {
    return;
  }
  Packet asked;
  asked.departure = answer.asked_departure;
  asked.timing.duration = answer.asked_duration;
  add_departure(request.start, {request, std::make_shared<const Packet>(std::move(asked)), nullptr});
}

void PacketMedium::add_departure(SimTime at, Departure departure) {
  const SendRequest& request = departure.request;
  may_be_answered_ = may_be_answered_ || wants_answer(request);
  departures_.insert_or_assign(
      DepartureKey{at, request.vehicle, request.kind, request.packet_sequence, request.destination_id,
                   departure.queued == nullptr, request.session},
      std::move(departure));
}

SimTime PacketMedium::next_event() const {
  SimTime next = SimTime::never();
  if (waiting_) return next;
  if (!departures_.empty()) next = std::get<0>(departures_.begin()->first);
  if (!flights_.empty()) next = std::min(next, flights_.next_event());
  return std::min({next, watch_.next_end(), watch_.next_carrier()});
}

SimTime PacketMedium::next_answerable() const {
  SimTime next = SimTime::never();
  if (!may_be_answered_) return next;
  for (const auto& [key, departure] : departures_)
    if (wants_answer(departure.request)) next = std::min(next, std::get<0>(key));
  flights_.visit([&](SimTime at, const Flight& flight) {
    if (wants_answer(flight.packet->request)) next = std::min(next, at);
  });
  may_be_answered_ = next != SimTime::never();
  return next;
}

const std::vector<MediumEvent>& PacketMedium::advance_to(SimTime time) {
  events_.clear();
  waiting_ = false;
  SimTime reached = time;
  for (SimTime next = next_event(); next <= time && next != SimTime::never(); next = next_event()) {
    if (watch_.next_end() == next) {
      watch_.end_transmission_or_header(events_);
    } else if (!departures_.empty() && std::get<0>(departures_.begin()->first) == next) {
      depart(departures_.extract(departures_.begin()).mapped(), events_);
    } else if (flights_.empty() || flights_.next_event() != next) {
      watch_.update_carrier_sense(state_of(watch_.next_to_update()), events_);
    } else if (!on_flight_event(next, events_)) {
      waiting_ = true;
      reached = next;
    }
  }
  for (MediumEvent& event : events_) event.late = event.at < advanced_to_;
  advanced_to_ = std::max(advanced_to_, reached);
  return events_;
}

bool PacketMedium::must_be_deferred(const Departure& departure) const {
  if (departure.is_deferred || departure.answers) return false;
  const SendRequest& request = departure.request;
  const auto id = fleet_.id_of(request.vehicle);
  return !id || !fleet_.placement(*id, request.start, request.start);
}

void PacketMedium::depart(Departure departure, std::vector<MediumEvent>& events) {
  if (departure.queued) {
    const PacketPointer packet = at_its_departure(*departure.queued, fleet_);
    // The battery may have run out while the packet waited; then it is never sent.
    if (power().has_power(packet->request.source_id, packet->departure)) launch(packet, events);
    return;
  }
  if (must_be_deferred(departure)) {
    departure.is_deferred = true;
    const SimTime later = departure.request.start + fleet_.rule().state_lag;
    return add_departure(later, std::move(departure));
  }
  const SendRequest asked = departure.request;
  SendRequest& request = departure.request;
  if (departure.is_deferred) request.start = asked.start + fleet_.rule().state_lag;
  Framing framing = framing_of(fleet_.modem(request.vehicle, request.start), request);
  const acoustics::PacketTiming timing = framing.timing;
  const SendDecision decision = decide_send(request, framing, fleet_, register_);
  const bool accepted = decision.result == SendResult::kAccepted || decision.result == SendResult::kQueued;
  if (accepted) {
    register_.occupy(request.vehicle, decision.start, timing.duration);
    const auto place = fleet_.placement(request.source_id, request.start, request.start);
    const auto packet = std::make_shared<const Packet>(Packet{
        request, decision.start, timing, framing.modem, place->position_ned_m, place->velocity_ned_mps,
        departure.answers, framing.rate_number, std::move(framing.format), std::move(framing.frame_bytes),
        false, power().transmit_energy_j(request.source_id, framing.modem, timing.duration)});
    if (decision.result == SendResult::kAccepted) {
      launch(packet, events);
    } else {
      add_departure(decision.start, {request, nullptr, packet});
    }
  }
  if (departure.answers) return;  // a modem's own answer gets no receipt
  Receipt receipt{request.vehicle, request.session, request.packet_sequence, decision.result, {}, {}};
  if (accepted) {
    receipt.start = decision.start;
    receipt.duration = timing.duration;
  }
  register_.decide(asked, receipt);
  if (!rule_.shard.serves(request.source_id)) return;
  events.push_back({request.start, std::move(receipt)});
}

// Every shard knows all states, so the sender's shard alone counts the receivers out of reach.
void PacketMedium::launch(const PacketPointer& sent, std::vector<MediumEvent>& events) {
  const PacketPointer packet = as_it_sounds(sent);
  const SimTime departure = packet->departure;
  const VehicleId source = packet->request.source_id, destination = packet->request.destination_id;
  const bool is_served = rule_.shard.serves(source);
  const PacketInterval span{packet, departure, departure + packet->timing.duration};
  const bool is_late = is_served && state_of(source).transmit(span, advanced_to_);
  if (is_served) {
    watch_.begin_transmission(*packet, events);
    add_sending(*packet, power(), events);
  }
  place_all(fleet_, departure, present_);
  const double reach_m = reach_ != nullptr ? reach_->reach_m(departure, packet->modem, fleet_, present_)
                                           : acoustics::kMaxBoundedRange;
  PacketOutcome others = outcome_out_of_reach(packet, reach_m);
  others.receivers = 0;
  const std::uint64_t identity = identity_for_draws(*packet);
  std::vector<Flight*> begun;
  for (const PlacedVehicle& receiver : present_) {
    if (receiver.id == source) continue;
    const double range_m = (receiver.placement.position_ned_m - packet->departure_ned_m).norm();
    if (stays_beyond(reach_m, range_m, receiver.placement.velocity_ned_mps.norm())) {
      if (receiver.id != destination) {
        ++others.receivers;
      } else if (is_served) {
        events.push_back(
            {departure, outcome_out_of_reach(packet, range_m, receiver.id, fleet_.name_of(receiver.id))});
      }
    } else if (rule_.shard.serves(receiver.id)) {
      Flight& flight = flights_.make_flight(packet, identity, receiver.id, fleet_.name_of(receiver.id));
      flight.conflicts_with_past = is_late;
      begun.push_back(&flight);
    }
  }
  if (propagation_.uses_bottom()) evaluate_together(begun, fleet_, propagation_, for_each_);
  for (Flight* flight : begun)
    if (!try_to_arrive(*flight, departure)) flights_.add(departure, *flight);
  if (is_served && others.receivers > 0) {
    events.push_back({departure, std::move(others)});
  }
}

PacketPointer PacketMedium::as_it_sounds(PacketPointer packet) const {
  if (!rule_.near_surface) return packet;
  const SimTime middle = packet->departure + SimDuration::from_seconds(packet->timing.duration.seconds() / 2);
  const acoustics::Environment& water = propagation_.environment(packet->departure);
  if (rule_.near_surface->is_under_water(packet->request.source_id, packet->departure_ned_m.z(), water,
                                         middle))
    return packet;
  Packet unheard = *packet;
  unheard.out_of_water = true;
  return std::make_shared<const Packet>(std::move(unheard));
}

bool PacketMedium::is_receiver_out_of_water(const Flight& flight) const {
  if (!rule_.near_surface) return false;
  const ReceivedSignal& signal = flight.signal;
  const SimTime middle = signal.begin + SimDuration::from_seconds((signal.end - signal.begin).seconds() / 2);
  return !rule_.near_surface->is_under_water(flight.receiver_id, flight.place.position_ned_m.z(),
                                             propagation_.environment(flight.packet->departure), middle);
}

bool PacketMedium::on_flight_event(SimTime at, std::vector<MediumEvent>& events) {
  Flight& flight = flights_.take_first();
  const Flight::Stage stage = flight.stage;
  const bool waits = stage == Flight::Stage::kTravelling
                         ? !try_to_arrive(flight, at)
                         : stage == Flight::Stage::kSolved && !sounds_.are_ready(flight, at);
  if (waits) {
    flights_.add(at, flight);
  } else if (stage == Flight::Stage::kSolved) {
    begin_reception(flight, at);
  } else if (stage == Flight::Stage::kPreamble) {
    end_preamble(flight, at, events);
  } else if (stage == Flight::Stage::kBits) {
    end_packet(flight, at, events);
    flights_.end(flight);
  }
  return !waits;
}

bool PacketMedium::try_to_arrive(Flight& flight, SimTime at) {
  if (!try_to_solve(flight, at, fleet_, propagation_)) return false;
  const SimTime first_sound = flight.first_sound();
  if (first_sound > at + kSolvedInTime && flight.solutions < kMaxSolutions) {
    flights_.add(first_sound, flight);
  } else if (!sounds_.any()) {
    begin_reception(flight, at);
  } else {
    flight.stage = Flight::Stage::kSolved;
    flights_.add(at, flight);
  }
  return true;
}

void PacketMedium::begin_reception(Flight& flight, SimTime at) {
  const SimTime arrival = flight.arrival();
  auto& budget = flight.reception.budget;
  // The reception was computed within a decimetre of this place; the range is that of the place itself.
  const auto place = fleet_.prediction(flight.receiver_id, arrival, at);
  if (place) budget.range_m = (place->position_ned_m - flight.packet->departure_ned_m).norm();
  sounds_.set_noise(flight, at);
  const Decibels noise = budget.noise_level - flight.modem.directivity_index;
  budget.snr = budget.received_level - noise - band_loss(flight.packet->modem, flight.modem);
  flight.receiver_absent = !fleet_.is_present(place);
  flight.large_scale = large_scale_of(flight, rule_.fading, rule_.seed);
  flight.signal = received_signal(flight, to_power_ratio(noise).value, rule_.fading);
  flight.out_of_water = flight.packet->out_of_water || is_receiver_out_of_water(flight);
  if (rule_.noise.has_bursts()) add_bursts(rule_.noise, rule_.seed, flight.receiver_id, flight.signal);
  flight.draws = draws_of(rule_.seed, *flight.packet, flight.identity, flight.receiver_id);
  flight.sounds_at = &state_of(flight.receiver_id);
  flight.conflicts_with_past |= flight.sounds_at->open(disturbing_sound(flight, reach_), advanced_to_);
  watch_.update_carrier_sense_at(flight.receiver_id, at);
  flight.stage = Flight::Stage::kPreamble;
  flights_.add(std::max(flight.signal.preamble_end, at), flight);
}

void PacketMedium::end_preamble(Flight& flight, SimTime at, std::vector<MediumEvent>& events) {
  ReceiverState& receiver = *flight.sounds_at;
  const ReceivedSignal& signal = flight.signal;
  const bool is_impossible = outcome_before_acquisition(flight) != OutcomeKind::kReceived ||
                             !power().has_power(flight.receiver_id, signal.begin) ||
                             is_shifted_too_far(flight) ||
                             fleet_.sleeps_during(flight.receiver_id, signal.begin, signal.preamble_end) ||
                             !receiver.transmitted_during(signal.begin, signal.preamble_end).empty();
  if (!is_impossible) flight.followed = receiver.followed_at(signal.preamble_end, *flight.packet);
  if (!is_impossible && !flight.followed) {
    if (!flight.is_evaluated && signal.fades)
      evaluate_signals(flight, flights_.due_by(at + kSoon, Flight::Stage::kPreamble), rule_.fading,
                       rule_.seed, for_each_);
    if (!flight.is_evaluated) evaluate_signal(flight, rule_.fading, rule_.seed);
    const auto others = interferers_of(flight, receiver, signal.begin, signal.preamble_end);
    flight.acquired = acquires(signal, others, flight.draws, flight.statistics);
    if (flight.acquired && signal.fades) {
      const double draw = timing_draw_of(rule_.seed, flight.identity, flight.receiver_id);
      flight.timing_error_s = timing_error_s(signal, others, draw);
    }
  }
  if (flight.acquired) {
    receiver.acquire({flight.packet, signal.begin, signal.end}, signal.preamble_end);
    watch_.detect(flight, events);
  }
  flight.stage = Flight::Stage::kBits;
  flights_.add(std::max(signal.end, at), flight);
}

void PacketMedium::end_packet(Flight& flight, SimTime at, std::vector<MediumEvent>& events) {
  OutcomeKind kind = decide_outcome(flight, at, fleet_, *flight.sounds_at);
  if (kind == OutcomeKind::kReceived &&
      is_lost_on_purpose(rule_.extra_loss, rule_.seed, *flight.packet, flight.receiver, flight.receiver_id)) {
    kind = OutcomeKind::kExtraLoss;
    flight.statistics.frames_good = 0;
  }
  PacketOutcome outcome =
      outcome_of(flight, kind, fleet_.equipment(), fleet_.listening(flight.receiver_id, at).promiscuous);
  add_receiving(flight, outcome, at, power(), events);
  const bool is_answered = asks_for_answer(outcome, fleet_.equipment());
  ModemWatch::end(flight, at, kind, events);
  events.push_back({at, std::move(outcome)});
  if (is_answered) {
    const ModemReply answer = answer_of(flight, at, fleet_.equipment().clocks);
    add_answer(answer);
    if (!rule_.shard.is_alone()) events.push_back({at, answer});
  }
  flight.sounds_at->close(flight.first_sound(), at);
}

void PacketMedium::on_listening_changed(const std::string& vehicle, SimTime from) {
  const auto id = fleet_.id_of(vehicle);
  if (id && rule_.shard.serves(*id)) watch_.update_carrier_sense_at(*id, std::max(from, advanced_to_));
}

ReceiverState& PacketMedium::state_of(VehicleId id) {
  return receivers_.try_emplace(id, rule_.max_lateness).first->second;
}

void PacketMedium::forget_before(SimTime time) {
  register_.forget_before(time);
  watch_.forget_before(time);
  answered_.erase(answered_.begin(), answered_.lower_bound({time, {}, {}, {}, {}}));
  for (auto& [id, receiver] : receivers_) receiver.forget(time + rule_.max_lateness);
  std::erase_if(receivers_, [&](const auto& receiver) {
    return receiver.second.silent() && fleet_.states_of(receiver.first) == nullptr;
  });
}

}  // namespace halocline::channel_server
