#include "bus/flow_repair.h"

namespace halocline::bus {
namespace {

// The age of flows that began before this process: three years.
constexpr SimDuration kOlderThanAll = SimDuration::from_milliseconds(100'000'000'000);

}  // namespace

std::vector<const Bytes*> FlowRepair::answers_to(const repair_request_t& request) const {
  std::vector<const Bytes*> answers;
  std::size_t bytes = 0;
  for (const std::int64_t sequence : request.missing_sequence) {
    const auto* message = history_.find(request.missing_channel, request.publisher_session, sequence);
    if (message == nullptr) continue;
    bytes += message->size();
    if (bytes > kMaxAnswerBytes && !answers.empty()) break;
    answers.push_back(message);
  }
  return answers;
}

flow_heartbeat_t FlowRepair::take_heartbeat(SimTime sim, SimTime steady) {
  if (next_heartbeat_ == SimTime::at_once()) began_ = steady;
  next_heartbeat_ = steady + kHeartbeatPeriod;
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

std::int64_t FlowRepair::on_heartbeat(SimTime steady, const flow_heartbeat_t& heartbeat,
                                      const std::function<bool(std::string_view)>& is_subscribed_to) {
  const bool is_younger = SimDuration::from_microseconds(heartbeat.age_us) <= steady - began_;
  std::int64_t missing = 0;
  for (std::size_t i = 0; i < heartbeat.flow_channel.size(); ++i) {
    if (!is_subscribed_to(heartbeat.flow_channel[i])) continue;
    missing += watch_.on_last(steady, heartbeat.flow_channel[i], heartbeat.flow_session[i],
                              heartbeat.flow_last_sequence[i], is_younger);
  }
  if (heartbeat.num_flows == heartbeat.num_flows_kept) watch_.on_all_listed(heartbeat.session);
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
