// The water between modems as a discrete-event simulation: packets start, travel, arrive and end at their
// exact instants.
//
// Model. A packet asked for at time s is decided at s: refused, or accepted; it then lasts
// overhead + 8 bytes / bit rate. Every vehicle present at s except the sender is a possible receiver, and
// each gets exactly one PacketEnd. Its first bit arrives at the t that solves
//     t = s + delay(sender at s, receiver at t),
// found by fixed point (a contraction: the error falls by v/c, 1e-3 for a submarine, each round). The receiver's
// way until t is not known at s: t is predicted, and solved again at the predicted instant with the states known
// by then, until it lies within a microsecond of the instant at which it was solved. The fate is decided at the
// last bit, t + duration: the receiver's states then show whether it is still there; levels are those of the
// geometry (sender at s, receiver at t).
//
// Repeatability. Decisions depend on the contents of states and requests, and on instants of simulation time,
// not on the order they were given in. Events come sorted by time, then receipts before packet ends, then
// receiver, sender, session, packet sequence. A request heard after its start is processed as of its start; what
// was due meanwhile comes out at once, with its exact instant, marked late.
//
// Left out: overlap and interference of packets, half duplex, bit errors, Doppler.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "channel_server/fleet.h"
#include "channel_server/packet.h"
#include "channel_server/propagation.h"
#include "channel_server/send_register.h"

namespace halocline::channel_server {

struct MediumRule {
  SimDuration greatest_lateness = SimDuration::from_milliseconds(10'000);   // of a request; 0 and up
  SimDuration greatest_earliness = SimDuration::from_milliseconds(60'000);  // of a request; 0 and up
};

class PacketMedium {
 public:
  // Fleet and propagation must outlive the medium; the fleet is told of states by its owner, before advance_to.
  PacketMedium(const Fleet& fleet, Propagation& propagation, MediumRule rule);

  // A transmission asked for, heard at `now`. A receipt when it can be given without waiting for the start:
  // a refusal for lateness or earliness, or the answer to a repetition. Otherwise the receipt is an event.
  std::optional<Receipt> transmit(const SendRequest& request, SimTime now);

  // When something next happens; SimTime::never() when the water is silent.
  SimTime next_event() const;
  // Everything that happens up to and including `time`, which does not decrease from call to call.
  std::vector<MediumEvent> advance_to(SimTime time);

  // Forgets receipts and occupations from before `time`; the owner gives an instant at least
  // greatest_lateness ago.
  void forget_before(SimTime time) { register_.forget_before(time); }
  // Another run: the water falls silent.
  void clear();

  std::size_t packets_in_flight() const { return flights_.size(); }  // counted per receiver
  const MediumRule& rule() const { return rule_; }

 private:
  // One packet on its way to one receiver.
  struct Flight {
    std::shared_ptr<const Packet> packet;
    VehicleId receiver_id = 0;
    std::string receiver;
    int times_solved = 0;
    bool first_bit_arrived = false;
    bool gone = false;  // when the first bit arrived
    double travel_time_s = 0;
    Vec3 arrival_ned_m = Vec3::Zero();  // where the first bit meets the receiver
    acoustics::LinkBudget budget;
    Decibels cutoff;
  };
  // Events at one instant happen in the order of the rest of the key.
  using DepartureKey = std::tuple<SimTime, std::string, std::int64_t, std::int64_t>;
  using FlightKey = std::tuple<SimTime, VehicleId, VehicleId, std::int64_t, std::int64_t, SimTime>;

  void depart(const SendRequest& request, std::vector<MediumEvent>& events);
  SendResult judge(const SendRequest& request, SimDuration duration) const;
  void launch(std::shared_ptr<const Packet> packet);
  void solve(Flight& flight, SimTime decided_at) const;
  void on_flight_event(Flight flight, SimTime at, std::vector<MediumEvent>& events);
  void meet_first_bit(Flight& flight, SimTime arrival, SimTime decided_at);
  PacketEnd end_of(const Flight& flight, SimTime at) const;
  void schedule(SimTime at, Flight flight);

  const Fleet& fleet_;
  Propagation& propagation_;
  MediumRule rule_;
  SendRegister register_;
  std::map<DepartureKey, SendRequest> departures_;
  std::map<FlightKey, Flight> flights_;
  SimTime advanced_to_ = SimTime::at_once();
};

}  // namespace halocline::channel_server
