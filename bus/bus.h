// SPDX-License-Identifier: BSD-3-Clause
// Bus endpoint of one node: typed publish and subscribe on an lcm::LCM, robust against anything a bus may
// carry.
//
// A message that does not decode, or whose values are impossible (message_codec.h), is counted, reported with
// its channel and reason (the 1st, 10th, 100th, ... of a kind), and ignored. A gap in a publisher's sequence
// numbers (session, sequence) is counted, and repaired after enable_repair(). An exception that a handler
// throws never crosses LCM's C frames: rethrow_if_failed() throws it.
//
//   Bus bus(lcm, {"channel-server", session});
//   bus.subscribe<vehicle_state_t>(channels::kState,
//                                  [&](std::string_view vehicle, const vehicle_state_t& s) { ... });
//
// One Bus belongs to one node. Several may share an lcm::LCM, which must outlive them; with memq they have to
// share one. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "bus/messages/channel_pattern.h"
#include "bus/messages/channels.h"
#include "bus/messages/message_codec.h"
#include "bus/messages/sequence_number.h"
#include "bus/repair/flow_repair.h"
#include "bus/repair/flow_watch.h"
#include "bus/repair/session_watch.h"
#include "bus/transport/event_log.h"
#include "bus/transport/lateness_watch.h"
#include "bus/transport/node_identity.h"
#include "bus/transport/publication_pace.h"
#include "bus/transport/subscription.h"
#include "bus/transport/unsent_messages.h"
#include "core/names.h"
#include "core/sim_time.h"

namespace halocline::bus {

class Bus {
 public:
  template <class Message>
  using Handler = std::function<void(const Message&)>;
  // `name` is the part of the channel after the family's dot; it is a valid name.
  template <class Message>
  using FamilyHandler = std::function<void(std::string_view name, const Message&)>;

  Bus(lcm::LCM& lcm, NodeIdentity identity);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  // Encodes and publishes. A message that the network refuses is counted, reported, and sent again by the
  // next publish() or repair() (unsent_messages.h).
  template <class Message>
  void publish(std::string_view channel, const Message& message);
  template <class Message>
  void subscribe(std::string_view channel, Handler<Message> handler, Wakeup wakeup = Wakeup::kMayAdvanceDue);
  template <class Message>
  void subscribe(const Family& family, FamilyHandler<Message> handler,
                 Wakeup wakeup = Wakeup::kMayAdvanceDue);
  // Subscribes a handler that only stores the newest message (newest()).
  template <class Message>
  void subscribe_newest(std::string_view channel, Handler<Message> handler) {
    subscribe<Message>(channel, newest<Message>(std::move(handler)), Wakeup::kStoreOnly);
  }

  // Redirects every published message to `outbox` instead of LCM; the runner of the node delivers it. Returns
  // the previous outbox.
  using Outbox = std::function<void(std::string_view channel, const void* data, std::size_t size)>;
  Outbox set_outbox(Outbox outbox) { return std::exchange(outbox_, std::move(outbox)); }
  // Publishes on the LCM instance that `route` returns for a channel, instead of the one that receives.
  using Route = std::function<lcm::LCM&(std::string_view channel)>;
  void set_route(Route route) { route_ = std::move(route); }
  // Subscriptions in the order in which they were made, and the indices of those that match a channel.
  const std::vector<Subscribed>& subscribed() const { return subscribed_; }
  std::vector<std::size_t> subscribed_to(std::string_view channel) const;
  const Subscriptions& receives() const { return receives_; }

  // Raw messages, for bridges and recorders: they are neither decoded nor counted as received.
  using RawHandler = std::function<void(std::string_view channel, const void* data, std::size_t size)>;
  void publish_bytes(std::string_view channel, const void* data, std::size_t size);
  void subscribe_to_all(RawHandler handler);
  // Raw subscription for a recorder: passes on each message of a flow once, under its own channel, and
  // requests missing messages.
  void subscribe_to_all_flows(FlowOf flow_of, RawHandler handler);
  const FlowWatch& flows() const { return flows_; }
  SimTime received_at() const { return received_at_; }     // Unix time, by LCM, of the current message
  void set_tap(RawHandler tap) { tap_ = std::move(tap); }  // gets each accepted message before its handler
  // Handles a message as if LCM had dispatched it. Used by a runner in LCM's place, and to replay the input
  // of an earlier incarnation of this node (message_journal.h), so that its gaps are known and repaired.
  // Throws what a handler throws.
  void deliver(std::string_view channel, std::span<const std::uint8_t> message);
  // Adds a message published by an earlier incarnation to the history from which repair requests are
  // answered. Call it after enable_repair().
  void restore_history(std::string_view channel, std::int64_t session, std::int64_t sequence, Bytes bytes);
  const FlowRepair* flow_repair() const { return repair_.get(); }  // null before enable_repair()
  void rethrow_if_failed();  // throws, once, what a handler threw while LCM dispatched
  // For a bus that loses datagrams: repairs losses, drops duplicates (flow_repair.h), refuses duplicate
  // publishers (session_watch.h) and paces bursts (publication_pace.h). The runner calls set_steady() before
  // LCM dispatches, and repair() not later than next_repair().
  void enable_repair();
  void set_steady(SimTime steady) { steady_ = steady; }
  void repair(SimTime sim, SimTime steady, bool may_request = true);
  SimTime next_repair() const;
  void announce_flows();  // sends a heartbeat in the next repair(): nothing more will be published
  void forget_flows() { flows_.forget(); }  // another run has begun: sequences may restart
  // Continues the flows of earlier incarnations (FlowWatch::go_on).
  void continue_flows(FlowWatch::Knows knows) { flows_.go_on(std::move(knows)); }
  std::size_t num_missing() const { return flows_.num_missing(); }  // messages missing and requested
  LatenessWatch& lateness() { return lateness_; }  // lateness of the results that this node publishes
  const NodeIdentity& identity() const { return identity_; }
  BusCounters& counters() { return counters_; }
  const BusCounters& counters() const { return counters_; }
  EventLog& log() { return log_; }
  // Refuses a message that the node itself finds impossible.
  void refuse(std::string_view channel, std::string_view reason);

