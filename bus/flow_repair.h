// Repairs what a datagram bus loses between Halocline's programs; both sides of it, for one Bus.
//
// As a publisher it keeps a bounded history of its flows, names the last number of each in a heartbeat, and
// publishes again, on REPAIR.<channel>, what is asked for. As a hearer it watches the numbers of what it hears
// and of heartbeats, and asks for what is missing (flow_watch.h) until it comes or is lost for good.
//
// A publisher without this library is not asked more than that: its gaps show, and stay.
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
  // What one request is answered with at most; the rest is asked for again.
  static constexpr std::size_t kMaxAnswerBytes = 256u << 10;

  // `name` and `session`: of the node whose Bus this is. `watch`: what it hears is told to that, which outlives this.
  FlowRepair(std::string name, std::int64_t session, FlowWatch& watch)
      : name_(std::move(name)), session_(session), history_(kHistoryBytes), watch_(watch) {}

  // ---- as a publisher
  void on_published(std::string_view channel, std::int64_t session, std::int64_t sequence, Bytes message) {
    history_.keep(channel, session, sequence, std::move(message));
  }
  // The same by an earlier life, whose flows this one goes on with: no hearer is older than they are.
  void on_published_earlier(std::string_view channel, std::int64_t session, std::int64_t sequence,
                            Bytes message) {
    resumes_ = true;
    on_published(channel, session, sequence, std::move(message));
  }
  // The messages asked for that are still kept.
  std::vector<const Bytes*> answers_to(const repair_request_t& request) const;
  const FlowHistory& history() const { return history_; }
  // The heartbeat when it is due at `steady`, which it then is a period later again.
  bool heartbeat_is_due(SimTime steady) const { return steady >= next_heartbeat_; }
  flow_heartbeat_t take_heartbeat(SimTime sim, SimTime steady);

  // ---- as a hearer
  // Returns how many messages of the flows that `hears` selects are newly missing.
  std::int64_t on_heartbeat(SimTime steady, const flow_heartbeat_t& heartbeat,
                            const std::function<bool(std::string_view channel)>& hears);
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
