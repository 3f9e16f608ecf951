// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/packets/flight.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/link_fading.h"
#include "acoustics/fading/measured_fading.h"
#include "acoustics/link/ray_doppler.h"
#include "acoustics/math/frequency_band.h"
#include "acoustics/reception/signal_history.h"
#include "acoustics/sea/environment.h"
#include "core/elementary.h"
#include "core/frames.h"
#include "core/units.h"

namespace halocline::channel_server {
namespace {

// The fixed-point iteration for the arrival ends when a round changes it by less than this. At v/c = 0.07
// (100 m/s, the fastest that a state may be) it takes 9 rounds.
constexpr double kSettledS = 1e-10;
constexpr int kMaxRounds = 50;
constexpr int kMaxPropagationCalls = 3;
// A reception is reused for a receiver within this distance of the position for which it was evaluated, and
// within this velocity: 0.01 m/s shifts a frequency by 7e-6 of itself.
constexpr double kSamePlaceM = 0.1, kSameVelocityMps = 0.01;

SimDuration shrunk(SimDuration duration, double doppler_factor) {
  return SimDuration::from_seconds(duration.seconds() / doppler_factor);
}

bool serves(const Flight& flight, const LinkEnd& end) {
  if (flight.propagation_calls == 0 || !(flight.modem == *end.modem)) return false;
  const bool same = (end.position_ned_m - flight.place.position_ned_m).norm() <= kSamePlaceM &&
                    (end.velocity_ned_mps - flight.place.velocity_ned_mps).norm() <= kSameVelocityMps;
  return same || flight.propagation_calls >= kMaxPropagationCalls;
}

// Returns the slowness vector at the receiver along the first significant path, or along the straight line
// without a path, s/m.
Vec3 slowness_at(const Flight& flight, const acoustics::Environment& water) {
  const Vec3 &from = flight.packet->departure_ned_m, &to = flight.place.position_ned_m;
  const double speed_mps = sound_speed_at(water, to);
  const auto& paths = flight.reception.paths;
  const Vec3 way = to - from;
  const double angle = paths.empty() ? elementary::atan2(way.z(), elementary::hypot(way.x(), way.y()))
                                     : paths[first_significant(paths)].arrival_angle_rad;
  return acoustics::ray_direction(from, to, angle) / speed_mps;
}

// Stores a reception computed for the receiver at `end`, with the water at the departure.
void evaluate(Flight& flight, const LinkEnd& end, Reception reception, const acoustics::Environment& water) {
  ++flight.propagation_calls;
  flight.modem = *end.modem;
  flight.place = {end.position_ned_m, end.velocity_ned_mps, {}};
  flight.reception = std::move(reception);
  const auto& paths = flight.reception.paths;
  flight.window = paths.empty() ? acoustics::GuardWindow() : best_window(paths, flight.modem);
  flight.solved_delay_s =
      paths.empty() ? flight.reception.budget.delay_s : paths[first_significant(paths)].delay_s;
  flight.slowness_s_per_m = slowness_at(flight, water);
}

// Returns the delay, in excess of that of the reception, that the receiver's motion since then causes, s.
double shift_s(const Flight& flight) { return flight.travel_time_s - flight.solved_delay_s; }

// Returns when a path of the reception begins to sound at the receiver.
SimTime begin_of(const Flight& flight, const Arrival& path) {
  return flight.packet->departure + SimDuration::from_seconds(path.delay_s + shift_s(flight));
}

acoustics::FadingLink fading_link(const Flight& flight, std::uint64_t seed) {
  const VehicleId from = flight.packet->request.source_id, to = flight.receiver_id;
  const double speed_mps =
      std::max(flight.packet->velocity_ned_mps.norm(), flight.place.velocity_ned_mps.norm());
  return {seed, static_cast<std::uint32_t>(std::min(from, to)),
          static_cast<std::uint32_t>(std::max(from, to)), from > to, speed_mps < acoustics::kStillSpeedMps};
}

// Returns the instant at which the receiver's position is predicted. Before the first reception it is the
// departure plus the travel time along the straight line to the receiver's position at the departure; after
// it, the arrival of the last solution.
SimTime expected_arrival(const Flight& flight, SimTime decided_at, const VehicleRegistry& fleet,
                         Propagation& propagation) {
  if (flight.solutions > 0 && flight.propagation_calls > 0) return flight.arrival();
  const SimTime departure = flight.packet->departure;
  const auto place = fleet.prediction(flight.receiver_id, departure, decided_at);
  if (!place) return flight.arrival();
  const Vec3& from = flight.packet->departure_ned_m;
  const double speed_mps = sound_speed_at(propagation.environment(departure), from);
  return departure + SimDuration::from_seconds((place->position_ned_m - from).norm() / speed_mps);
}

// Returns the receiver's end of the link for the next evaluation of the propagation, with what is known at
// `decided_at`; empty when the receiver has no position.
std::optional<LinkEnd> next_end(const Flight& flight, SimTime decided_at, const VehicleRegistry& fleet,
                                Propagation& propagation) {
  const SimTime expected = expected_arrival(flight, decided_at, fleet, propagation);
  const auto predicted = fleet.prediction(flight.receiver_id, expected, decided_at);
  if (!predicted) return std::nullopt;
  return LinkEnd{flight.receiver_id, predicted->position_ned_m, predicted->velocity_ned_mps,
                 &receiving_modem(fleet.modem(flight.receiver_id, expected), flight.packet->modem)};
}

}  // namespace

SimTime Flight::first_sound() const {
  const auto& paths = reception.paths;
  return paths.empty() ? arrival() : std::min(arrival(), begin_of(*this, paths.front()));
}

SimTime Flight::sync_time() const {
  return reception.paths.empty() ? arrival() : begin_of(*this, reception.paths[window.first]);
}

double Flight::doppler_factor() const {
  return reception.paths.empty() ? 1 : reception.paths[window.strongest].doppler_factor;
}

void evaluate_together(const std::vector<Flight*>& begun, const VehicleRegistry& fleet,
                       Propagation& propagation, const ForEach& for_each) {
  if (begun.empty()) return;
  const Packet& packet = *begun.front()->packet;
  std::vector<EndPair> links;
  std::vector<Flight*> flights;  // the flights of `links`
  for (Flight* flight : begun) {
    const auto end = next_end(*flight, packet.departure, fleet, propagation);
    if (!end) continue;
    links.push_back({packet.link_end(), *end});
    flights.push_back(flight);
  }
  auto receptions = propagation.packet_receptions(packet.departure, links, for_each);
  const acoustics::Environment& water = propagation.environment(packet.departure);
  for_each(links.size(), [&](std::size_t i) {
    if (receptions[i]) evaluate(*flights[i], links[i].to, *std::move(receptions[i]), water);
  });
}

bool try_to_solve(Flight& flight, SimTime decided_at, const VehicleRegistry& fleet,
                  Propagation& propagation) {
  const auto end = next_end(flight, decided_at, fleet, propagation);
  if (end && !serves(flight, *end)) {
    const SimTime departure = flight.packet->departure;
    const LinkEnd from = flight.packet->link_end();
    if (!propagation.is_ready_for_packet(departure, from, *end)) return false;
    evaluate(flight, *end, propagation.reception_without_capacity(departure, from, *end),
             propagation.environment(departure));
  }
  ++flight.solutions;
  if (!end) return true;
  const StateHistory& states = *fleet.states_of(flight.receiver_id);
  // Fixed point of the travel time tau, with the receiver at x(s + tau):
  //   tau = delay(x0) + p . (x(s + tau) - x0)
  for (int round = 0; round < kMaxRounds; ++round) {
    const auto receiver = states.at(flight.arrival(), decided_at, fleet.rule());
    const Vec3 moved = receiver->position_ned_m - flight.place.position_ned_m;
    const double travel_time_s = std::max(flight.solved_delay_s + flight.slowness_s_per_m.dot(moved), 0.0);
    const double change_s = std::abs(travel_time_s - flight.travel_time_s);
    flight.travel_time_s = travel_time_s;
    if (change_s < kSettledS) break;
  }
  return true;
}

// Each path sounds for duration / its Doppler factor.
AudiblePacket audible_packet(const Flight& flight) {
  AudiblePacket audible{flight.packet, flight.signal.begin, flight.signal.end, {}};
  audible.paths.reserve(flight.reception.paths.size());
  for (const Arrival& path : flight.reception.paths) {
    const SimTime begin = begin_of(flight, path);
    const SimTime end = begin + shrunk(flight.packet->timing.duration, path.doppler_factor);
    audible.paths.push_back(
        {begin, end, to_power_ratio(path.level).value * flight.large_scale * flight.large_scale});
    audible.begin = std::min(audible.begin, begin);
    audible.end = std::max(audible.end, end);
  }
  return audible;
}

AudiblePacket disturbing_sound(const Flight& flight, const ReachModel* reach) {
  AudiblePacket audible = audible_packet(flight);
  double power = 0;
  for (const AudiblePath& path : audible.paths) power += path.power;
  const bool is_weak = reach != nullptr && !reach->disturbs(power, flight.signal.noise);
  if (is_weak || flight.packet->out_of_water) audible.paths.clear();
  return audible;
}

double large_scale_of(const Flight& flight, const acoustics::FadingModel& fading, std::uint64_t seed) {
  if (!fading.enabled) return 1;
  return acoustics::LinkFading(fading, fading_link(flight, seed)).large_scale(flight.sync_time());
}

ReceivedSignal received_signal(const Flight& flight, double noise, const acoustics::FadingModel& fading) {
  const double factor = flight.doppler_factor();
  const bool fades = fading.enabled || flight.reception.measured;
  ReceivedSignal signal{flight.packet, noise, flight.sync_time(), {}, {}, fades, {}, {}};
  signal.preamble_end = signal.begin + shrunk(flight.packet->timing.preamble, factor);
  signal.end = signal.begin + shrunk(flight.packet->timing.duration, factor);
  return signal;
}

void evaluate_signal(Flight& flight, const acoustics::FadingModel& fading, std::uint64_t seed) {
  flight.is_evaluated = true;
  if (flight.reception.paths.empty()) return;
  const auto& measured = flight.reception.measured;
  ReceivedSignal& signal = flight.signal;
  // The receiver gets only the power within its own band.
  const double shared = to_power_ratio(-band_loss(flight.packet->modem, flight.modem)).value;
  const auto& paths = flight.reception.paths;
  const acoustics::FadingLink link = fading_link(flight, seed);
  const acoustics::Synchronisation sync{&flight.modem, flight.window};
  const acoustics::Band band = flight.packet->modem.band();
  const acoustics::ReceivedTiming timing{(signal.preamble_end - signal.begin).seconds(),
                                         (signal.end - signal.begin).seconds()};
  signal.history =
      measured ? signal_history(acoustics::MeasuredFading(measured, link), flight.large_scale, paths, sync,
                                band, signal.begin, timing)
               : signal_history(fading, link, flight.large_scale, paths, sync, band, signal.begin, timing);
  for (double& power : signal.history.signal) power *= shared;
  for (double& power : signal.history.echoes) power *= shared;
  for (double& power : signal.history.fast_fading) power *= shared;
  const double kept = doppler_share(flight.modem, paths[flight.window.strongest], band.centre_hz());
  if (signal.fades && kept < 1) {
    signal.without_shift = signal.history;
    signal.history = shifted_history(std::move(signal.history), kept);
  }
}

}  // namespace halocline::channel_server
