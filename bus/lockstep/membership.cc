// SPDX-License-Identifier: BSD-3-Clause
#include "bus/lockstep/membership.h"

#include <algorithm>
#include <utility>

#include "bus/lockstep/agreement.h"
#include "bus/messages/channel_pattern.h"
#include "bus/transport/node_identity.h"
#include "core/check.h"

namespace halocline::conductor {

namespace {

constexpr std::size_t kLongestExpression = 256;

// Returns the objection to its subscriptions; empty if there is none.
std::string objection_to_subscriptions(const lockstep_join_t& join) {
  try {
    for (const std::string& expression : join.subscriptions) {
      if (expression.size() > kLongestExpression)
        return "it subscribes with an expression of more than 256 characters";
      [[maybe_unused]] const bus::ChannelPattern pattern(expression);
    }
  } catch (const InvalidArgument& problem) {
    return std::string("it subscribes to what is none: ") + problem.what();
  }
  return "";
}

}  // namespace

Membership::Membership(const Sequencer& sequencer, ParticipantLinks& links, GrantSender& grants,
                       std::string agreement, Outputs outputs)
    : sequencer_(sequencer),
      links_(links),
      grants_(grants),
      agreement_(std::move(agreement)),
      outputs_(std::move(outputs)) {}

void Membership::on_join(const lockstep_join_t& join, const RunState& run, SimTime steady) {
  ParticipantLink& link = links_.of(join.participant_name);
  if (link.incarnation == join.incarnation) return on_repeated_join(join, link, run, steady);
  if (is_too_late(join, run)) return notify(join.incarnation, run, lockstep_notice_t::OVER);
  const std::string objection = objection_to(join, link, run);
  if (!objection.empty()) return expel(join.incarnation, link.name, run, objection);
  if (link.incarnation != 0 || sequencer_.knows(link.name))
    outputs_.report("returned", "participant=" + link.name);
  links_.connect(link, join, steady);
  notify(link.incarnation, run, lockstep_notice_t::WELCOME);
  grant_next(link, steady);
}

void Membership::on_repeated_join(const lockstep_join_t& join, ParticipantLink& link, const RunState& run,
                                  SimTime steady) {
  link.last_received = steady;
  link.wants_to_leave = link.wants_to_leave || join.wants_to_leave != 0;
  const bool done = run.over || link.has_left;
  notify(join.incarnation, run, done ? lockstep_notice_t::OVER : lockstep_notice_t::WELCOME);
  // An earlier JOIN, with fewer turns taken, was received first.
  if (!link.up_to_date && join.turns_taken > link.turns_taken) {
    link.turns_taken = join.turns_taken;
    grant_next(link, steady);
  }
}

// True if the run ends without the participant, or if this incarnation has taken its last turn.
bool Membership::is_too_late(const lockstep_join_t& join, const RunState& run) const {
  const std::string& name = join.participant_name;
  if (run.over) return true;
  if (sequencer_.takes_part(name)) return false;
  const bool has_left = join.run_id == run.id && join.turns_taken > sequencer_.turns_taken(name);
  return run.ending || (sequencer_.knows(name) && sequencer_.turns_taken(name) == 0 && has_left);
}

std::string Membership::objection_to(const lockstep_join_t& join, const ParticipantLink& link,
                                     const RunState& run) const {
  if (link.take) return "its name is taken by the conductor itself";
  if (join.run_id != 0 && join.run_id != run.id) return "it took part in another run";
  if (const std::string other = bus::disagreement(join.scenario_digest, agreement_); !other.empty())
    return "it does not agree with the conductor: " + other;
  if (join.incarnation < link.incarnation) return "a later incarnation of it takes part";
  if (join.step_stage < 0 || join.step_stage > static_cast<int>(bus::Stage::kChannel))
    return "its stage is none";
  if (std::string objection = objection_to_subscriptions(join); !objection.empty()) return objection;
  const std::int64_t ahead = join.turns_taken - sequencer_.turns_taken(link.name);
  const auto& round = sequencer_.round();
  const bool in_round = std::find(round.begin(), round.end(), link.name) != round.end();
  return ahead <= (in_round ? 1 : 0) ? "" : "it took turns that the run does not count";
}

// Grants history if the participant has not taken all turns; otherwise the turn of the round, if it is in the
// round.
void Membership::grant_next(ParticipantLink& link, SimTime steady) {
  link.up_to_date = link.turns_taken >= sequencer_.turns_taken(link.name);
  if (!link.up_to_date) return grants_.grant_history(link, steady);
  link.wants_to_join = !sequencer_.takes_part(link.name);
  if (link.awaited) grants_.grant_turn({&link}, steady);
}

void Membership::on_history_taken(ParticipantLink& link, const lockstep_result_t& result, const RunState& run,
                                  SimTime steady) {
  link.timer.on_answered(steady);
  link.turns_taken += link.turns_granted;
  const bool at_the_end = link.turns_taken == sequencer_.turns_taken(link.name);
  if (at_the_end && result.outputs_digest != sequencer_.digest_of(link.name)) {
    const std::int64_t incarnation = link.incarnation;
    links_.disconnect(link);
    return expel(incarnation, link.name, run, "it publishes otherwise than its earlier incarnation");
  }
  grant_next(link, steady);
}

void Membership::expel(std::int64_t incarnation, const std::string& name, const RunState& run,
                       const std::string& reason) const {
  outputs_.report("expelled", "participant=" + name + " reason=\"" + reason + "\"");
  notify(incarnation, run, lockstep_notice_t::EXPELLED, reason);
}

void Membership::notify(std::int64_t incarnation, const RunState& run, std::int8_t kind,
                        const std::string& reason) const {
  lockstep_notice_t notice;
  notice.run_id = run.id;
  notice.incarnation = incarnation;
  notice.notice_kind = kind;
  notice.reason = reason;
  outputs_.notice(notice);
}

}  // namespace halocline::conductor
