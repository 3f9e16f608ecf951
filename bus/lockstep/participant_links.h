// SPDX-License-Identifier: BSD-3-Clause
// Conductor's connections to the participants of a run, by name and by the incarnation that is connected at
// present.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "bus/lockstep/lockstep_wire.h"
#include "bus/lockstep/retransmission_timer.h"
#include "bus/messages/messages.h"
#include "core/sim_time.h"

namespace halocline::conductor {

// Makes a participant of the conductor's process take a turn.
using TakeTurn = std::function<lockstep_result_t(const lockstep_turn_t&)>;

// One participant: its incarnation, its progress, and the unanswered grant.
struct ParticipantLink {
  std::string name;
  std::int64_t incarnation = 0;  // 0: none connected, or local
  lockstep_join_t join;
  TakeTurn take;                 // for a local participant
  std::int64_t turns_taken = 0;  // turns of this incarnation, as far as is known
  bool up_to_date = false;       // it has taken all turns of its name
  bool wants_to_join = false;    // to be admitted between rounds
  bool wants_to_leave = false;
  bool has_left = false;  // this incarnation has taken its last turn
  bool awaited = false;   // it is in the round, and its result has not been received
  bus::Bytes granted;
  std::int32_t turns_granted = 0;
  bus::SliceCollector answer;
  RetransmissionTimer timer;
  SimTime last_received;  // steady
};

class ParticipantLinks {
 public:
  // Returns the link of a name, and creates it if the name is new. The address never changes.
  ParticipantLink& of(const std::string& name);
  const ParticipantLink* find(const std::string& name) const;
  // Returns null if that incarnation is not connected.
  ParticipantLink* of_incarnation(std::int64_t incarnation);

  void connect(ParticipantLink& link, const lockstep_join_t& join, SimTime steady);
  void disconnect(ParticipantLink& link);

  auto begin() { return links_.begin(); }
  auto end() { return links_.end(); }

 private:
  std::map<std::string, ParticipantLink> links_;
  std::map<std::int64_t, ParticipantLink*> connected_;
};

}  // namespace halocline::conductor
