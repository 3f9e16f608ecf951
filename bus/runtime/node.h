// SPDX-License-Identifier: BSD-3-Clause
// Node: the thin adapter between the bus and a model without side effects. Handlers store messages; a step
// computes and publishes.
//
// A node never reads a clock. Its runner (run_node, LockstepRunner, a test) dispatches LCM, queries when the
// node is due, and calls step() with the time. Results depend only on simulation time. Steady time serves the
// process: time-outs of requests, STATUS. In lockstep the two are the same.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bus/bus.h"
#include "bus/recovery/state_journal.h"
#include "bus/transport/lateness_watch.h"
#include "bus/transport/node_identity.h"
#include "bus/transport/subscription.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::bus {

// Instant of a step: simulation time, and the process's steady time (since its start, never decreasing).
struct Now {
  SimTime sim;
  SimTime steady;
  bool sim_known = true;  // false until the process has learnt the simulation time; sim is 0 then
  // Simulation time by the process's time source. Later than `sim` while the node catches up; other nodes may
  // already be there.
  SimTime clock = SimTime::at_once();
  SimTime latest() const { return std::max(sim, clock); }
};

// Time of a node's next step: the earlier of the two. SimTime::at_once() while work is waiting that does not
// depend on simulation time (the answer to a query). A node that is due at a steady time is stepped then even
// if simulation time is unknown (Now::sim_known).
struct Due {
  SimTime sim = SimTime::never();
  SimTime steady = SimTime::never();
};

class Node {
 public:
  using ChannelTest = std::function<bool(std::string_view channel)>;

  // Derived constructors make the subscriptions; nothing is published before the first step.
  Node(lcm::LCM& lcm, NodeIdentity identity) : bus_(lcm, std::move(identity)) {}
  virtual ~Node() = default;
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  const std::string& name() const { return bus_.identity().name; }
  const BusCounters& counters() const { return bus_.counters(); }

  // For a node on a bus that loses datagrams: call once, before its first step (Bus::enable_repair).
  void enable_repair() { bus_.enable_repair(); }
  bool has_repair() const { return bus_.flow_repair() != nullptr; }
  // Keeps the node's state in `journal` from now on, after restoring the state that an earlier incarnation
  // left there: the node continues from that state, with its sequence numbers. Call once, after
  // enable_repair() and before anything is received, for a node that was made with the session in the
  // journal. Throws InvalidArgument when the state is another node's.
  //
  // The messages of a step are published after the state that follows from it was written (output commit:
  // Elnozahy, Alvisi, Wang and Johnson 2002, "A survey of rollback-recovery protocols in message-passing
  // systems", section 2.4). The next incarnation therefore contradicts none of this one's messages. Messages
  // received since the last step are lost, as if the node had been killed before it received them.
  void keep_state_in(std::unique_ptr<StateJournal> journal);
  // Messages handled from now on were received at this steady time. `is_behind`: more messages are waiting
  // than were handled, so the node requests no repairs, which would add to them.
  void set_steady(SimTime steady, bool is_behind = false) {
    bus_.set_steady(steady);
    is_behind_ = is_behind;
  }
  // Sets the clock of lateness: results published more than `limit` after their instant are late.
  void set_clock(LatenessWatch::Clock clock, SimDuration limit) {
    bus_.lateness().set_clock(std::move(clock), limit);
  }
  // True when messages are missing that may still be repaired.
  bool misses_messages() const { return bus_.num_missing() > 0; }
  // True for a node whose results depend on everything that others have published up to their instant. After
  // a halt of its process it continues once the missing messages have been repaired.
  virtual bool waits_for_repair() const { return false; }
  // Adds the number of CLOCKs refused since the last call: those of a second conductor, and unconfirmed leaps
  // of the first.
  void count_refused_clocks(std::int64_t count);
  Stage stage() const { return bus_.identity().stage; }
  // Subscriptions, reception and destination of messages, for a runner that delivers in LCM's place (bus.h).
  const std::vector<Subscribed>& subscribed() const { return bus_.subscribed(); }
  std::vector<std::size_t> subscribed_to(std::string_view channel) const {
    return bus_.subscribed_to(channel);
  }
  void receive(std::string_view channel, std::span<const std::uint8_t> message) {
    bus_.deliver(channel, message);
  }
  const Subscriptions& receives() const { return bus_.receives(); }
  void set_outbox(Bus::Outbox outbox) { bus_.set_outbox(std::move(outbox)); }
  void set_route(Bus::Route route) { bus_.set_route(std::move(route)); }

