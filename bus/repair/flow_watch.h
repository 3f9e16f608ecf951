// SPDX-License-Identifier: BSD-3-Clause
// Gap detector of one receiver: tracks (session, sequence) of each channel's publishers, knows which messages
// are missing, and schedules repair requests (NACK) with exponential backoff.
//
// Within a session numbers only rise, so an old number that is received again is a duplicate, however old it
// is. The exception is a publisher that no heartbeat lists: it may restart its numbers in the same session. A
// lower number is accepted from it only with a later utime, which no old message has.
//
// A publisher without sequence numbers sends 0 for both and is not tracked. Messages before the first one
// received of a flow are not missing, unless the receiver was subscribed before the flow began: it is older
// than the publisher, or it received a heartbeat of the publisher that did not list the flow yet. A new
// session starts without a gap, because its publisher was restarted.
//
// Anybody may publish, so a single number that leaps is not accepted: a number more than kMaxMissing ahead of
// the flow changes nothing until the next message continues from there. A message that had been counted as
// lost is accepted when it arrives after all. Whatever numbers are forged, the messages of a live flow are
// therefore received. A flow is listed by the heartbeats of one node, in any of its incarnations, until these
// have been silent for kForgottenAfter. A heartbeat cannot make a flow leap of which messages were received.
//
// The class has no side effects: values in, values out. `steady` is the caller's steady time, which never
// decreases.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "core/hash.h"
#include "core/limits.h"
#include "core/sim_time.h"

