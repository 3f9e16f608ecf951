// SPDX-License-Identifier: BSD-3-Clause
// Lets a node that was killed go on where it was: replays its recent inputs, and publishes each output once
// in all its incarnations together. For a node whose state follows from recent inputs; one whose state does
// not, and can be written whole, has a StateJournal (state_journal.h).
//
// The inputs of a state machine, and the steps that took them, give the same outputs again (Schneider 1990),
// of which those that the journal holds are not published again.
// Inputs and outputs are written before anything that follows from them is published (message_journal.h). For
// a bus that repairs losses, not for lockstep, where the conductor replays.
//
//   CrashJournal journal(bus(), publisher);  // does nothing until it is open: publish_once() publishes
//   journal.open(rule);                      // when the node is made, before anything is dispatched
//   journal.replay_inputs([&](SimTime at) { history.push_back({at, take_inbox()}); });
//
// In the first step whose simulation time is known, and nothing more until kRepairTime has passed (inputs
// published meanwhile come by repair):
//
//   if (!history.empty() && !journal.resume(now.sim)) forget_all();  // it belongs to another run
//   for (const auto& [at, inbox] : history) {
//     journal.redo_step(at);
//     run_to(at, inbox);
//   }
//
// In each later step; clear() when another run begins:
//
//   journal.write_inputs(now.sim);  // before the node acts on them
//   ...
//   journal.end_recovery();         // the first time: the present is reached
//   journal.publish_once(channels::kState.of(name), state, std::to_string(state.utime));
//
// The Bus and the NumberedPublisher must outlive it. Not thread-safe.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bus/bus.h"
#include "bus/numbered_publisher.h"
#include "bus/runtime/message_journal.h"
#include "core/sim_time.h"

namespace halocline::bus {

// A time further before the journal's end than this belongs to another run.
inline constexpr SimDuration kSameRun = SimDuration::from_milliseconds(10'000);

class CrashJournal {
 public:
  struct Rule {
    std::string path;
    // How far back inputs and outputs reach; above 0. After a longer absence nothing is resumed.
    SimDuration kept;
    std::function<bool(std::string_view channel)> is_input;  // selects what is kept of what is received
    // Inputs of which the last of each flow is kept for ever: what begins while the node is away is then
    // known to be missing.
    std::vector<Family> keep_last;
    std::vector<std::string> keep_all;  // channels whose inputs are all kept (the latest 1000)
    std::uint64_t digest = 0;           // of all that the steps depend on, beside their inputs
  };
  // Steady time, from the first step, within which repair brings what was published while the node was away:
  // heartbeats come four times a second, the second tells of flows that began meanwhile, the messages come
  // within two requests.
  static constexpr SimDuration kRepairTime = SimDuration::from_milliseconds(600);

  CrashJournal(Bus& bus, NumberedPublisher& publisher) : bus_(bus), publisher_(publisher) {}

  // Once. Throws InvalidArgument when the file cannot be written.
  void open(Rule rule);
  bool is_open() const { return journal_ != nullptr; }

  // ---- recovery
  // The earlier incarnation's last step; empty without one.
  std::optional<SimTime> last_step() const { return last_step_; }
  // Hands the inputs to the node's own handlers, oldest first, and calls `end_step` after those of each step,
  // some of which took none. Once, before anything else is dispatched: what follows an input in its flow is
  // then known to be missing, and is repaired.
  void replay_inputs(const std::function<void(SimTime at)>& end_step);
  // Takes up the outputs: they are not published again, their channels' numbers go on, and they are kept for
  // repair. False when the journal belongs to another run, or is too old, and is empty now.
  [[nodiscard]] bool resume(SimTime now);
  // The outputs that follow belong to this step, which is done again.
  void redo_step(SimTime at) { step_ = at; }
  void end_recovery() { recovers_ = false; }
  bool is_recovering() const { return recovers_; }

  // ---- each step
  // Writes what was received since the last one.
  void write_inputs(SimTime now);
  // Whether an earlier incarnation published it, or this one while it recovers.
  bool was_published(const std::string& channel, const std::string& identity) const {
    return published_.contains({channel, identity});
  }
  // Publishes with the channel's next number, unless an earlier incarnation has published it, or this one
  // between resume() and end_recovery(). `identity` tells the output from all others on its channel,
  // whichever incarnation computes it. Returns whether it was published.
  template <class Message>
  bool publish_once(const std::string& channel, Message message, const std::string& identity) {
    if (!claim(channel, identity)) return false;
    publish_again(channel, std::move(message), identity);
    return true;
  }
  // The same, whether or not it was published before: an answer to who repeats a request.
  template <class Message>
  void publish_again(const std::string& channel, Message message, const std::string& identity) {
    publisher_.number(channel, message);
    write_output(channel, identity, message.session, message.sequence, message);
    bus_.publish(channel, message);
  }

  // Another run has begun: forgets everything but what was received since the last step.
  void clear();

 private:
  struct Output {
    std::string channel, identity;
    std::int64_t session = 0, sequence = 0;
    Bytes message;
  };
  static Bytes to_bytes(const Output& output);
  [[nodiscard]] static std::optional<Output> to_output(const JournalledMessage& entry);
  [[nodiscard]] bool claim(const std::string& channel, const std::string& identity);
  void restore(Output output);
  template <class Message>
  void write_output(const std::string& channel, const std::string& identity, std::int64_t session,
                    std::int64_t sequence, const Message& message) {
    if (is_open())
      journal_->write_output(step_, channel,
                             to_bytes({channel, identity, session, sequence, encoded(message)}));
  }

  Bus& bus_;
  NumberedPublisher& publisher_;
  SimDuration kept_;
  std::unique_ptr<MessageJournal> journal_;
  std::vector<JournalledMessage> history_;  // inherited: inputs, and outputs without their bytes
  std::vector<JournalledMessage> outputs_;  // inherited
  std::optional<SimTime> last_step_;
  std::set<std::pair<std::string, std::string>>
      published_;  // (channel, identity), while repetition threatens
  SimTime published_forgotten_at_ = SimTime::never();
  SimTime step_;
  bool replays_ = false, recovers_ = false, given_up_ = false;
};

}  // namespace halocline::bus
