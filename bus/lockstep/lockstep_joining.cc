// How participants join, come back, are brought up to date and are put out (lockstep_conductor.h).
#include <algorithm>
#include <utility>

#include "bus/lockstep/lockstep_conductor.h"

namespace halocline::conductor {
namespace {

// Turns of the past that are told in one grant: about a slice.
constexpr std::size_t kPastBytesPerGrant = 40'000;

}  // namespace

void LockstepConductor::on_join(const lockstep_join_t& join, SimTime steady) {
  NamedLink& named = *links_.try_emplace(join.participant_name).first;
  auto& [name, link] = named;
  advance(steady);  // after a resume: the round that is under way counts
  if (link.life == join.incarnation) {
    link.last_heard = steady;
    link.wants_to_leave = link.wants_to_leave || join.wants_to_leave != 0;
    const bool done = over_ || link.said_goodbye;
    notice(join.incarnation, done ? lockstep_notice_t::OVER : lockstep_notice_t::WELCOME);
    // Further than was thought: what it said of an earlier instant came first.
    if (!link.up_to_date && join.turns_taken > link.taken) {
      link.taken = join.turns_taken;
      go_on_with(named, steady);
    }
    return advance(steady);
  }
  if (is_past_taking_part(join)) return notice(join.incarnation, lockstep_notice_t::OVER);
  const std::string objection = objection_to(join, link);
  if (!objection.empty()) return put_out(join.incarnation, name, objection);
  adopt(join, named, steady);
  advance(steady);
}

// The run ends without it, or this life has had its farewell.
bool LockstepConductor::is_past_taking_part(const lockstep_join_t& join) const {
  const std::string& name = join.participant_name;
  if (over_) return true;
  if (sequencer_.takes_part(name)) return false;
  const bool said_goodbye = join.run_id == run_id_ && join.turns_taken > sequencer_.turns_taken(name);
  return ending_ || (sequencer_.knows(name) && sequencer_.turns_taken(name) == 0 && said_goodbye);
}

std::string LockstepConductor::objection_to(const lockstep_join_t& join, const Link& link) const {
  const std::string& name = join.participant_name;
  if (link.take) return "its name is taken by the conductor itself";
  if (join.run_id != 0 && join.run_id != run_id_) return "it took part in another run";
  if (join.scenario_digest != rules_.scenario_digest) return "its scenario is not the conductor's";
  if (join.incarnation < link.life) return "a later life of it takes part";
  const std::int64_t ahead = join.turns_taken - sequencer_.turns_taken(name);
  const auto& round = sequencer_.round();
  const bool in_round = std::find(round.begin(), round.end(), name) != round.end();
  return ahead <= (in_round ? 1 : 0) ? "" : "it took turns that the run does not count";
}

void LockstepConductor::adopt(const lockstep_join_t& join, NamedLink& named, SimTime steady) {
  auto& [name, link] = named;
  if (link.life != 0 || sequencer_.knows(name)) mouth_.report("returned", "participant=" + name);
  link_of_life_.erase(link.life);
  link_of_life_[join.incarnation] = &named;
  link.life = join.incarnation;
  link.join = join;
  link.taken = join.turns_taken;
  link.said_goodbye = false;
  link.wants_to_leave = join.wants_to_leave != 0;
  link.last_heard = steady;
  link.timer = {};
  link.answer = {};
  notice(link.life, lockstep_notice_t::WELCOME);
  go_on_with(named, steady);
}

// A life that lacks turns of the past is told them; one that has them all is granted the turn of the round.
void LockstepConductor::go_on_with(NamedLink& named, SimTime steady) {
  auto& [name, link] = named;
  link.up_to_date = link.taken >= sequencer_.turns_taken(name);
  if (!link.up_to_date) return tell_past(named, steady);
  link.wants_in = !sequencer_.takes_part(name);
  if (!link.waited_for) return;
  prepare_turn(name, link);
  say_grants({&named}, steady);
}

void LockstepConductor::tell_past(NamedLink& named, SimTime steady) {
  auto& [name, link] = named;
  const auto turns = sequencer_.past_turns(name, link.taken + 1, kPastBytesPerGrant);
  link.body = bus::encoded_list<lockstep_turn_t>(turns);
  link.turns_in_body = static_cast<std::int32_t>(turns.size());
  say_grants({&named}, steady);
}

void LockstepConductor::on_past_taken(NamedLink& named, const lockstep_result_t& result, SimTime steady) {
  auto& [name, link] = named;
  link.timer.answered(steady);
  link.taken += link.turns_in_body;
  if (link.taken == sequencer_.turns_taken(name) && result.outputs_digest != sequencer_.digest_of(name)) {
    const std::int64_t life = std::exchange(link.life, 0);
    return put_out(life, name, "it says otherwise than in its earlier life");
  }
  go_on_with(named, steady);
}

void LockstepConductor::put_out(std::int64_t life, const std::string& name, const std::string& reason) const {
  mouth_.report("put-out", "participant=" + name + " reason=\"" + reason + "\"");
  notice(life, lockstep_notice_t::EXPELLED, reason);
}

void LockstepConductor::notice(std::int64_t life, std::int8_t kind, const std::string& reason) const {
  lockstep_notice_t notice;
  notice.run_id = run_id_;
  notice.incarnation = life;
  notice.notice_kind = kind;
  notice.reason = reason;
  mouth_.notice(notice);
}

}  // namespace halocline::conductor
