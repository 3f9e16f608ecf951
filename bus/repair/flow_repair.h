// SPDX-License-Identifier: BSD-3-Clause
// Retransmission on a bus that loses datagrams: publisher and receiver side for one Bus (NACK-based reliable
// multicast).
//
// The publisher keeps a bounded history of its flows, announces the last sequence number of each in a
// heartbeat, and answers repair requests on REPAIR.<channel>. The receiver compares the sequence numbers of
// messages and heartbeats, and requests missing messages (flow_watch.h) until they are received or counted as
// lost.
//
// Gaps of a publisher that does not use this library are counted, but cannot be repaired.
//
// Requests cannot be used to flood the bus. A message is answered at most once in 40 ms (flow_history.h), and
// answers are limited by a token bucket (Turner 1986) that gains kAnswersPerMessage with each message
// published and kAnswersPerS with time: enough for several receivers of a bus that loses every third
// datagram, and never more than a small multiple of the node's own traffic.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "bus/messages/messages.h"
#include "bus/repair/flow_history.h"
#include "bus/repair/flow_watch.h"
#include "core/sim_time.h"

namespace halocline::bus {

class FlowRepair {
 public:
  static constexpr SimDuration kHeartbeatPeriod = SimDuration::from_milliseconds(250);
  static constexpr std::size_t kHistoryBytes = 16u << 20;
  // Limit on the answers of one step; one message is always sent.
  static constexpr std::size_t kMaxAnswerBytes = 256u << 10;

  static constexpr double kAnswersPerMessage = 3, kAnswersPerS = 200, kMinAnswers = 256, kMaxAnswers = 8192;
  // Maximum number of requested messages that wait for their answers; further ones are dropped, as receivers
  // repeat their requests.
  static constexpr std::size_t kMaxWanted = 8192;

  // `name` and `session` identify the node of this Bus. `watch` is its gap detector, which must outlive this
  // object.
  FlowRepair(std::string name, std::int64_t session, FlowWatch& watch)
      : name_(std::move(name)), session_(session), history_(kHistoryBytes), watch_(watch) {}

  // ---- publisher side
  void on_published(std::string_view channel, std::int64_t session, std::int64_t sequence, Bytes message) {
    history_.keep(channel, session, sequence, std::move(message));
    answers_ = std::min(answers_ + kAnswersPerMessage, kMaxAnswers);
  }
  // Stores a message published by an earlier incarnation, whose flows this one continues. Such flows are
  // announced as older than any receiver.
  void restore_history(std::string_view channel, std::int64_t session, std::int64_t sequence, Bytes message) {
    resumes_ = true;
    on_published(channel, session, sequence, std::move(message));
  }
  // Queues the requested messages that are still stored.
  void on_request(SimTime steady, const repair_request_t& request);
  // Returns the messages to publish now, on REPAIR.<channel>; they are valid until the next call.
  struct Answer {
    std::string channel;
    const Bytes* message = nullptr;
  };
  std::vector<Answer> take_answers(SimTime steady);
  const FlowHistory& history() const { return history_; }
  // take_heartbeat() schedules the next heartbeat one period later.
  bool heartbeat_is_due(SimTime steady) const { return steady >= next_heartbeat_; }
  flow_heartbeat_t take_heartbeat(SimTime sim, SimTime steady);
  // Makes the next heartbeat due at once: nothing more will be published.
  void hasten_heartbeat(SimTime steady) { next_heartbeat_ = std::min(next_heartbeat_, steady); }
  // Number of requested messages that were still stored, since the start.
  std::int64_t num_requested() const { return num_requested_; }

  // ---- receiver side
  // Processes HEARTBEAT.<node>. Returns how many messages are newly missing of the flows that
  // `is_subscribed_to` selects. A flow of which no message was received is tracked only from the second
  // heartbeat of its session on, so that a single datagram cannot create a flow.
  std::int64_t on_heartbeat(SimTime steady, std::string_view node, const flow_heartbeat_t& heartbeat,
                            const std::function<bool(std::string_view channel)>& is_subscribed_to);
  // True for a copy of an old heartbeat: neither its number nor its time advances. It carries no information
  // then, not even that its publisher is alive.
  bool is_old(const flow_heartbeat_t& heartbeat) const;
  std::vector<repair_request_t> take_requests(SimTime sim, SimTime steady);
  // More channels are received from now on: messages published on them earlier are not missing.
  void on_subscribed(SimTime steady) {
    subscribed_ = steady;
    watch_.forget_listed();
  }

  // Time at which the next heartbeat, answer or request is due.
  SimTime next_due() const {
    return std::min({next_heartbeat_, watch_.next_due(), wanted_.empty() ? SimTime::never() : next_answer_});
  }

 private:
  struct Wanted {
    std::string channel;
    std::int64_t session = 0, sequence = 0;
  };
  struct Heard {
    SimTime first, last;
    std::int64_t utime = 0, sequence = 0;  // values of the last heartbeat
  };
  bool is_known(SimTime steady, const flow_heartbeat_t& heartbeat);

  std::string name_;
  std::int64_t session_;
  FlowHistory history_;
  FlowWatch& watch_;
  SimTime next_heartbeat_ = SimTime::at_once();
  SimTime began_, subscribed_;
  std::int64_t heartbeats_ = 0;
  bool resumes_ = false;
  std::deque<Wanted> wanted_;
  std::int64_t num_requested_ = 0;
  double answers_ = kMinAnswers;  // tokens in the bucket at filled_at_
  SimTime filled_at_, next_answer_ = SimTime::at_once();
  std::unordered_map<std::int64_t, Heard> heartbeats_of_others_;  // keyed by session; bounded
};

}  // namespace halocline::bus
