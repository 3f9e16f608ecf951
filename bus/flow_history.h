// SPDX-License-Identifier: BSD-3-Clause
// Retransmission buffer of one publisher: its latest messages by flow and sequence number, from which repair
// requests are answered. Bounded: the oldest messages of all flows make room, then the flow published on
// longest ago; of messages older than kMaxAge only the last of each flow is kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "bus/message_codec.h"
#include "core/limits.h"
#include "core/sim_time.h"

namespace halocline::bus {

class FlowHistory {
 public:
  static constexpr std::size_t kMaxFlows = 4 * kMaxVehicles;
  // Flows in one listing.
  static constexpr std::size_t kMaxListed = 500;
  // A message is answered at most once in this: as long as its receivers wait before they request it again
  // (flow_watch.h).
  static constexpr SimDuration kAnswerInterval = SimDuration::from_milliseconds(40);
  // Much longer than any receiver requests a message (flow_watch.h), so that a node's memory settles within
  // it.
  static constexpr SimDuration kMaxAge = SimDuration::from_milliseconds(120'000);
  // `max_bytes` of messages are kept, and the last message whatever its size.
  explicit FlowHistory(std::size_t max_bytes) : max_bytes_(max_bytes) {}
  FlowHistory(const FlowHistory&) = delete;
  FlowHistory& operator=(const FlowHistory&) = delete;

  // A message of the flow (channel, session) was published. One with a number that is kept already changes
  // nothing.
  void keep(std::string_view channel, std::int64_t session, std::int64_t sequence, Bytes message);
  // Forgets what was kept more than kMaxAge ago, to a second; to be called every now and then. `steady` never
  // decreases.
  void forget_old(SimTime steady);
  // Whether a requested message is to be answered: it is kept, not wanted already, and was not answered
  // within kAnswerInterval. It is wanted then.
  bool want(std::string_view channel, std::int64_t session, std::int64_t sequence, SimTime steady);
  // A message that was wanted and is answered now; null when it is not kept any more.
  const Bytes* answer(std::string_view channel, std::int64_t session, std::int64_t sequence, SimTime steady);
  // The message, or null when it is not kept (any more).
  const Bytes* find(std::string_view channel, std::int64_t session, std::int64_t sequence) const;

  struct Flow {
    std::string channel;
    std::int64_t session = 0, last = 0;  // the greatest number so far
  };
  // All flows where they are kMaxListed at most. Otherwise those that have been silent since the listing
  // before, because the next message of a flow says more than a listing: first those listed the fewest times
  // since their last message, then those silent longest.
  std::vector<Flow> take_listing();
  std::size_t num_flows() const { return flows_.size(); }
  std::size_t num_messages() const { return messages_.size(); }

  // How many messages were published so far.
  std::uint64_t published() const { return published_; }
  // The flows with a message after the first `published` ones, each with its last message, in the order of
  // these; without those that are not kept any more.
  struct LastMessage {
    const Flow* flow = nullptr;
    const Bytes* message = nullptr;
  };
  std::vector<LastMessage> last_messages(std::uint64_t published = 0) const;

 private:
  struct Kept {
    Flow flow;
    std::uint64_t published = 0;  // with its latest message
    int listed = 0;               // times since then
    std::map<std::int64_t, std::uint64_t>
        places;  // of the messages that are kept, by sequence; they count from the first of all flows
  };
  using Flows = std::list<Kept>;  // the one published on last is at the end
  struct Message {
    Flows::iterator flow;  // end() of one that is forgotten
    std::int64_t sequence = 0;
    Bytes bytes;
    SimTime answered = SimTime::at_once();  // steady
    bool is_wanted = false;
  };
  using FlowName = std::pair<std::string_view, std::int64_t>;  // channel (of Kept), session
  struct HashOfName {
    std::size_t operator()(const FlowName& name) const {
      return std::hash<std::string_view>()(name.first) ^ std::hash<std::int64_t>()(name.second);
    }
  };
  Kept& latest(std::string_view channel, std::int64_t session, std::int64_t sequence);
  const Message* find(const Kept& kept, std::int64_t sequence) const;
  Message* find_message(std::string_view channel, std::int64_t session, std::int64_t sequence);
  void forget_oldest_message();
  void renew_oldest_message();
  void forget_oldest_flow();

  std::size_t max_bytes_, bytes_ = 0;
  std::uint64_t published_ = 0, published_when_listed_ = 0, first_place_ = 0;
  Flows flows_;
  std::unordered_map<FlowName, Flows::iterator, HashOfName> by_name_;
  std::deque<Message> messages_;
  struct Mark {
    SimTime steady;
    std::uint64_t place = 0;  // of the first message kept after it
  };
  std::deque<Mark> marks_;  // at least a second apart
};

}  // namespace halocline::bus
