// SPDX-License-Identifier: BSD-3-Clause
#include "bus/repair/flow_repair.h"

#include "core/hash.h"

namespace halocline::bus {
namespace {

// Announced age of flows that began before this process: three years.
constexpr SimDuration kOlderThanAll = SimDuration::from_milliseconds(100'000'000'000);

}  // namespace

void FlowRepair::on_request(SimTime steady, const repair_request_t& request) {
  const std::string& channel = request.missing_channel;
  for (const std::int64_t sequence : request.missing_sequence) {
    if (wanted_.size() >= kMaxWanted) return;
    if (!history_.want(channel, request.publisher_session, sequence, steady)) continue;
    wanted_.push_back({channel, request.publisher_session, sequence});
    ++num_requested_;
  }
}

std::vector<FlowRepair::Answer> FlowRepair::take_answers(SimTime steady) {
  constexpr SimDuration kPause = SimDuration::from_milliseconds(5);  // long enough to gain one token
  static_assert(kAnswersPerS * kPause.seconds() >= 1);
  std::vector<Answer> answers;
  if (wanted_.empty() || steady < next_answer_) return answers;
  const double passed_s = std::max((steady - filled_at_).seconds(), 0.0);
  answers_ = std::min(answers_ + kAnswersPerS * passed_s, kMaxAnswers);
  filled_at_ = steady;
  std::size_t bytes = 0;
  for (; !wanted_.empty() && answers_ >= 1 && bytes < kMaxAnswerBytes; wanted_.pop_front()) {
    Wanted& wanted = wanted_.front();
    const Bytes* message = history_.answer(wanted.channel, wanted.session, wanted.sequence, steady);
    if (message == nullptr) continue;
    bytes += message->size();
    answers_ -= 1;
    answers.push_back({std::move(wanted.channel), message});
  }
  next_answer_ = answers_ < 1 ? steady + kPause : SimTime::at_once();
  return answers;
}

bool FlowRepair::is_old(const flow_heartbeat_t& heartbeat) const {
  const auto heard = heartbeats_of_others_.find(heartbeat.session);
  return heard != heartbeats_of_others_.end() && heartbeat.utime <= heard->second.utime &&
         heartbeat.sequence <= heard->second.sequence;
}

// Records the heartbeat. True when the session was first heard at least half a heartbeat period ago, that is
// by an earlier heartbeat and not by a copy of this one. A number far ahead is not recorded, because it may
// be forged.
bool FlowRepair::is_known(SimTime steady, const flow_heartbeat_t& heartbeat) {
  constexpr std::size_t kMaxSessions = 4096;
  const std::int64_t session = heartbeat.session;
  if (!heartbeats_of_others_.contains(session)) {
    std::erase_if(heartbeats_of_others_, [&](const auto& entry) {
      return steady - entry.second.last >= FlowWatch::kForgottenAfter;
    });
    if (heartbeats_of_others_.size() >= kMaxSessions) heartbeats_of_others_.clear();
  }
  const Heard first{steady, steady, heartbeat.utime, heartbeat.sequence};
  Heard& heard = heartbeats_of_others_.try_emplace(session, first).first->second;
  heard.last = steady;
  if (heartbeat.sequence <= saturating_sum(heard.sequence, FlowWatch::kMaxMissing)) {
    heard.utime = heartbeat.utime;
    heard.sequence = heartbeat.sequence;
  }
  return (steady - heard.first) * 2 >= kHeartbeatPeriod;
}

flow_heartbeat_t FlowRepair::take_heartbeat(SimTime sim, SimTime steady) {
  if (next_heartbeat_ == SimTime::at_once()) began_ = steady;
  next_heartbeat_ = steady + kHeartbeatPeriod;
  history_.forget_old(steady);
  flow_heartbeat_t heartbeat{};
  heartbeat.utime = sim.to_utime();
  heartbeat.session = session_;
  heartbeat.sequence = heartbeats_++;
  heartbeat.age_us = (resumes_ ? kOlderThanAll : steady - began_).nanoseconds() / 1000;
  heartbeat.num_flows_kept = static_cast<std::int32_t>(history_.num_flows());
  for (FlowHistory::Flow& flow : history_.take_listing()) {
    heartbeat.flow_channel.push_back(std::move(flow.channel));
    heartbeat.flow_session.push_back(flow.session);
    heartbeat.flow_last_sequence.push_back(flow.last);
  }
  heartbeat.num_flows = static_cast<std::int32_t>(heartbeat.flow_channel.size());
  return heartbeat;
}

std::int64_t FlowRepair::on_heartbeat(SimTime steady, std::string_view node,
                                      const flow_heartbeat_t& heartbeat,
                                      const std::function<bool(std::string_view)>& is_subscribed_to) {
  const bool known = is_known(steady, heartbeat);
  const SimTime since = std::max(began_, subscribed_);
  const bool is_younger = SimDuration::from_microseconds(heartbeat.age_us) <= steady - since;
  const FlowWatch::Lister lister{xxh3(node), heartbeat.session, is_younger, known};
  std::int64_t missing = 0;
  for (std::size_t i = 0; i < heartbeat.flow_channel.size(); ++i) {
    if (!is_subscribed_to(heartbeat.flow_channel[i])) continue;
    missing += watch_.on_last(steady, heartbeat.flow_channel[i], heartbeat.flow_session[i],
                              heartbeat.flow_last_sequence[i], lister);
  }
  // The first heartbeat of a session does not create flows (known). Flows older than the heartbeat would seem
  // to begin after it if on_all_listed() were called now.
  const bool began_now = heartbeat.sequence == 0 && (heartbeat.num_flows == 0 || heartbeat.age_us == 0);
  if ((known || began_now) && heartbeat.num_flows == heartbeat.num_flows_kept)
    watch_.on_all_listed(heartbeat.session);
  return missing;
}

std::vector<repair_request_t> FlowRepair::take_requests(SimTime sim, SimTime steady) {
  std::vector<repair_request_t> requests;
  for (FlowWatch::Request& due : watch_.take_due(steady)) {
    repair_request_t request{};
    request.utime = sim.to_utime();
    request.client_name = name_;
    request.missing_channel = std::move(due.channel);
    request.publisher_session = due.session;
    request.num_missing = static_cast<std::int32_t>(due.sequences.size());
    request.missing_sequence = std::move(due.sequences);
    requests.push_back(std::move(request));
  }
  return requests;
}

}  // namespace halocline::bus
