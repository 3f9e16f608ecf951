// SPDX-License-Identifier: BSD-3-Clause
// A node: the thin adapter between the bus and a pure core. Handlers store; a step computes and publishes.
//
// A node never reads a clock. Its runner (run_node, LockstepRunner, a test) dispatches LCM, queries when the
// node is due, and calls step with the time. Results depend on simulation time; steady time is for the
// process alone: time-outs of requests, STATUS. Under lockstep the two are the same.
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
#include "bus/node_identity.h"
#include "bus/runtime/state_journal.h"
#include "bus/sending/lateness_watch.h"
#include "bus/subscription.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::bus {

// The instant of a step: simulation time, and the process' steady time (since its start, never set back).
struct Now {
  SimTime sim;
  SimTime steady;
  bool sim_known = true;  // false until the process has learnt the simulation time; sim is 0 then
  // The simulation time by the process' source. Later than `sim` while the node catches up: others may be
  // there already.
  SimTime clock = SimTime::at_once();
  SimTime latest() const { return std::max(sim, clock); }
};

// When a node is next to be stepped: at the earlier of the two. SimTime::at_once() while work is waiting that
// does not depend on simulation time (answering a query). A node that is due at a steady time is stepped then
// also before simulation time is known (Now::sim_known).
struct Due {
  SimTime sim = SimTime::never();
  SimTime steady = SimTime::never();
};

class Node {
 public:
  using ChannelTest = std::function<bool(std::string_view channel)>;

  // Subscriptions are made by the derived constructors; nothing is published before the first step.
  Node(lcm::LCM& lcm, NodeIdentity identity) : bus_(lcm, std::move(identity)) {}
  virtual ~Node() = default;
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  const std::string& name() const { return bus_.identity().name; }
  const BusCounters& counters() const { return bus_.counters(); }

  // For a node on a bus that loses datagrams, once, before its first step (Bus::enable_repair).
  void enable_repair() { bus_.enable_repair(); }
  bool has_repair() const { return bus_.flow_repair() != nullptr; }
  // Keeps its state in `journal` from now on, and first takes up what an earlier incarnation left there: it
  // goes on from that state, with its numbers. Once, after enable_repair(), before anything is received; of a
  // node that was made with the session in the journal. Throws InvalidArgument when the state is another
  // node's.
  //
  // What a step publishes goes out once the state that follows from it is on disk (output commit: Elnozahy,
  // Alvisi, Wang and Johnson 2002, "A survey of rollback-recovery protocols in message-passing systems",
  // section 2.4). So the next incarnation contradicts nothing that was received of this one; what this one
  // received since its last step is lost, as if it had been killed before.
  void keep_state_in(std::unique_ptr<StateJournal> journal);
  // Messages handled from now on were received at this steady time. `is_behind`: more are waiting than were
  // handled, so that it requests no repairs, which would come on top.
  void set_steady(SimTime steady, bool is_behind = false) {
    bus_.set_steady(steady);
    is_behind_ = is_behind;
  }
  // Results that go out more than `limit` after their instant, by this clock, are late.
  void set_clock(LatenessWatch::Clock clock, SimDuration limit) {
    bus_.lateness().set_clock(std::move(clock), limit);
  }
  // Test for messages that are missing and may still be repaired.
  bool misses_messages() const { return bus_.num_missing() > 0; }
  // True of a node whose results depend on all that others have published up to their instant: after a halt
  // of its process it goes on once what it missed has been repaired.
  virtual bool waits_for_repair() const { return false; }
  // So many CLOCKs of a second conductor, and leaps of the first without a witness, were refused since the
  // last call.
  void count_refused_clocks(std::int64_t count);
  Stage stage() const { return bus_.identity().stage; }
  // Its subscriptions, what it receives by them, and the destination of its messages, for a runner that
  // delivers in LCM's place (bus.h).
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
  // When it is due in lockstep, where steady time is simulation time.
  SimTime lockstep_due() const;
  // In lockstep: it publishes nothing before this on channels for which `matters`, unless it receives
  // something of others than services (lockstep_schedule.h); later than when it is due where it steps without
  // publishing on them.
  SimTime quiet_until(const ChannelTest& matters) const;
  // due() keeps what it was until a message that may advance it, or a call of the runner; this says that
  // something else has changed it.
  void note_due_changed() { known_due_.reset(); }
  // A file descriptor that is readable when the node has something to do besides messages and its due time;
  // -1: none. A runner in real time watches it and calls note_due_changed().
  virtual int ready_file() const { return -1; }
  // Rethrows what a handler threw; computes and publishes all that is due; then STATUS when a second has
  // passed.
  void step(const Now& now);
  // Another run has begun at `now`.
  void restart(const Now& now);
  // The last step: publishes what remains, then a final STATUS.
  void stop(const Now& now);
  // After stop(), on a bus that loses datagrams: announces the last number of each flow where `announces`,
  // answers who misses any, and requests what it misses itself. Returns whether somebody requested anything
  // since the last call.
  bool repair_after_stop(const Now& now, bool announces);
  // Whether it misses something that it may not end without.
  virtual bool wants_repair() const { return false; }

 protected:
  virtual Due on_due() const = 0;
  // As quiet_until(), but for STATUS; a channel of a family is tested by any of its names. at_once(): when it
  // is due.
  virtual SimTime on_quiet_until(const ChannelTest& /*matters*/) const { return SimTime::at_once(); }
  virtual void on_step(const Now& now) = 0;
  virtual void on_stop(const Now& /*now*/) {}
  // Simulation time jumped back: another run has begun. Discard what was received of the old one.
  virtual void on_restart(const Now& /*now*/) {}
  // What the next incarnation needs in order to go on from here, saved and loaded. After loading the first
  // step may be any time later.
  virtual void on_archive(Archive& /*a*/) {}
  // True where a step that published nothing has changed what the journal is to hold before on_committed().
  virtual bool on_wants_commit() { return false; }
  // After a step: what follows from it is on disk. For what a node sends by other ways than the bus.
  virtual void on_committed() {}
  // One line for a person, for STATUS.
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
  mutable std::optional<Due> known_due_;  // on_due(), until that may have changed
  mutable std::int64_t wakeups_at_due_ = 0;
  SimTime next_status_, next_lateness_report_;  // steady
  std::int64_t status_sequence_ = 0;
  bool is_behind_ = false;
  std::int64_t requests_seen_ = 0;  // by repair_after_stop()
  std::unique_ptr<StateJournal> journal_;
  bool has_journal_ = true;              // the disk takes it
  Archive saved_;                        // what went to the journal last
  std::uint64_t published_saved_ = 0;    // messages whose flows are in the journal (FlowHistory::published)
  std::optional<SimTime> resumed_from_;  // until the first step
};

}  // namespace halocline::bus
