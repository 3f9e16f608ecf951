// SPDX-License-Identifier: BSD-3-Clause
// A discrete-event simulation of packets in the water between modems: packets depart, travel, arrive, disturb
// each other and end, each at its exact instant.
//
// Model. A request to transmit at time s is decided at s: it is refused, accepted, or queued by a modem that
// queues (at most 16 wait; each starts when those before it have ended). A sender without a state at s may
// have sent its first state too recently for it to count (the state lag, state_history.h); its request is
// deferred to s + lag, so a packet requested together with the very first state is transmitted. Every vehicle
// present at a packet's departure, except the sender, is a possible receiver and gets exactly one
// PacketOutcome.
//   flight.h              when and how the packet arrives
//   receiver_state.h      what else sounds at the receiver meanwhile
//   reception_decision.h  acquisition at the end of the preamble, decoding at the last bit
//   modem_watch.h         what the modem reports meanwhile
// packet.h lists the possible outcomes and the order in which they are tested. At a receiver a packet lasts
// duration / Doppler factor. A modem that has acquired a packet follows it to its end, even if it is weak or
// addressed to another modem, and acquires nothing that arrives meanwhile. A transmission of its own ends
// that, and spoils every reception it overlaps. A ping that reached its addressee is answered
// kReplyTurnaround later, and so is a packet that asks for an acknowledgement; a ping to all is answered by
// each transponder that received it. A modem that is busy at that time does not answer. An answer is a packet
// like any other.
//
// Repeatability. Decisions depend on the contents of states and requests, on the seed, and on instants of
// simulation time, but not on the order in which messages arrived. Events are sorted by time, then receipts
// before outcomes, then by receiver, sender and packet sequence. A request received after its start is
// processed as of its start, among all that sounded then. What should have happened meanwhile is reported at
// once, with its exact instant, and marked late. Decisions made before the request was received are not
// revised: neither for packets that it would have disturbed, nor for a receiver that would have acquired it.
//
// Waiting. When the propagation is not ready for an arrival (Propagation::is_ready), that event and all later
// ones wait, and take place at their exact instants once it is ready. Waiting changes when events are known,
// never what happens.
//
// Error. The arrival at a receiver that turns towards the sound while it travels is found late, by at most 2
// v / c of the travel time (a few ms). A decision at that receiver within this gap does not include that
// sound.
//
// Energy. A vehicle with a battery (vehicles/vehicle_power.h) spends transmit_power_w over the duration of
// its transmissions, and its receiving power while it follows a packet that it acquired; each gives an
// EnergyUse. A modem without power does not send, answer or acquire, and its queued packets are never sent; a
// transmission that has begun is completed.
//
// Shards. Several media may share the water, each serving part of the vehicles (rule.shard). Each medium gets
// all states and requests and decides all of them, but follows packets only to the receivers it serves. Only
// a modem's own answer depends on what another shard's vehicle received. The answer leaves kReplyTurnaround
// after that reception, and add_answer() passes it on in that time.
//
// Not modelled: echoes of a modem's own transmissions, and motion of the receiver between the paths of one
// packet.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "acoustics/fading/path_fading.h"
#include "acoustics/noise/noise_variation.h"
#include "channel_server/packets/extra_loss.h"
#include "channel_server/packets/flight.h"
#include "channel_server/packets/flight_queue.h"
#include "channel_server/packets/medium_event.h"
#include "channel_server/packets/modem_watch.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_framing.h"
#include "channel_server/packets/platform_noise.h"
#include "channel_server/packets/receiver_state.h"
#include "channel_server/packets/send_decision.h"
#include "channel_server/packets/send_register.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/reach.h"
#include "channel_server/propagation/surface_ends.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/shard.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_power.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/for_each.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