namespace halocline::bus {

// Returns a + b (both 0 or more), or the maximum of the type where the sum exceeds it.
constexpr std::int64_t saturating_sum(std::int64_t a, std::int64_t b) {
  std::int64_t sum = 0;
  return __builtin_add_overflow(a, b, &sum) ? std::numeric_limits<std::int64_t>::max() : sum;
}

class FlowWatch {
 public:
  // Delay of the first request for a missing message: reordered datagrams need no repair.
  static constexpr SimDuration kReorderingDelay = SimDuration::from_milliseconds(5);
  // Delay between the first two requests for a message; it doubles with each request.
  static constexpr SimDuration kFirstRetry = SimDuration::from_milliseconds(40);
  static constexpr SimDuration kLongestRetry = SimDuration::from_milliseconds(640);
  // A message missing for this long is counted as lost.
  static constexpr SimDuration kExpireAfter = SimDuration::from_milliseconds(10'000);
  // A session of a channel, or a lister, that is silent for this long makes room for another.
  static constexpr SimDuration kForgottenAfter = SimDuration::from_milliseconds(30'000);
  // Limits on missing messages. Beyond kMaxMissing in one flow the oldest are counted as lost. Beyond
  // kMaxMissingOfAll in all flows, or kMaxMissingUnheard for flows of which nothing was received yet, the
  // newest are.
  static constexpr std::size_t kMaxMissing = 2000, kMaxMissingOfAll = 20'000, kMaxMissingUnheard = 5000;
  static constexpr std::size_t kMaxPerRequest = 200;
  // Channels beyond this limit are not tracked: an endless series of invented names must not exhaust memory.
  static constexpr std::size_t kMaxChannels = 4 * kMaxVehicles;

  // Relation of a received message to its flow.
  struct Classification {
    std::int64_t newly_missing = 0;  // messages between it and the previous highest number
    bool fills_gap = false;          // it was missing
    bool is_repeated = false;        // a duplicate, or a copy of an old message
  };
  // Records a message. `is_repair`: it answers a request, perhaps another receiver's; it then either fills a
  // gap or is a duplicate. `utime`: time stamp of the message, us.
  Classification on_message(SimTime steady, std::string_view channel, std::int64_t session,
                            std::int64_t sequence, bool is_repair = false, std::int64_t utime = 0);
  // True for a copy of an old message of its flow, one that on_message() would find repeated. Such a copy
  // carries no information on its publisher, not even that it is alive.
  bool is_old(SimTime steady, std::string_view channel, std::int64_t session, std::int64_t sequence,
              std::int64_t utime) const;

  // Source of a heartbeat that lists a flow. `from_its_start`: the receiver is older than the publisher, so
  // it should have all messages from 0. `makes_flow`: track the flow even if none of its messages was
  // received yet.
  struct Lister {
    std::uint64_t node = 1;    // hash of the node's name, not 0
    std::int64_t session = 0;  // session of the heartbeat; its flows may have others
    bool from_its_start = false, makes_flow = true;
  };
  // Records `last`, which a heartbeat announced as the last sequence number of the flow. Returns how many
  // messages are newly missing.
  std::int64_t on_last(SimTime steady, std::string_view channel, std::int64_t session, std::int64_t last,
                       const Lister& lister);
  // A heartbeat of this session has listed all flows of its node (each passed to on_last). Any other flow of
  // the session, or flow that it lists later, therefore begins after now.
  void on_all_listed(std::int64_t session);
  void forget_listed() { listed_.clear(); }

  // A repair request for missing messages of one flow.
  struct Request {
    std::string channel;
    std::int64_t session = 0;
    std::vector<std::int64_t> sequences;  // ascending, 1 to kMaxPerRequest
  };
  // Returns the requests that are due, by channel. Messages missing for longer than kExpireAfter are counted
  // as lost.
  std::vector<Request> take_due(SimTime steady);
  // Time at which take_due() next has work; never() if nothing is missing.
  SimTime next_due() const { return next_due_; }
  // Number of messages counted as lost since the start; saturates.
  std::int64_t lost() const { return lost_; }
  // Number of messages missing now.
  std::size_t num_missing() const { return num_missing_; }
  // Channel with missing or lost messages; lacking() returns them in the order of their names.
  struct Lacking {
    std::string channel;
    std::int64_t messages = 0;  // saturates
    bool is_listed = false;     // a heartbeat of its publisher lists the flow
  };
  std::vector<Lacking> lacking() const;
  // Number of sessions of channels that are tracked.
  std::size_t num_flows() const { return num_flows_; }

  // Continues where an earlier incarnation of the receiver ended. Messages before the first number of a flow
  // known now are not missing. On the channels that `knows` selects, every flow is known of which anything
  // was received, so any other flow is missing from its start.
  using Knows = std::function<bool(std::string_view channel)>;
  void go_on(Knows knows);
  // Another run has begun: its publishers may restart their sequences.
  void forget();

 private:
  struct Missing {
    SimTime next_request, expires;
    SimDuration retry;
  };
  struct Span {
    std::int64_t first = 0, end = 0;
  };
  struct Publisher {
    std::int64_t session = 0;
    std::int64_t first = 0, last = -1;  // no message before first is expected; last was received or announced
    std::int64_t utime = std::numeric_limits<std::int64_t>::min();  // utime of message `last`
    SimTime heard_at;
    bool is_heard = false;  // a message was received, not only a heartbeat
    // Hash of the node whose heartbeats list the flow, 0 if none. A listed flow never restarts its numbers
    // within a session, so a message far behind is a duplicate.
    std::uint64_t lister = 0;
    SimTime listed_at;
    std::optional<std::int64_t> leap;  // number far ahead that no message has confirmed yet
    std::map<std::int64_t, Missing> missing;
    std::vector<Span> lost;  // latest ranges that were counted as lost
    std::int64_t num_lost = 0;
  };
  static constexpr std::size_t kSpansKept = 8;  // ranges of lost messages of one flow
  // Number of sessions kept per channel. Beyond kSessionsKept, sessions silent for kForgottenAfter are
  // dropped, so that memory stays constant while programs are restarted. At kMaxSessions, or when kMaxFlows
  // are tracked in all, the session silent for longest is dropped.
  static constexpr std::size_t kSessionsKept = 4, kMaxSessions = 128, kMaxFlows = 2 * kMaxChannels;
  bool has_no_room_for(std::string_view channel) const {
    return received_.size() >= kMaxChannels && !received_.contains(channel);
  }
  using Publishers = std::vector<Publisher>;  // ordered by use, the latest at the end

  Publisher* find(std::string_view channel, std::int64_t session);
  static bool is_old(SimTime steady, const Publisher& publisher, std::int64_t sequence, std::int64_t utime);
  Publisher& add(SimTime steady, std::string_view channel, std::int64_t session, std::int64_t first);
  void make_room(SimTime steady, std::string_view channel, Publishers& publishers);
  void keep_lacking(std::string_view channel, const Publisher& publisher);
  static bool knows_none(std::string_view) { return false; }
  static bool leaps(Publisher& publisher, std::int64_t sequence);
  void begin_at(Publisher& publisher, std::int64_t sequence);
  void lose(Publisher& publisher, std::int64_t first, std::int64_t end);
  template <class Spans>
  static auto span_with(Spans& spans, std::int64_t sequence);
  static bool take_lost(Publisher& publisher, std::int64_t sequence);
  std::int64_t note_missing(Publisher& publisher, SimTime steady, std::int64_t first, std::int64_t end);

  std::unordered_map<std::string, Publishers, TextHash, std::equal_to<>> received_;  // keyed by channel
  Knows knows_ = knows_none;
  static constexpr std::size_t kMaxListed = 4096;
  std::unordered_set<std::int64_t> listed_;  // sessions of which a heartbeat has listed all flows
  SimTime next_due_ = SimTime::never();
  std::int64_t lost_ = 0;
  // Missing and lost messages of sessions that were dropped, by channel.
  std::map<std::string, Lacking, std::less<>> forgotten_;
  std::size_t num_missing_ = 0, num_flows_ = 0;  // totals over all channels
};

}  // namespace halocline::bus
