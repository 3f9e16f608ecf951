// SPDX-License-Identifier: BSD-3-Clause
#include "bus/repair/flow_watch.h"

#include <algorithm>
#include <utility>

namespace halocline::bus {
namespace {

constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();

// Window in which a lower number is a reordered or repeated message: within 64 numbers of the last one, and
// within a second of it. A lower number outside of it may be that of a publisher that restarts its sequence.
constexpr std::int64_t kRepetitionReach = 64;
constexpr SimDuration kRepetitionAge = SimDuration::from_milliseconds(1000);

// Distance of two sequence numbers; saturates, as a hostile publisher's numbers may differ by more than an
// int64 holds.
std::int64_t distance(std::int64_t from, std::int64_t to) {
  std::int64_t step = 0;
  return __builtin_sub_overflow(to, from, &step) ? kMax : step;
}

std::int64_t before(std::int64_t sequence) {
  return sequence == std::numeric_limits<std::int64_t>::min() ? sequence : sequence - 1;
}

// A larger step of the sequence number is a leap.
constexpr auto kReach = static_cast<std::int64_t>(FlowWatch::kMaxMissing);

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

void FlowWatch::make_room(SimTime steady, std::string_view channel, Publishers& publishers) {
  const auto is_superfluous = [&](const Publisher& longest_silent) {
    return publishers.size() >= kMaxSessions || num_flows_ >= kMaxFlows ||
           steady - longest_silent.heard_at >= kForgottenAfter;
  };
  while (publishers.size() >= kSessionsKept && is_superfluous(publishers.front())) {
    keep_lacking(channel, publishers.front());
    const std::size_t missing = publishers.front().missing.size();
    lost_ = saturating_sum(lost_, static_cast<std::int64_t>(missing));
    num_missing_ -= missing;
    --num_flows_;
    publishers.erase(publishers.begin());
  }
}

FlowWatch::Publisher& FlowWatch::add(SimTime steady, std::string_view channel, std::int64_t session,
                                     std::int64_t first) {
  auto found = received_.find(channel);
  if (found == received_.end()) found = received_.emplace(std::string(channel), Publishers()).first;
  make_room(steady, channel, found->second);
  // A flow that was not yet in its publisher's heartbeat is expected from sequence number 0.
  const bool began_after = listed_.contains(session);
  const std::int64_t expected = began_after ? std::min<std::int64_t>(first, 0) : first;
  Publisher publisher;
  publisher.session = session;
  publisher.first = expected;
  publisher.last = before(expected);
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
  lose(publisher, first, end - kept);
  num_missing_ -= publisher.missing.size();
  for (std::int64_t sequence = end - kept; sequence < end; ++sequence) {
    publisher.missing[sequence] = {steady + kReorderingDelay, steady + kExpireAfter, kFirstRetry};
  }
  while (publisher.missing.size() > kMaxMissing) {
    const std::int64_t oldest = publisher.missing.begin()->first;
    publisher.missing.erase(publisher.missing.begin());
    lose(publisher, oldest, oldest + 1);
  }
  num_missing_ += publisher.missing.size();
  if (count > 0) next_due_ = std::min(next_due_, steady + kReorderingDelay);
  return count;
}

// True when a number is too far ahead to be accepted yet; the next number that continues from there confirms
// it.
bool FlowWatch::leaps(Publisher& publisher, std::int64_t sequence) {
  const bool is_near = distance(publisher.last, sequence) - 1 <= kReach;
  const bool is_confirmed =
      publisher.leap && sequence > *publisher.leap && distance(*publisher.leap, sequence) <= kReach;
  publisher.leap = is_near || is_confirmed ? std::nullopt : std::optional(sequence);
  return publisher.leap.has_value();
}

// Starts the flow at the first number that was received; announcements of later numbers are discarded as
// false.
void FlowWatch::begin_at(Publisher& publisher, std::int64_t sequence) {
  num_missing_ -= publisher.missing.size();
  publisher.missing.erase(publisher.missing.lower_bound(sequence), publisher.missing.end());
  num_missing_ += publisher.missing.size();
  publisher.first = sequence;
  publisher.last = before(sequence);
}

void FlowWatch::lose(Publisher& publisher, std::int64_t first, std::int64_t end) {
  if (first >= end) return;
  lost_ = saturating_sum(lost_, distance(first, end));
  publisher.num_lost = saturating_sum(publisher.num_lost, distance(first, end));
  std::vector<Span>& lost = publisher.lost;
  if (!lost.empty() && lost.back().end == first) {
    lost.back().end = end;
    return;
  }
  if (lost.size() == kSpansKept) lost.erase(lost.begin());
  lost.push_back({first, end});
}

template <class Spans>
auto FlowWatch::span_with(Spans& spans, std::int64_t sequence) {
  return std::find_if(spans.begin(), spans.end(),
                      [&](const Span& one) { return one.first <= sequence && sequence < one.end; });
}

// Returns true if the number was counted as lost, and removes it from the lost ranges.
bool FlowWatch::take_lost(Publisher& publisher, std::int64_t sequence) {
  std::vector<Span>& lost = publisher.lost;
  const auto span = span_with(lost, sequence);
  if (span == lost.end()) return false;
  --publisher.num_lost;
  const Span later{sequence + 1, std::exchange(span->end, sequence)};
  if (later.first < later.end) {
    if (span->first == span->end) {
      *span = later;
    } else if (lost.size() < kSpansKept) {
      lost.insert(span + 1, later);
    }
  } else if (span->first == span->end) {
    lost.erase(span);
  }
  return true;
}

bool FlowWatch::is_old(SimTime steady, const Publisher& publisher, std::int64_t sequence,
                       std::int64_t utime) {
  if (sequence > publisher.last) return sequence == publisher.leap;
  const bool is_far =
      distance(sequence, publisher.last) >= kRepetitionReach || steady - publisher.heard_at >= kRepetitionAge;
  return is_far ? publisher.lister != 0 || utime <= publisher.utime : sequence >= publisher.first;
}

bool FlowWatch::is_old(SimTime steady, std::string_view channel, std::int64_t session, std::int64_t sequence,
                       std::int64_t utime) const {
  const auto flows = received_.find(channel);
  if (flows == received_.end()) return false;
  const auto known = std::find_if(flows->second.begin(), flows->second.end(),
                                  [&](const Publisher& publisher) { return publisher.session == session; });
  return known != flows->second.end() && known->is_heard && !known->missing.contains(sequence) &&
         span_with(known->lost, sequence) == known->lost.end() && is_old(steady, *known, sequence, utime);
}

FlowWatch::Classification FlowWatch::on_message(SimTime steady, std::string_view channel,
                                                std::int64_t session, std::int64_t sequence, bool is_repair,
                                                std::int64_t utime) {
  if ((session == 0 && sequence == 0) || has_no_room_for(channel)) return {};
  Publisher* publisher = find(channel, session);
  const bool is_first = publisher != nullptr && !publisher->is_heard;
  if (publisher != nullptr) publisher->is_heard = true;
  const bool was_missing = publisher != nullptr && publisher->missing.erase(sequence) > 0;
  num_missing_ -= was_missing ? 1 : 0;
  if (was_missing || (publisher != nullptr && take_lost(*publisher, sequence))) {
    publisher->heard_at = steady;
    return {.fills_gap = true};
  }
  if (is_repair) return {.is_repeated = true};
  if (publisher == nullptr) publisher = &add(steady, channel, session, sequence);
  publisher->is_heard = true;
  if (is_first && distance(sequence, publisher->last) > kReach) begin_at(*publisher, sequence);
  if (is_old(steady, *publisher, sequence, utime)) return {.is_repeated = true};
  Classification result;
  if (sequence > publisher->last) {
    const std::optional<std::int64_t> leapt = publisher->leap;
    if (leaps(*publisher, sequence)) return result;
    result.newly_missing = note_missing(*publisher, steady, publisher->last + 1, sequence);
    publisher->last = sequence;
    publisher->utime = utime;
    if (leapt) num_missing_ -= publisher->missing.erase(*leapt);  // it was received
  } else if (distance(sequence, publisher->last) < kRepetitionReach &&
             steady - publisher->heard_at < kRepetitionAge) {  // reordered with the first received
    result.newly_missing = note_missing(*publisher, steady, sequence + 1, publisher->first);
    publisher->first = sequence;
  } else {  // the publisher restarts its sequence
    publisher->first = publisher->last = sequence;
    publisher->utime = utime;
  }
  publisher->heard_at = steady;
  return result;
}

std::int64_t FlowWatch::on_last(SimTime steady, std::string_view channel, std::int64_t session,
                                std::int64_t last, const Lister& lister) {
  if (last < 0 || last == std::numeric_limits<std::int64_t>::max())
    return 0;  // no sequence number of this library
  if (has_no_room_for(channel)) return 0;
  Publisher* publisher = find(channel, session);
  if (publisher == nullptr && !lister.makes_flow) return 0;
  if (publisher == nullptr) publisher = &add(steady, channel, session, last + 1);
  publisher->heard_at = steady;
  const bool is_of_another = publisher->lister != 0 && publisher->lister != lister.node;
  if (is_of_another && steady - publisher->listed_at < kForgottenAfter) return 0;
  const bool began_after = publisher->lister == 0 && listed_.contains(lister.session);
  publisher->lister = lister.node;
  publisher->listed_at = steady;
  if (publisher->is_heard && distance(publisher->last, last) > kReach) return 0;
  std::int64_t newly_missing = 0;
  if (publisher->first > 0 && (lister.from_its_start || began_after || knows_(channel))) {
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
  if (listed_.size() >= kMaxListed && !listed_.contains(session)) listed_.erase(listed_.begin());
  listed_.insert(session);
}

std::vector<FlowWatch::Request> FlowWatch::take_due(SimTime steady) {
  std::vector<Request> requests;
  if (steady < next_due_) return requests;
  next_due_ = SimTime::never();
  for (auto& [channel, publishers] : received_) {
    for (Publisher& publisher : publishers) {
      num_missing_ -= std::erase_if(publisher.missing, [&](const auto& entry) {
        const bool is_expired = entry.second.expires <= steady;
        if (is_expired) lose(publisher, entry.first, entry.first + 1);
        return is_expired;
      });
      Request request{channel, publisher.session, {}};
      for (auto& [sequence, missing] : publisher.missing) {
        if (missing.next_request <= steady && request.sequences.size() < kMaxPerRequest) {
          request.sequences.push_back(sequence);
          missing.next_request = steady + missing.retry;
          missing.retry = std::min(missing.retry * 2, kLongestRetry);
        }
        next_due_ = std::min({next_due_, missing.next_request, missing.expires});
      }
      if (!request.sequences.empty()) requests.push_back(std::move(request));
    }
  }
  std::stable_sort(requests.begin(), requests.end(),
                   [](const Request& a, const Request& b) { return a.channel < b.channel; });
  return requests;
}

void FlowWatch::go_on(Knows knows) {
  knows_ = std::move(knows);
  for (auto& [channel, publishers] : received_) {
    for (Publisher& publisher : publishers) publisher.first = std::min<std::int64_t>(publisher.first, 0);
  }
}

void FlowWatch::keep_lacking(std::string_view channel, const Publisher& publisher) {
  const auto missing = static_cast<std::int64_t>(publisher.missing.size());
  if (publisher.num_lost == 0 && missing == 0) return;
  Lacking& lacking =
      forgotten_.try_emplace(std::string(channel), Lacking{std::string(channel), 0, false}).first->second;
  lacking.messages = saturating_sum(lacking.messages, saturating_sum(publisher.num_lost, missing));
  lacking.is_listed = lacking.is_listed || publisher.lister != 0;
}

std::vector<FlowWatch::Lacking> FlowWatch::lacking() const {
  FlowWatch all;
  all.forgotten_ = forgotten_;
  for (const auto& [channel, publishers] : received_) {
    for (const Publisher& publisher : publishers) all.keep_lacking(channel, publisher);
  }
  std::vector<Lacking> lacking;
  for (auto& [channel, one] : all.forgotten_) lacking.push_back(std::move(one));
  return lacking;
}

void FlowWatch::forget() {
  for (const auto& [channel, publishers] : received_) {
    for (const Publisher& publisher : publishers) keep_lacking(channel, publisher);
  }
  received_.clear();
  listed_.clear();
  knows_ = knows_none;
  num_missing_ = num_flows_ = 0;
  next_due_ = SimTime::never();
}

}  // namespace halocline::bus