// The parameters of a medium.
struct MediumRule {
  // Largest lateness of a request; at least 0.
  SimDuration max_lateness = SimDuration::from_milliseconds(10'000);
  // Largest earliness of a request; at least 0.
  SimDuration max_earliness = SimDuration::from_milliseconds(60'000);
  std::uint64_t seed = 1;                // seed of all random draws
  acoustics::FadingModel fading = {};    // fading of every link
  acoustics::NoiseVariation noise = {};  // variation of the sea's ambient noise
  Shard shard = {};  // the vehicles that this medium serves, if several media share the water
  std::vector<ExtraLoss> extra_loss = {};
  std::optional<SurfaceEnds> near_surface = {};  // ends that waves may leave out of the water; empty: none
};

class PacketMedium {
 public:
  static constexpr std::size_t kMaxQueued = kMaxQueuedSends;

  // The references must outlive the medium. `for_each` shares out the computation of the paths of one packet.
  // The owner adds states to the registry before advance_to(). Without `reach` every vehicle is within reach.
  // Throws if a bound of the rule is negative.
  PacketMedium(const VehicleRegistry& fleet, Propagation& propagation, MediumRule rule,
               ReachModel* reach = nullptr, ForEach for_each = one_after_the_other);

  // Takes a request received at `now`; `latest` is the time of its sender, which the medium may lag behind.
  // Returns a receipt when it can be given without waiting for the start: the known receipt for a repetition,
  // however old, or a refusal because the start is too late or too early. Otherwise the receipt comes as an
  // event.
  [[nodiscard]] std::optional<Receipt> transmit(const SendRequest& request, SimTime now,
                                                SimTime latest = SimTime::at_once());

  // Adds the answer that a modem served by another shard will send. A repetition changes nothing.
  void add_answer(const ModemReply& answer);

  // Tells the medium that a vehicle's modem changes how it listens at `from`, which the registry already
  // holds.
  void on_listening_changed(const std::string& vehicle, SimTime from);

  // Returns the instant of the next event; SimTime::never() when the water is silent, or waits.
  SimTime next_event() const;
  // Returns when a packet that a modem may answer next departs, arrives or ends, even when the water waits;
  // SimTime::never() without such a packet.
  SimTime next_answerable() const;
  // Returns all events up to and including `time`, or up to the first event that waits. `time` must not
  // decrease from call to call. The result is valid until the next call.
  const std::vector<MediumEvent>& advance_to(SimTime time);
  // True when the last advance_to() ended at an event that waits for the propagation. advance_to() is to be
  // called again when the propagation may be ready.
  bool is_waiting() const { return waiting_; }

  // Forgets receipts and transmissions from before `time`, which must be at least max_lateness ago.
  void forget_before(SimTime time);

  std::size_t packets_in_flight() const { return flights_.size(); }  // counted per receiver
  const MediumRule& rule() const { return rule_; }

 private:
  // A request that waits for its start; with `queued`, a packet that was queued and waits for its departure.
  struct Departure {
    SendRequest request;
    std::shared_ptr<const Packet> answers;  // for a modem's answer: the packet that it answers
    std::shared_ptr<const Packet> queued;
    bool is_deferred = false;  // deferred by the state lag
  };
  // Departures at one instant take place in the order of the rest of the key.
  using DepartureKey =
      std::tuple<SimTime, std::string, PacketKind, std::int64_t, VehicleId, bool, std::int64_t>;

  void add_departure(SimTime at, Departure departure);
  void depart(Departure departure, std::vector<MediumEvent>& events);
  [[nodiscard]] bool must_be_deferred(const Departure& departure) const;
  const VehiclePower& power() const { return fleet_.equipment().power; }
  void launch(const PacketPointer& sent, std::vector<MediumEvent>& events);

  // Handles the next event of the first flight; returns false when it must wait for the propagation.
  bool on_flight_event(SimTime at, std::vector<MediumEvent>& events);
  // Solves for the arrival of a flight that is not in the queue and adds it to the queue. Returns false and
  // does nothing when it must wait for the propagation.
  [[nodiscard]] bool try_to_arrive(Flight& flight, SimTime at);
  void begin_reception(Flight& flight, SimTime at);
  // Returns the packet, marked when the waves leave its sender out of the water.
  PacketPointer as_it_sounds(PacketPointer packet) const;
  // True when the waves leave the receiver out of the water at the middle of the packet.
  bool is_receiver_out_of_water(const Flight& flight) const;
  void end_preamble(Flight& flight, SimTime at, std::vector<MediumEvent>& events);
  void end_packet(Flight& flight, SimTime at, std::vector<MediumEvent>& events);
  ReceiverState& state_of(VehicleId id);

  const VehicleRegistry& fleet_;
  Propagation& propagation_;
  MediumRule rule_;
  ReachModel* reach_;
  ForEach for_each_;
  PlatformNoise sounds_;
  SendRegister register_;
  ModemWatch watch_;
  std::map<DepartureKey, Departure> departures_;
  FlightQueue flights_;
  std::unordered_map<VehicleId, ReceiverState> receivers_;  // only vehicles that are known
  std::set<std::tuple<SimTime, VehicleId, VehicleId, std::int64_t, std::int64_t>>
      answered_;  // answers already added, see add_answer()
  // Working memory of launch() and advance_to(), reused from call to call.
  std::vector<PlacedVehicle> present_;
  std::vector<MediumEvent> events_;
  SimTime advanced_to_ = SimTime::at_once();
  bool waiting_ = false;
  mutable bool may_be_answered_ = false;  // false when no departure and no flight may be answered
};

}  // namespace halocline::channel_server