  Due due() const;
  // Returns when the node is due in lockstep, where steady time is simulation time.
  SimTime lockstep_due() const;
  // Returns the node's lookahead in lockstep: it publishes nothing before this time on channels for which
  // `matters` is true, unless it receives a message that is not a service's (lockstep_schedule.h). It is
  // later than the due time if the node steps without publishing on these channels.
  SimTime lookahead(const ChannelTest& matters) const;
  // Invalidates the cached due(), which otherwise changes only with a message that may advance it, or a call
  // of the runner. Call it when something else has changed the due time.
  void note_due_changed() { known_due_.reset(); }
  // Returns a file descriptor that is readable when the node has work besides messages and its due time; -1:
  // none. A runner in real time watches it and calls note_due_changed().
  virtual int ready_file() const { return -1; }
  // Rethrows what a handler threw; computes and publishes everything that is due; then publishes STATUS if a
  // second has passed.
  void step(const Now& now);
  // Another run has begun at `now`.
  void restart(const Now& now);
  // Last step: publishes remaining messages, then a final STATUS.
  void stop(const Now& now);
  // Repairs after stop(), on a bus that loses datagrams: announces the last number of each flow if
  // `announces`, answers repair requests, and requests what the node itself misses. Returns true if anybody
  // has requested a message since the last call.
  bool repair_after_stop(const Now& now, bool announces);
  // True when the node misses messages without which it must not end.
  virtual bool wants_repair() const { return false; }

 protected:
  virtual Due on_due() const = 0;
  // Lookahead without STATUS; otherwise as lookahead(). A channel of a family may be tested by any of its
  // names. at_once(): the node has no lookahead beyond its due time.
  virtual SimTime on_lookahead(const ChannelTest& /*matters*/) const { return SimTime::at_once(); }
  virtual void on_step(const Now& now) = 0;
  virtual void on_stop(const Now& /*now*/) {}
  // Simulation time jumped back: another run has begun. Discard the messages received in the old one.
  virtual void on_restart(const Now& /*now*/) {}
  // Saves and loads the state from which the next incarnation continues. The first step after loading may be
  // at any later time.
  virtual void on_archive(Archive& /*a*/) {}
  // True if a step that published nothing has changed state that the journal must hold before on_committed().
  virtual bool on_wants_commit() { return false; }
  // Called after a step whose resulting state is on disk, for output that does not go over the bus.
  virtual void on_committed() {}
  virtual std::string status_text() const = 0;

  Bus& bus() { return bus_; }
  const Bus& bus() const { return bus_; }

 private:
  void publish_status(const Now& now, const std::string& text);
  void report_lateness(const Now& now, const Lateness& lateness);
  void commit(const Now& now, const std::function<void()>& publish_all);
  void publish_after_journal(const Now& now, const std::function<void()>& publish_all);
  void write_journal(SimTime now);
  void restore_published(std::span<const std::uint8_t> messages);
  void load(const StateJournal::Saved& saved);
  void check_run(const Now& now);
  const Due& known_due() const;

  Bus bus_;
  mutable std::optional<Due> known_due_;  // cached on_due(), until it may have changed
  mutable std::int64_t wakeups_at_due_ = 0;
  SimTime next_status_, next_lateness_report_;  // steady
  std::int64_t status_sequence_ = 0;
  bool is_behind_ = false;
  std::int64_t requests_seen_ = 0;  // seen by repair_after_stop()
  std::unique_ptr<StateJournal> journal_;
  bool has_journal_ = true;              // false once the disk refused a record
  Archive saved_;                        // state in the last journal record
  std::uint64_t published_saved_ = 0;    // value of FlowHistory::published() at the last journal record
  std::optional<SimTime> resumed_from_;  // set until the first step
};

}  // namespace halocline::bus
