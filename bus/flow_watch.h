// SPDX-License-Identifier: BSD-3-Clause
// Gap detector of one receiver: follows (session, sequence) of each channel's publishers, knows which
// messages are missing, and schedules repair requests (NACK) with exponential backoff.
//
// In a session numbers only rise: an old one that comes again is a duplicate, however old. A publisher that
// nobody lists in heartbeats may begin its numbers anew in the same session; a lower number is believed of it
// with a later utime alone, which no old message has.
//
// A publisher without sequence numbers sends 0 for both, and is not watched. Messages before the first one
// received of a flow are not missing, unless the receiver has been subscribed since before the flow began: it
// is older than the publisher, or received a heartbeat of the publisher that did not list the flow yet. A new
// session starts without a gap: its publisher was restarted.
//
// Anybody may publish, so no single number is believed that leaps: one more than kMaxMissing ahead of the
// flow changes nothing until the next message goes on from there. What was given up is received when it comes
// after all, so whatever numbers are claimed, a flow that goes on is received. It is listed by the heartbeats
// of one node, of all its incarnations, until these are silent for kForgottenAfter; they do not leap where
// messages were received.
//
// Pure: values in, values out; `steady` is the caller's steady time, never set back.
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

// a + b, both 0 or more, and the greatest number where that is more.
constexpr std::int64_t saturating_sum(std::int64_t a, std::int64_t b) {
  std::int64_t sum = 0;
  return __builtin_add_overflow(a, b, &sum) ? std::numeric_limits<std::int64_t>::max() : sum;
}

