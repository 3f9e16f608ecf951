// SPDX-License-Identifier: BSD-3-Clause
#include "bus/flow_watch.h"

#include <algorithm>
#include <limits>

namespace halocline::bus {
namespace {

constexpr std::int64_t kGreatest = std::numeric_limits<std::int64_t>::max();

constexpr std::int64_t kRepetitionReach = 64;
constexpr SimDuration kRepetitionAge = SimDuration::from_milliseconds(1000);

// Sequence numbers of a hostile publisher may lie further apart than an int64 holds: saturates.
std::int64_t distance(std::int64_t from, std::int64_t to) {
  std::int64_t step = 0;
  return __builtin_sub_overflow(to, from, &step) ? kGreatest : step;
}

}  // namespace

FlowWatch::Publisher* FlowWatch::find(std::string_view channel, std::int64_t session) {
  const auto found = received_.find(channel);
  if (found == received_.end()) return nullptr;
  const auto known = std::find_if(found->second.begin(), found->second.end(),
                                  [&](const Publisher& publisher) { return publisher.session == session; });
  if (known == found->second.end()) return nullptr;
  std::rotate(known, known + 1, found->second.end());
  return &found->second.back();
}

void FlowWatch::make_room(SimTime steady, Publishers& publishers) {
  const auto is_superfluous = [&](const Publisher& longest_silent) {
    return publishers.size() >= kMaxSessions || num_flows_ >= kMaxFlows ||
           steady - longest_silent.heard_at >= kForgottenAfter;
  };
  while (publishers.size() >= kSessionsKept && is_superfluous(publishers.front())) {
    const std::size_t missing = publishers.front().missing.size();
    lose(static_cast<std::int64_t>(missing));
    num_missing_ -= missing;
    --num_flows_;
    publishers.erase(publishers.begin());
  }
}

FlowWatch::Publisher& FlowWatch::add(SimTime steady, std::string_view channel, std::int64_t session,
                                     std::int64_t first) {
  auto found = received_.find(channel);
  if (found == received_.end()) found = received_.emplace(std::string(channel), Publishers()).first;
  make_room(steady, found->second);
  // A flow that was not yet in its publisher's heartbeat is expected from sequence number 0.
  const bool began_after = std::find(listed_.begin(), listed_.end(), session) != listed_.end();
  const std::int64_t expected = began_after ? std::min<std::int64_t>(first, 0) : first;
  Publisher publisher;
  publisher.session = session;
  publisher.first = expected;
  publisher.last = expected == std::numeric_limits<std::int64_t>::min() ? expected : expected - 1;
  publisher.heard_at = steady;
  found->second.push_back(std::move(publisher));
  ++num_flows_;
  return found->second.back();
}

std::int64_t FlowWatch::note_missing(Publisher& publisher, SimTime steady, std::int64_t first,
                                     std::int64_t end) {
  const std::int64_t count = distance(first, end);
  const std::size_t most = publisher.is_heard ? kMaxMissingOfAll : kMaxMissingUnheard;
  const std::size_t room = std::min(most - std::min(most, num_missing_), kMaxMissing);
  const auto kept = std::min(count, static_cast<std::int64_t>(room));
  lose(count - kept);
  num_missing_ -= publisher.missing.size();
  for (std::int64_t sequence = end - kept; sequence < end; ++sequence) {
    publisher.missing[sequence] = {steady + kReorderingDelay, steady + kGivenUpAfter, kFirstRetry};
  }
  while (publisher.missing.size() > kMaxMissing) {
    publisher.missing.erase(publisher.missing.begin());
    lose(1);
  }
  num_missing_ += publisher.missing.size();
  if (count > 0) next_due_ = std::min(next_due_, steady + kReorderingDelay);
  return count;
}

void FlowWatch::lose(std::int64_t count) { lost_ = saturating_sum(lost_, count); }

FlowWatch::Classification FlowWatch::on_message(SimTime steady, std::string_view channel,
                                                std::int64_t session, std::int64_t sequence, bool is_repair) {
  if ((session == 0 && sequence == 0) || has_no_room_for(channel)) return {};
  Publisher* publisher = find(channel, session);
  if (publisher != nullptr) publisher->is_heard = true;
  if (publisher != nullptr && publisher->missing.erase(sequence) > 0) {
    --num_missing_;
    publisher->heard_at = steady;
    return {.fills_gap = true};
  }
  if (is_repair) return {.is_repeated = true};
  if (publisher == nullptr) publisher = &add(steady, channel, session, sequence);
  publisher->is_heard = true;
  Classification result;
  if (sequence > publisher->last) {
    result.newly_missing = note_missing(*publisher, steady, publisher->last + 1, sequence);
    publisher->last = sequence;
  } else if (distance(sequence, publisher->last) >= kRepetitionReach ||
             steady - publisher->heard_at >= kRepetitionAge) {
    if (publisher->is_listed) return {.is_repeated = true};
    publisher->first = publisher->last = sequence;  // it starts its sequence anew
  } else if (sequence < publisher->first) {         // reordered with the first received
    result.newly_missing = note_missing(*publisher, steady, sequence + 1, publisher->first);
    publisher->first = sequence;
  } else {
    return {.is_repeated = true};
  }
  publisher->heard_at = steady;
  return result;
}

std::int64_t FlowWatch::on_last(SimTime steady, std::string_view channel, std::int64_t session,
                                std::int64_t last, bool from_its_start, bool makes_flow) {
  if (last < 0 || last == std::numeric_limits<std::int64_t>::max())
    return 0;  // no sequence number of this library
  if (has_no_room_for(channel)) return 0;
  Publisher* publisher = find(channel, session);
  if (publisher == nullptr && !makes_flow) return 0;
  if (publisher == nullptr) publisher = &add(steady, channel, session, last + 1);
  publisher->heard_at = steady;
  publisher->is_listed = true;
  std::int64_t newly_missing = 0;
  if (from_its_start && publisher->first > 0) {
    newly_missing += note_missing(*publisher, steady, 0, publisher->first);
    publisher->first = 0;
  }
  if (last > publisher->last) {
    newly_missing =
        saturating_sum(newly_missing, note_missing(*publisher, steady, publisher->last + 1, last + 1));
    publisher->last = last;
  }
  return newly_missing;
}

void FlowWatch::on_all_listed(std::int64_t session) {
  constexpr std::size_t kMaxListed = 200;
  if (std::find(listed_.begin(), listed_.end(), session) != listed_.end()) return;
  listed_.push_back(session);
  if (listed_.size() > kMaxListed) listed_.pop_front();
}

std::vector<FlowWatch::Request> FlowWatch::take_due(SimTime steady) {
  std::vector<Request> requests;
  if (steady < next_due_) return requests;
  next_due_ = SimTime::never();
  for (auto& [channel, publishers] : received_) {
    for (Publisher& publisher : publishers) {
      const std::size_t given_up = std::erase_if(
          publisher.missing, [&](const auto& entry) { return entry.second.given_up <= steady; });
      lose(static_cast<std::int64_t>(given_up));
      num_missing_ -= given_up;
      Request request{channel, publisher.session, {}};
      for (auto& [sequence, missing] : publisher.missing) {
        if (missing.next_request <= steady && request.sequences.size() < kMaxPerRequest) {
          request.sequences.push_back(sequence);
          missing.next_request = steady + missing.retry;
          missing.retry = std::min(missing.retry * 2, kLongestRetry);
        }
        next_due_ = std::min({next_due_, missing.next_request, missing.given_up});
      }
      if (!request.sequences.empty()) requests.push_back(std::move(request));
    }
  }
  std::stable_sort(requests.begin(), requests.end(),
                   [](const Request& a, const Request& b) { return a.channel < b.channel; });
  return requests;
}

void FlowWatch::forget() {
  received_.clear();
  listed_.clear();
  num_missing_ = num_flows_ = 0;
  next_due_ = SimTime::never();
}

}  // namespace halocline::bus
