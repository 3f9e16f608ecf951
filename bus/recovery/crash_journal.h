// SPDX-License-Identifier: BSD-3-Clause
// Crash recovery of a node by replay: a restarted node replays its recent inputs, and publishes each output
// once over all its incarnations together. For a node whose state follows from recent inputs; a node whose
// state does not, and can be saved completely, uses a StateJournal (state_journal.h).
//
// A state machine gives the same outputs again for the same inputs, taken in the same steps (Schneider 1990).
// Outputs found in the journal are not published again. Inputs and outputs are written before anything that
// depends on them is published (message_journal.h). For a bus that repairs losses, not for lockstep, where
// the conductor replays.
//
//   CrashJournal journal(bus(), publisher);  // does nothing until it is open: publish_once() publishes
//   journal.open(rule);                      // when the node is made, before anything is dispatched
//   journal.replay_inputs([&](SimTime at) { history.push_back({at, take_inbox()}); });
//
// In the first step whose simulation time is known, and no other step until kRepairTime has passed (inputs
// published meanwhile arrive by repair):
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
#include "bus/messages/channel_family.h"
#include "bus/numbered_publisher.h"
#include "bus/recovery/message_journal.h"
#include "core/sim_time.h"

namespace halocline::bus {

// A time further before the end of the journal than this belongs to another run.
inline constexpr SimDuration kSameRun = SimDuration::from_milliseconds(10'000);

class CrashJournal {
 public:
  struct Rule {
    std::string path;
    // Span of inputs and outputs that is kept; above 0. After a longer absence nothing is resumed.
    SimDuration kept;
    std::function<bool(std::string_view channel)> is_input;  // selects the received messages to keep
    // Families of inputs of which the last message of each flow is kept for ever. Messages published while
    // the node is down are then known to be missing.
    std::vector<Family> keep_last;
    std::vector<std::string> keep_all;  // channels of which all inputs are kept (the latest 1000)
    std::uint64_t digest = 0;           // covers everything that the steps depend on, except their inputs
  };
  // Steady time, from the first step, within which repair delivers the messages published while the node was
  // down. Heartbeats come four times a second, the second one lists the flows that began meanwhile, and the
  // messages arrive within two requests.
  static constexpr SimDuration kRepairTime = SimDuration::from_milliseconds(600);

  CrashJournal(Bus& bus, NumberedPublisher& publisher) : bus_(bus), publisher_(publisher) {}

  // Call once. Throws InvalidArgument when the file cannot be written.
  void open(Rule rule);
  bool is_open() const { return journal_ != nullptr; }

  // ---- recovery
  // Time of the earlier incarnation's last step; nothing if there was none.
  std::optional<SimTime> last_step() const { return last_step_; }
  // Passes the inputs to the node's own handlers, oldest first, and calls `end_step` after those of each
  // step; some steps have no inputs. Call once, before anything else is dispatched: later messages of the
  // same flows are then known to be missing, and are repaired.
  void replay_inputs(const std::function<void(SimTime at)>& end_step);
  // Restores the outputs: they are not published again, their channels continue their numbering, and they are
  // available for repair. Returns false when the journal belongs to another run or is too old; it is empty
  // then.
  [[nodiscard]] bool resume(SimTime now);
  // The following outputs belong to this step, which is repeated.
  void redo_step(SimTime at) { step_ = at; }
  void end_recovery() { recovers_ = false; }
  bool is_recovering() const { return recovers_; }

  // ---- each step
  // Writes the messages received since the last step.
  void write_inputs(SimTime now);
  // True when an earlier incarnation published the output, or this one did during recovery.
  bool was_published(const std::string& channel, const std::string& identity) const {
    return published_.contains({channel, identity});
  }
  // Publishes with the channel's next number, unless an earlier incarnation has published the output, or this
  // one has between resume() and end_recovery(). `identity` distinguishes the output from all others on its
  // channel, and is the same in each incarnation that computes it. Returns true if it was published.
  template <class Message>
  bool publish_once(const std::string& channel, Message message, const std::string& identity) {
    if (!claim(channel, identity)) return false;
    publish_again(channel, std::move(message), identity);
    return true;
  }
  // Publishes even if the output was published before: the answer to a repeated request.
  template <class Message>
  void publish_again(const std::string& channel, Message message, const std::string& identity) {
    publisher_.number(channel, message);
    write_output(channel, identity, message.session, message.sequence, message);
    bus_.publish(channel, message);
  }

  // Another run has begun: discards everything except the messages received since the last step.
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
  std::vector<JournalledMessage> history_;  // from the journal: inputs, and outputs without their bytes
  std::vector<JournalledMessage> outputs_;  // from the journal
  std::optional<SimTime> last_step_;
  // (channel, identity) of outputs that might be published twice.
  std::set<std::pair<std::string, std::string>> published_;
  SimTime published_forgotten_at_ = SimTime::never();
  SimTime step_;
  bool replays_ = false, recovers_ = false, abandoned_ = false;
};

}  // namespace halocline::bus
