// SPDX-License-Identifier: BSD-3-Clause
#include "bus/lockstep/lockstep_participant.h"

#include <algorithm>

#include "core/check.h"

namespace halocline::bus {

LockstepParticipant::LockstepParticipant(lockstep_join_t introduction, TakeTurn take, Outputs outputs)
    : join_(std::move(introduction)), take_(std::move(take)), outputs_(std::move(outputs)) {
  require(join_.incarnation != 0, "a participant needs an incarnation");
}

void LockstepParticipant::on_grant(const lockstep_grant_t& grant, SimTime steady) {
  const auto& addressed = grant.incarnations;
  const auto me = std::find(addressed.begin(), addressed.end(), join_.incarnation);
  if (me == addressed.end() || has_ended() || (join_.run_id != 0 && grant.run_id != join_.run_id)) return;
  join_.run_id = grant.run_id;
  last_received_ = steady;
  next_join_ = steady + kKeepAlivePeriod;
  const std::int64_t first = grant.first_turns[static_cast<std::size_t>(me - addressed.begin())];
  const std::int64_t last = first + grant.num_turns - 1;
  if (last == turns_taken_ && !last_result_.empty()) return has_just_answered_ ? void() : answer();
  if (last <= turns_taken_ || first > turns_taken_ + 1)
    return send_join();  // the conductor does not know how many turns it has taken
  const auto body = grants_.add(last, grant.slice_number, grant.slice_count, grant.slice_bytes);
  if (!body) return;
  const auto turns = decoded_list<lockstep_turn_t>(*body);
  if (turns && std::ssize(*turns) == grant.num_turns) take(*turns, first, grant.past != 0);
}

void LockstepParticipant::take(const std::vector<lockstep_turn_t>& turns, std::int64_t first, bool past) {
  if (state_ == State::kJoining) state_ = State::kTakingPart;
  lockstep_result_t result;
  for (const lockstep_turn_t& turn : turns) {
    if (first++ <= turns_taken_) continue;
    result = take_(turn);
    ++turns_taken_;
    reached_ = SimTime::from_nanoseconds(result.reached_ns);
    if (turn.farewell != 0) state_ = State::kLeft;
  }
  if (past) {  // the conductor has the messages, and compares digests
    result.outputs.clear();
    result.num_outputs = 0;
  }
  last_result_ = encoded(result);
  answer();
}

void LockstepParticipant::answer() {
  has_just_answered_ = true;
  lockstep_answer_t answer;
  answer.run_id = join_.run_id;
  answer.incarnation = join_.incarnation;
  answer.turn_number = turns_taken_;
  answer.wants_to_leave = join_.wants_to_leave;
  answer.slice_count = slice_count(last_result_.size());
  for (answer.slice_number = 0; answer.slice_number < answer.slice_count; ++answer.slice_number) {
    const auto slice = slice_of(last_result_, answer.slice_number);
    answer.slice_bytes.assign(slice.begin(), slice.end());
    answer.num_slice_bytes = static_cast<std::int32_t>(slice.size());
    outputs_.answer(answer);
  }
}

void LockstepParticipant::on_notice(const lockstep_notice_t& notice, SimTime steady) {
  if (notice.incarnation != join_.incarnation || has_ended()) return;
  last_received_ = steady;
  switch (notice.notice_kind) {
    case lockstep_notice_t::WELCOME:
      join_.run_id = notice.run_id;
      if (state_ == State::kJoining) state_ = State::kTakingPart;
      next_join_ = steady + kKeepAlivePeriod;
      return;
    case lockstep_notice_t::EXPELLED:
      reason_ = notice.reason;
      state_ = State::kExpelled;
      return;
    default:
      if (join_.run_id == 0 || notice.run_id == join_.run_id) state_ = State::kOver;
  }
}

void LockstepParticipant::on_timer(SimTime steady) {
  has_just_answered_ = false;
  if (has_ended() || steady < next_join_) return;
  if (state_ == State::kLeft && steady > last_received_ + kLinger) {
    state_ = State::kOver;
    return;
  }
  send_join();
  next_join_ = steady + (state_ == State::kJoining ? kJoinPeriod : kKeepAlivePeriod);
}

void LockstepParticipant::send_join() {
  join_.turns_taken = turns_taken_;
  outputs_.join(join_);
}

void LockstepParticipant::request_leave() {
  join_.wants_to_leave = 1;
  next_join_ = SimTime::at_once();
}

}  // namespace halocline::bus
