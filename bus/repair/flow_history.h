// SPDX-License-Identifier: BSD-3-Clause
// Retransmission buffer of one publisher: its latest messages by flow and sequence number, from which repair
// requests are answered.
//
// The memory is bounded. When it is full, the oldest messages of all flows are dropped; when there are too
// many flows, the one that has been silent for longest. Of messages older than kMaxAge only the last of each
// flow is kept.
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

#include "bus/messages/message_codec.h"
#include "core/limits.h"
#include "core/sim_time.h"

namespace halocline::bus {

class FlowHistory {
 public:
  static constexpr std::size_t kMaxFlows = 4 * kMaxVehicles;
  // Maximum number of flows in one heartbeat.
  static constexpr std::size_t kMaxListed = 500;
  // Minimum time between two answers for one message: as long as receivers wait before they request it again
  // (flow_watch.h).
  static constexpr SimDuration kAnswerInterval = SimDuration::from_milliseconds(40);
  // Much longer than any receiver requests a message (flow_watch.h); the memory of a node settles within this
  // time.
  static constexpr SimDuration kMaxAge = SimDuration::from_milliseconds(120'000);
  // Keeps at most `max_bytes` of messages, but always the last message, whatever its size.
  explicit FlowHistory(std::size_t max_bytes) : max_bytes_(max_bytes) {}
  FlowHistory(const FlowHistory&) = delete;
  FlowHistory& operator=(const FlowHistory&) = delete;

  // Stores a published message of the flow (channel, session). A sequence number that is already stored
  // changes nothing.
  void keep(std::string_view channel, std::int64_t session, std::int64_t sequence, Bytes message);
  // Drops the messages that were stored more than kMaxAge ago, to within a second. Call it regularly;
  // `steady` never decreases.
  void forget_old(SimTime steady);
  // Returns true, and marks the message as wanted, when a requested message is to be answered: it is stored,
  // not yet wanted, and was not answered within kAnswerInterval.
  bool want(std::string_view channel, std::int64_t session, std::int64_t sequence, SimTime steady);
  // Returns a wanted message, which is answered now; null if it is no longer stored.
  const Bytes* answer(std::string_view channel, std::int64_t session, std::int64_t sequence, SimTime steady);
  // Returns the message, or null if it is not stored.
  const Bytes* find(std::string_view channel, std::int64_t session, std::int64_t sequence) const;

  struct Flow {
    std::string channel;
    std::int64_t session = 0, last = 0;  // highest sequence number so far
  };
  // Returns the flows to list in the next heartbeat: all of them if there are at most kMaxListed. Otherwise
  // only those that have been silent since the previous listing, because the next message of any other flow
  // tells receivers more than a listing. Among these, first those listed the fewest times since their last
  // message, then those that have been silent for longest.
  std::vector<Flow> take_listing();
  std::size_t num_flows() const { return flows_.size(); }

  // Total number of messages published so far.
  std::uint64_t published() const { return published_; }
  // Returns the flows with a message after the first `published` ones, each with its last message, in the
  // order of publication. Flows whose last message is no longer stored are left out.
  struct LastMessage {
    const Flow* flow = nullptr;
    const Bytes* message = nullptr;
  };
  std::vector<LastMessage> last_messages(std::uint64_t published = 0) const;

 private:
  struct Kept {
    Flow flow;
    std::uint64_t published = 0;  // value of published_ at its latest message
    int listed = 0;               // number of listings since then
    // Stored messages by sequence: their positions, counted from the first message of all flows.
    std::map<std::int64_t, std::uint64_t> places;
  };
  using Flows = std::list<Kept>;  // ordered by publication, the latest at the end
  struct Message {
    Flows::iterator flow;  // end() if the flow was dropped
    std::int64_t sequence = 0;
    Bytes bytes;
    SimTime answered = SimTime::at_once();  // steady
    bool is_wanted = false;
  };
  using FlowName = std::pair<std::string_view, std::int64_t>;  // channel (points into Kept), session
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
    std::uint64_t place = 0;  // position of the first message stored after it
  };
  std::deque<Mark> marks_;  // at least a second apart
};

}  // namespace halocline::bus
