// SPDX-License-Identifier: BSD-3-Clause
// The water between modems as a discrete-event simulation: packets start, travel, arrive, disturb each other
// and end at their exact instants.
//
// Model. A packet requested for time s is decided at s: refused, accepted, or queued by a modem that queues
// (16 wait at most; each starts when those before it have ended). A sender that is nowhere at s is given the
// state lag (state_history.h) until its first state counts: the packet is then requested for s + lag, so one
// requested with the very first state is transmitted. Every vehicle present at its departure except the
// sender is a possible receiver, and each gets exactly one PacketOutcome.
//   flight.h              when and how it arrives
//   receiver_state.h      what else sounds at the receiver meanwhile
//   reception_decision.h  whether it is acquired at the end of its preamble, and right at its last bit
//   modem_watch.h         what its modem reports meanwhile
// packet.h lists the possible outcomes and in which order the first that holds is found. A packet lasts
// duration / doppler factor at a receiver. A modem that has acquired a packet follows it to its end, even if
// weak or for another; what arrives meanwhile it does not acquire. A transmission of its own ends that, and
// every reception it overlaps. A ping that its addressee received is answered kReplyTurnaround later, one to
// all by each transponder that received it, as is a packet that wants an acknowledgement, unless that modem
// is busy then: the answer is a packet like any other.
//
// Repeatability. Decisions depend on the contents of states and requests, on the seed, and on instants of
// simulation time, not on the order they were given in. Events are sorted by time, then receipts before
// outcomes, then receiver, sender, packet sequence. A request received after its start is processed as of its
// start, among all that sounded then; what was due meanwhile comes out at once, with its exact instant,
// marked late. What was decided before it was received stays: packets it would have disturbed, and a receiver
// that would have acquired it.
//
// Waiting. Where the propagation is not ready for an arrival (Propagation::is_ready), that event and all
// after it wait, and happen at their exact instants once it is: waiting changes when events are known, never
// what happens.
//
// Error. A receiver that turns towards the sound while it travels is met late by 2 v / c of the travel time
// at most (a few ms); a decision at that receiver within this gap does not know of the sound yet.
//
// Energy. A vehicle with a battery (vehicles/vehicle_power.h) spends transmit_power_w over the duration of
// what it sends, and its receiving power while it follows a packet it acquired; each gives an EnergyUse.
// Without power a modem sends, answers and acquires nothing, and what waits in its queue is never sent; what
// it had begun to send goes on to its end.
//
// Shards. A medium that shares the water with others (rule.shard) gets all states and requests, decides all
// of them, and follows packets only to the receivers it serves. Only a modem's own answer depends on what
// another shard's vehicle received; it leaves kReplyTurnaround after that, and add_answer() passes it on
// meanwhile.
//
// Left out: echoes of a modem's own transmissions, motion of the receiver between the paths of one packet.
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
#include "channel_server/packets/receiver_state.h"
#include "channel_server/packets/send_decision.h"
#include "channel_server/packets/send_register.h"
#include "channel_server/packets/vehicle_sounds.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/reach.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/shard.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_power.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/for_each.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

