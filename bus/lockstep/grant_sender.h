// SPDX-License-Identifier: BSD-3-Clause
// Sender of grants to participants; retransmits grants that are not answered.
//
// Identical turns are sent in one grant to all addressees, others in one grant each. Bodies longer than a
// datagram are sent in slices. A retransmission addresses only the participants whose answer is missing.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bus/lockstep/participant_links.h"
#include "bus/lockstep/sequencer.h"
#include "core/sim_time.h"

namespace halocline::conductor {

class GrantSender {
 public:
  // `send` completes the grant (run_id) and publishes it on the channel.
  using Send = std::function<void(const std::string& channel, lockstep_grant_t& grant)>;
  GrantSender(const Sequencer& sequencer, Send send) : sequencer_(sequencer), send_(std::move(send)) {}

  // Grants the turn of the present round to each of these participants, all of which are up to date.
  void grant_turn(const std::vector<ParticipantLink*>& links, SimTime steady);
  // Grants the next turns of the run's history that this incarnation has not taken.
  void grant_history(ParticipantLink& link, SimTime steady);

  // Returns the number of the first turn in the grant that a participant has not answered.
  std::int64_t first_turn(const ParticipantLink& link) const;

  void retransmit(ParticipantLinks& links, SimTime steady);
  // Steady time before which nothing is to be retransmitted.
  SimTime next_retransmission() const { return next_retransmission_; }
  std::int64_t retransmissions() const { return retransmissions_; }

 private:
  void send(const std::vector<ParticipantLink*>& links, SimTime steady);
  void send_one(std::span<ParticipantLink* const> links);

  const Sequencer& sequencer_;
  Send send_;
  SimTime next_retransmission_ = SimTime::never();
  std::int64_t retransmissions_ = 0;
};

}  // namespace halocline::conductor
