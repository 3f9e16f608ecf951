// Retransmission on a bus that loses datagrams: publisher and receiver side for one Bus (NACK-based reliable
// multicast).
//
// The publisher keeps a bounded history of its flows, announces the last sequence number of each in a heartbeat,
// and answers repair requests on REPAIR.<channel>. The receiver compares the sequence numbers of messages and
// heartbeats, and requests what is missing (flow_watch.h) until it is received or given up.
//
// The gaps of a publisher without this library are counted, and stay.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bus/flow_history.h"
#include "bus/flow_watch.h"
#include "bus/messages.h"
#include "core/sim_time.h"

namespace halocline::bus {

class FlowRepair {
 public:
  static constexpr SimDuration kHeartbeatPeriod = SimDuration::from_milliseconds(250);
  static constexpr std::size_t kHistoryBytes = 16u << 20;
  // Largest answer to one request; the receiver requests the rest again.
  static constexpr std::size_t kMaxAnswerBytes = 256u << 10;

  // `name` and `session`: of the node whose Bus this is. `watch`: its gap detector, which must outlive this.
  FlowRepair(std::string name, std::int64_t session, FlowWatch& watch)
      : name_(std::move(name)), session_(session), history_(kHistoryBytes), watch_(watch) {}

  // ---- as a publisher
  void on_published(std::string_view channel, std::int64_t session, std::int64_t sequence, Bytes message) {
    history_.keep(channel, session, sequence, std::move(message));
  }
  // The same by an earlier incarnation, whose flows this one continues: they are older than any receiver.
  void restore_history(std::string_view channel, std::int64_t session, std::int64_t sequence, Bytes message) {
    resumes_ = true;
    on_published(channel, session, sequence, std::move(message));
  }
  // The requested messages that are still kept.
  std::vector<const Bytes*> answers_to(const repair_request_t& request) const;
  const FlowHistory& history() const { return history_; }
  // take_heartbeat() schedules the next a period later.
  bool heartbeat_is_due(SimTime steady) const { return steady >= next_heartbeat_; }
  flow_heartbeat_t take_heartbeat(SimTime sim, SimTime steady);

  // ---- as a receiver
  // Returns how many messages of the flows that `is_subscribed_to` selects are newly missing.
  std::int64_t on_heartbeat(SimTime steady, const flow_heartbeat_t& heartbeat,
                            const std::function<bool(std::string_view channel)>& is_subscribed_to);
  std::vector<repair_request_t> take_requests(SimTime sim, SimTime steady);

  // When a heartbeat or a request is due.
  SimTime next_due() const { return std::min(next_heartbeat_, watch_.next_due()); }

 private:
  std::string name_;
  std::int64_t session_;
  FlowHistory history_;
  FlowWatch& watch_;
  SimTime next_heartbeat_ = SimTime::at_once();
  SimTime began_;
  std::int64_t heartbeats_ = 0;
  bool resumes_ = false;
};

}  // namespace halocline::bus