struct MediumRule {
  SimDuration max_lateness = SimDuration::from_milliseconds(10'000);   // of a request; 0 and up
  SimDuration max_earliness = SimDuration::from_milliseconds(60'000);  // of a request; 0 and up
  std::uint64_t seed = 1;                                              // of all draws
  acoustics::FadingModel fading = {};                                  // of every link
  acoustics::NoiseVariation noise = {};                                // of the sea's
  Shard shard = {};  // of several media of one water, each with all requests
  std::vector<ExtraLoss> extra_loss = {};
};

class PacketMedium {
 public:
  static constexpr std::size_t kMaxQueued = kMaxQueuedSends;

  // All must outlive the medium; `for_each` shares out what the paths of one packet cost; the owner adds the
  // states to the registry before advance_to. Without `reach` everybody is within reach.
  PacketMedium(const VehicleRegistry& fleet, Propagation& propagation, MediumRule rule,
               ReachModel* reach = nullptr, ForEach for_each = one_after_the_other);

  // A request received at `now`, of a medium that may lag behind the time of its senders, `latest`. A receipt
  // when it can be given without waiting for the start: the answer to a repetition, however old, or a refusal
  // for lateness or earliness. Otherwise the receipt is an event.
  [[nodiscard]] std::optional<Receipt> transmit(const SendRequest& request, SimTime now,
                                                SimTime latest = SimTime::at_once());

  // A modem that another shard serves will answer a packet; a repetition changes nothing.
  void add_answer(const ModemReply& answer);

  // The registry has learnt that a vehicle's modem listens otherwise from `from` on.
  void on_listening_changed(const std::string& vehicle, SimTime from);

  // When something next happens; SimTime::never() when the water is silent, or waits.
  SimTime next_event() const;
  // When a packet that a modem may answer next departs, arrives or ends; SimTime::never() without one, though
  // the water waits.
  SimTime next_answerable() const;
  // Everything that happens up to and including `time`, which does not decrease from call to call; up to the
  // first event that waits. Valid until the next call.
  const std::vector<MediumEvent>& advance_to(SimTime time);
  // Whether the last advance_to() ended at an event that waits for the propagation: to be called again when
  // that may be ready.
  bool is_waiting() const { return waiting_; }

  // Forgets receipts and occupations from before `time`; the owner gives an instant at least
  // max_lateness ago.
  void forget_before(SimTime time);
  // Another run: the water falls silent.
  void clear();

  std::size_t packets_in_flight() const { return flights_.size(); }  // counted per receiver
  const MediumRule& rule() const { return rule_; }

 private:
  // A request that waits for its start; with a packet, one that was queued and waits for its departure.
  struct Departure {
    SendRequest request;
    std::shared_ptr<const Packet> answers;  // of a modem's answer: what asked for it
    std::shared_ptr<const Packet> queued;
    bool is_put_off = false;  // by the state lag
  };
  // Events at one instant happen in the order of the rest of the key.
  using DepartureKey =
      std::tuple<SimTime, std::string, PacketKind, std::int64_t, VehicleId, bool, std::int64_t>;

  void add_departure(SimTime at, Departure departure);
  void depart(Departure departure, std::vector<MediumEvent>& events);
  [[nodiscard]] bool must_be_put_off(const Departure& departure) const;
  const VehiclePower& power() const { return fleet_.equipment().power; }
  void launch(const PacketPointer& packet, std::vector<MediumEvent>& events);

  // Of the first flight; false: it must wait for the propagation.
  bool on_flight_event(SimTime at, std::vector<MediumEvent>& events);
  // Solves for the arrival of a flight that is not in the queue and puts it there; false, and nothing: it
  // must wait.
  [[nodiscard]] bool try_to_arrive(Flight& flight, SimTime at);
  void begin_reception(Flight& flight, SimTime at);
  void end_preamble(Flight& flight, SimTime at, std::vector<MediumEvent>& events);
  void end_packet(Flight& flight, SimTime at, std::vector<MediumEvent>& events);
  ReceiverState& state_of(VehicleId id);

  const VehicleRegistry& fleet_;
  Propagation& propagation_;
  MediumRule rule_;
  ReachModel* reach_;
  ForEach for_each_;
  VehicleSounds sounds_;
  SendRegister register_;
  ModemWatch watch_;
  std::map<DepartureKey, Departure> departures_;
  FlightQueue flights_;
  std::unordered_map<VehicleId, ReceiverState> receivers_;  // of vehicles that are known
  std::set<std::tuple<SimTime, VehicleId, VehicleId, std::int64_t, std::int64_t>>
      answered_;  // see add_answer
  // Of one launch and of one advance, whose memory serves the next.
  std::vector<PlacedVehicle> present_;
  std::vector<MediumEvent> events_;
  SimTime advanced_to_ = SimTime::at_once();
  bool waiting_ = false;
  mutable bool may_be_answered_ = false;  // false: none of departures and flights
};

}  // namespace halocline::channel_server
