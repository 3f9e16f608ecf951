// SPDX-License-Identifier: BSD-3-Clause
// Membership of a lockstep run: admits participants and returning incarnations, replays to them the turns
// that they have not taken, and expels participants that cannot take part.
//
// A participant that was killed returns as a new incarnation with a higher number. It takes the turns of the
// run's history again, and the digest of the messages that it publishes must equal that of its predecessor.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "bus/lockstep/grant_sender.h"
#include "bus/lockstep/participant_links.h"
#include "bus/lockstep/sequencer.h"
#include "core/sim_time.h"

namespace halocline::conductor {

struct RunState {
  std::int64_t id = 0;
  bool ending = false;  // only last turns remain
  bool over = false;
};

class Membership {
 public:
  struct Outputs {
    std::function<void(const lockstep_notice_t&)> notice;
    std::function<void(const std::string& event, const std::string& detail)> report;
  };
  // `agreement`: text on which participants must agree (agreement.h). All references must outlive this
  // object.
  Membership(const Sequencer& sequencer, ParticipantLinks& links, GrantSender& grants, std::string agreement,
             Outputs outputs);

  void on_join(const lockstep_join_t& join, const RunState& run, SimTime steady);
  // Ends a grant_history(), all of whose turns were taken; `result` is that of the last turn.
  void on_history_taken(ParticipantLink& link, const lockstep_result_t& result, const RunState& run,
                        SimTime steady);
  // `kind`: an enumerator of lockstep_notice_t.
  void notify(std::int64_t incarnation, const RunState& run, std::int8_t kind,
              const std::string& reason = "") const;

 private:
  void on_repeated_join(const lockstep_join_t& join, ParticipantLink& link, const RunState& run,
                        SimTime steady);
  [[nodiscard]] bool is_too_late(const lockstep_join_t& join, const RunState& run) const;
  [[nodiscard]] std::string objection_to(const lockstep_join_t& join, const ParticipantLink& link,
                                         const RunState& run) const;
  void grant_next(ParticipantLink& link, SimTime steady);
  void expel(std::int64_t incarnation, const std::string& name, const RunState& run,
             const std::string& reason) const;

  const Sequencer& sequencer_;
  ParticipantLinks& links_;
  GrantSender& grants_;
  std::string agreement_;
  Outputs outputs_;
};

}  // namespace halocline::conductor
