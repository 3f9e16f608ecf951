// Tells a gap from silence, for one hearer: follows the numbers (session, sequence) of each channel's publishers,
// knows which messages are missing, and says when to ask for them again.
//
// A publisher that keeps no numbers sends 0 for both always, and is not watched. What came before the first
// message heard of a flow is not missing, unless the hearer has listened since before the flow began: it is
// older than the publisher, or met the publisher when it had no such flow yet. A new session starts anew
// without a gap: its publisher was started again.
//
// Pure: values in, values out; `steady` is the caller's steady time, never set back.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/sim_time.h"

namespace halocline::bus {

class FlowWatch {
 public:
  // A missing message is asked for after this: datagrams that overtook each other need no repair.
  static constexpr SimDuration kPatience = SimDuration::from_milliseconds(5);
  // Between the first two requests for a message; it doubles with each.
  static constexpr SimDuration kFirstRetry = SimDuration::from_milliseconds(40);
  static constexpr SimDuration kLongestRetry = SimDuration::from_milliseconds(640);
  // After this a missing message is lost.
  static constexpr SimDuration kGivenUpAfter = SimDuration::from_milliseconds(10'000);
  // What a flow misses at most before the oldest count as lost.
  static constexpr std::size_t kMaxMissing = 2000;
  static constexpr std::size_t kMaxInARequest = 200;
  // Channels beyond these are not watched: names made up without end must not grow our memory.
  static constexpr std::size_t kMaxChannels = 20'000;

  // How a received message fits into its flow.
  struct Classification {
    std::int64_t newly_missing = 0;  // how many lie between it and the greatest number heard before
    bool fills_gap = false;          // it was missing
    bool is_repeated = false;        // its number was heard a moment ago (of 64 numbers, within a second)
  };
  // `answered`: it came in answer to a request, perhaps of another hearer; then it either fills a gap or is
  // repeated.
  Classification on_message(SimTime steady, std::string_view channel, std::int64_t session,
                            std::int64_t sequence, bool answered = false);

  // The publisher says that `last` was the last number of its flow. `from_its_start`: the hearer is older than
  // the publisher, so all numbers from 0 are its own. Returns how many are newly missing.
  std::int64_t on_last(SimTime steady, std::string_view channel, std::int64_t session, std::int64_t last,
                       bool from_its_start = false);
  // A publisher has named all its flows (each in on_last): one that it has not named yet begins after now.
  void on_all_named(std::int64_t session);

  // A request for some of what is missing of a flow.
  struct Request {
    std::string channel;
    std::int64_t session = 0;
    std::vector<std::int64_t> sequences;  // ascending, 1 to kMaxInARequest
  };
  // What is to be asked for now; and gives up what has been missing for too long.
  std::vector<Request> take_due(SimTime steady);
  // When take_due has something to do; never() while nothing is missing.
  SimTime next_due() const { return next_due_; }
  // How many messages were given up since the start.
  std::int64_t lost() const { return lost_; }

  // Another run has begun: its publishers may number anew.
  void forget();

 private:
  struct Missing {
    SimTime next_request, given_up;
    SimDuration retry;
  };
  struct Publisher {
    std::int64_t session = 0;
    std::int64_t first = 0, last = -1;  // numbers below first are not its hearer's; last was heard, or named
    SimTime heard_at;
    std::map<std::int64_t, Missing> missing;
  };
  // A channel remembers few sessions: the one silent for longest makes room, so that a long run does not grow.
  static constexpr std::size_t kSessionsKept = 8;
  bool has_no_room_for(std::string_view channel) const {
    return heard_.size() >= kMaxChannels && !heard_.contains(channel);
  }
  using Publishers = std::vector<Publisher>;  // ends in the one heard last

  Publisher* find(std::string_view channel, std::int64_t session);
  Publisher& add(std::string_view channel, std::int64_t session, std::int64_t first);
  std::int64_t miss(Publisher& publisher, SimTime steady, std::int64_t first, std::int64_t end);

  std::map<std::string, Publishers, std::less<>> heard_;
  std::deque<std::int64_t> named_;  // sessions that have named their flows, the latest last
  SimTime next_due_ = SimTime::never();
  std::int64_t lost_ = 0;
};

}  // namespace halocline::bus