 private:
  struct Subscription;
  struct ChannelGroup;
  // `regular_expression` matches channels; a message on REPAIR.<channel> is handled as if received on
  // <channel>.
  void subscribe_raw(const std::string& regular_expression, RawHandler handler, Wakeup wakeup);
  void subscribe_channel(std::string_view channel, RawHandler handler, Wakeup wakeup);
  Subscription& add_subscription(const std::string& regular_expression, RawHandler handler, Wakeup wakeup);
  const std::vector<const Subscription*>& subscriptions_to(std::string_view channel);
  template <class Message>
  [[nodiscard]] bool accept(std::string_view channel, const void* data, std::size_t size, Message& message);
  void refuse_duplicate_publisher(std::string_view channel, std::int64_t session);
  bool takes(std::string_view channel, const FlowHead& head, bool as_bytes = false);
  void on_heartbeat(std::string_view node, const flow_heartbeat_t& heartbeat);
  void note_lateness(std::string_view channel, const void* data, std::size_t size);
  bool send(const std::string& channel, const void* data, std::size_t size);
  void send_unsent();

  lcm::LCM& lcm_;
  NodeIdentity identity_;
  BusCounters counters_;
  EventLog log_;
  FlowWatch flows_;
  SessionWatch sessions_;
  std::unique_ptr<FlowRepair> repair_;
  std::unique_ptr<PublicationPace> pace_;
  UnsentMessages unsent_;
  LatenessWatch lateness_;
  SimTime steady_, received_at_;
  // `is_repair_`: the current message came on REPAIR.<channel>; `tracks_all_`: all flows are recorded.
  bool is_repair_ = false, tracks_all_ = false;
  std::map<std::string, std::int64_t, std::less<>> refusals_;  // counts by kind, for rate-limited reports
  std::exception_ptr failure_;
  std::vector<std::unique_ptr<Subscription>> subscriptions_;
  std::map<std::string, std::unique_ptr<ChannelGroup>, std::less<>> groups_;  // keyed by prefix
  std::vector<Subscribed> subscribed_;
  ChannelPatterns patterns_;  // patterns of subscribed_
  std::map<std::string, std::vector<const Subscription*>, std::less<>> subscriptions_to_;  // cache by channel
  Subscriptions receives_;
  Outbox outbox_;
  Route route_;
  RawHandler tap_;
};

template <class Message>
void Bus::publish(std::string_view channel, const Message& message) {
  Bytes bytes = encoded(message);
  publish_bytes(channel, bytes.data(), bytes.size());
  if constexpr (IsOfFlow<Message>) {
    if (repair_) repair_->on_published(channel, message.session, sequence_of(message), std::move(bytes));
  }
}

template <class Message>
void Bus::subscribe(std::string_view channel, Handler<Message> handler, Wakeup wakeup) {
  const auto decode_and_handle = [this, handler = std::move(handler)](std::string_view received_on,
                                                                      const void* data, std::size_t size) {
    Message message;
    if (accept(received_on, data, size, message)) handler(message);
  };
  subscribe_channel(channel, decode_and_handle, wakeup);
}

template <class Message>
void Bus::subscribe(const Family& family, FamilyHandler<Message> handler, Wakeup wakeup) {
  const std::string_view prefix = family.prefix;
  const auto decode_and_handle = [this, prefix, handler = std::move(handler)](
                                     std::string_view received_on, const void* data, std::size_t size) {
    const std::string_view name = received_on.substr(prefix.size());
    if (!is_valid_name(name)) return refuse(received_on, "the channel's name is no valid name");
    Message message;
    if (accept(received_on, data, size, message)) handler(name, message);
  };
  subscribe_raw(escaped(prefix) + ".*", decode_and_handle, wakeup);
}

template <class Message>
bool Bus::accept(std::string_view channel, const void* data, std::size_t size, Message& message) {
  const std::string problem = decode(std::span(static_cast<const std::uint8_t*>(data), size), message);
  if (!problem.empty()) {
    refuse(channel, problem);
    return false;
  }
  if constexpr (IsOfFlow<Message>) {
    if (!takes(channel, flow_head_of(message))) return false;
  } else
    ++counters_.received;
  if (tap_) tap_(channel, data, size);
  return true;
}

}  // namespace halocline::bus