class FlowWatch {
 public:
  // Delay of the first request for a missing message: reordered datagrams need no repair.
  static constexpr SimDuration kReorderingDelay = SimDuration::from_milliseconds(5);
  // Between the first two requests for a message; it doubles with each.
  static constexpr SimDuration kFirstRetry = SimDuration::from_milliseconds(40);
  static constexpr SimDuration kLongestRetry = SimDuration::from_milliseconds(640);
  // After this a missing message is lost.
  static constexpr SimDuration kGivenUpAfter = SimDuration::from_milliseconds(10'000);
  // What is silent for this, a session of a channel or who lists it, is forgotten when another comes.
  static constexpr SimDuration kForgottenAfter = SimDuration::from_milliseconds(30'000);
  // Missing messages of one flow, beyond which the oldest count as lost; of all, and of flows of which
  // nothing was received yet, beyond which the newest do.
  static constexpr std::size_t kMaxMissing = 2000, kMaxMissingOfAll = 20'000, kMaxMissingUnheard = 5000;
  static constexpr std::size_t kMaxPerRequest = 200;
  // Channels beyond these are not watched: endless invented names must not exhaust memory.
  static constexpr std::size_t kMaxChannels = 4 * kMaxVehicles;

  // How a received message fits into its flow.
  struct Classification {
    std::int64_t newly_missing = 0;  // messages between it and the greatest sequence number before
    bool fills_gap = false;          // it was missing
    bool is_repeated = false;        // a duplicate: of the last 64 sequence numbers, within a second
  };
  // `is_repair`: it answers a request, perhaps of another receiver; then it either fills a gap or is a
  // duplicate. `utime`: that of the message, microseconds.
  Classification on_message(SimTime steady, std::string_view channel, std::int64_t session,
                            std::int64_t sequence, bool is_repair = false, std::int64_t utime = 0);
  // Test for a copy of an old message of its flow: on_message() would find it repeated. Such a copy
  // tells nothing of its publisher, not even that it lives.
  bool is_old(SimTime steady, std::string_view channel, std::int64_t session, std::int64_t sequence,
              std::int64_t utime) const;

  // Who lists a flow. `from_its_start`: the receiver is older than the publisher, so it should have all from
  // 0. `makes_flow`: the flow is followed although nothing of it was received yet.
  struct Lister {
    std::uint64_t node = 1;    // whose heartbeat it is: a hash of its name, not 0
    std::int64_t session = 0;  // of the heartbeat; its flows may have others
    bool from_its_start = false, makes_flow = true;
  };
  // A heartbeat announced `last` as the last sequence number of the flow. Returns how many are newly missing.
  std::int64_t on_last(SimTime steady, std::string_view channel, std::int64_t session, std::int64_t last,
                       const Lister& lister);
  // A heartbeat of this session listed all flows of its node (each in on_last): any other of the session, or
  // that it lists later, begins after now.
  void on_all_listed(std::int64_t session);
  void forget_listed() { listed_.clear(); }

  // A repair request for missing messages of one flow.
  struct Request {
    std::string channel;
    std::int64_t session = 0;
    std::vector<std::int64_t> sequences;  // ascending, 1 to kMaxPerRequest
  };
  // The requests that are due, by channel; gives up what has been missing for longer than kGivenUpAfter.
  std::vector<Request> take_due(SimTime steady);
  // When take_due has something to do; never() while nothing is missing.
  SimTime next_due() const { return next_due_; }
  // Messages given up since the start; saturates.
  std::int64_t lost() const { return lost_; }
  // Messages that are missing now.
  std::size_t num_missing() const { return num_missing_; }
  // The channels of which messages are missing or were given up, by name.
  struct Lacking {
    std::string channel;
    std::int64_t messages = 0;  // saturates
    bool is_listed = false;     // by heartbeats of its publisher
  };
  std::vector<Lacking> lacking() const;
  // Sessions of channels that are remembered.
  std::size_t num_flows() const { return num_flows_; }

  // Goes on where an earlier incarnation of the receiver ended: whatever precedes the first number of a flow
  // known now is not missing, and on the channels that `knows` selects all flows are known of which it
  // received anything, so that any other is missing from its start.
  using Knows = std::function<bool(std::string_view channel)>;
  void go_on(Knows knows);
  // Another run has begun: its publishers may start their sequences anew.
  void forget();

 private:
  struct Missing {
    SimTime next_request, given_up;
    SimDuration retry;
  };
  struct Span {
    std::int64_t first = 0, end = 0;
  };
  struct Publisher {
    std::int64_t session = 0;
    std::int64_t first = 0, last = -1;  // nothing before first is expected; last was received, or announced
    std::int64_t utime = std::numeric_limits<std::int64_t>::min();  // that of message `last`
    SimTime heard_at;
    bool is_heard = false;  // by more than a heartbeat
    // The node whose heartbeats list it, 0: none. Its numbers go on for as long as its session then, and what
    // is far behind is a duplicate.
    std::uint64_t lister = 0;
    SimTime listed_at;
    std::optional<std::int64_t> leap;  // the number ahead that nothing has confirmed yet
    std::map<std::int64_t, Missing> missing;
    std::vector<Span> lost;  // the latest that were given up
    std::int64_t num_lost = 0;
  };
  static constexpr std::size_t kSpansKept = 8;  // of one flow
  // Sessions kept per channel: of more than kSessionsKept those that are silent for kForgottenAfter make
  // room, so that memory stays flat while programs start anew; of kMaxSessions, or while kMaxFlows are known,
  // the one silent for longest.
  static constexpr std::size_t kSessionsKept = 4, kMaxSessions = 128, kMaxFlows = 2 * kMaxChannels;
  bool has_no_room_for(std::string_view channel) const {
    return received_.size() >= kMaxChannels && !received_.contains(channel);
  }
  using Publishers = std::vector<Publisher>;  // the one received last is at the end

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

  std::unordered_map<std::string, Publishers, TextHash, std::equal_to<>> received_;  // by channel
  Knows knows_ = knows_none;
  static constexpr std::size_t kMaxListed = 4096;
  std::unordered_set<std::int64_t> listed_;  // sessions whose flows a heartbeat has listed
  SimTime next_due_ = SimTime::never();
  std::int64_t lost_ = 0;
  // What sessions lacked that are remembered no more, by channel.
  std::map<std::string, Lacking, std::less<>> forgotten_;
  std::size_t num_missing_ = 0, num_flows_ = 0;  // of all channels
};

}  // namespace halocline::bus
