// SPDX-License-Identifier: BSD-3-Clause
// A conductor and participants on a simulated network, with fault injection from a seed: datagrams are lost,
// duplicated, delayed and reordered; participants and the conductor crash in the middle of their work and are
// restarted.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <queue>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "bus/lockstep/journal.h"
#include "bus/lockstep/lockstep_conductor.h"
#include "bus/lockstep/lockstep_participant.h"
#include "bus/runtime/lockstep_turns.h"
#include "bus/runtime/node.h"
#include "core/sim_time.h"

namespace halocline::conductor::testing {

// Messages of a run, for comparison: "instant channel bytes".
using Messages = std::vector<std::string>;
std::string text_of(const lockstep_message_t& message);

// One of the nodes that take part: a name, its stage and its period.
struct NodeRule {
  enum class Kind { kChatty, kService, kSharing, kLiar };
  std::string name;
  bus::Stage stage;
  SimDuration period;
  Kind kind = Kind::kChatty;
};
std::vector<NodeRule> five_nodes();
// Three servers that share lookahead and ask a service, among others.
std::vector<NodeRule> sharing_nodes();
std::unique_ptr<bus::Node> make_node(lcm::LCM& lcm, const std::vector<NodeRule>& nodes, std::size_t index);

// The messages of all nodes in one process, by bus::LockstepRunner.
Messages messages_of_one_process(const std::vector<NodeRule>& nodes, SimTime end);

struct NetworkRules {
  double loss = 0, duplication = 0;
  SimDuration longest_delay = SimDuration::from_microseconds(100);
  double participant_crashes_per_s = 0, conductor_crashes_per_s = 0;  // of steady time, all together
  SimDuration drop_after = SimDuration();
  bool lookahead = true;
  std::size_t local = 0;  // the first so many nodes run in the conductor's process
  // The last participant crashes after this many turns and never returns; -1: it does not.
  int crashes_for_good_after = -1;
  // The conductor crashes once, at its output of this number (grants, and before and after each journal
  // entry), from 0; -1: it does not.
  int conductor_crashes_at = -1;
};

class SimulatedLockstep {
 public:
  SimulatedLockstep(std::vector<NodeRule> nodes, SimTime end, const NetworkRules& rules, unsigned seed);
  ~SimulatedLockstep();

  // Until the run is over and all participants know it; throws std::runtime_error after `limit` of steady
  // time.
  void run(SimDuration limit = SimDuration::from_seconds(600));

  const Messages& messages() const { return messages_; }
  const std::vector<std::string>& reports() const { return reports_; }
  LockstepConductor& conductor() { return *conductor_; }
  int crashes() const { return crashes_; }
  std::int64_t datagrams() const { return datagrams_; }
  SimTime steady() const { return now_; }

  // Called between two events.
  std::function<void(SimulatedLockstep&)> between_events = [](SimulatedLockstep&) {};
  void start_participant(std::size_t index);
  void crash_participant(std::size_t index);
  bus::LockstepParticipant* participant(std::size_t index);

 private:
  struct Process {
    lcm::LCM memq{"memq://"};
    std::unique_ptr<bus::Node> node;
    std::unique_ptr<bus::LockstepTurns> turns;
    std::unique_ptr<bus::LockstepParticipant> participant;
  };
  struct Event {
    SimTime when;
    std::int64_t number;
    std::function<void()> what;
    bool operator<(const Event& other) const {
      return std::tie(other.when, other.number) < std::tie(when, number);
    }
  };
  struct Crashed {};

  void start_conductor();
  void crash_conductor();
  void maybe_crash();
  void send(std::function<void()> delivery);
  void later(SimDuration delay, std::function<void()> what);
  void to_conductor(const std::function<void(LockstepConductor&)>& deliver);
  void turn_timers();
  double draw() { return std::uniform_real_distribution<double>(0, 1)(random_); }

  std::vector<NodeRule> nodes_;
  SimTime end_;
  NetworkRules rules_;
  std::mt19937 random_;
  std::vector<std::unique_ptr<Process>> processes_, local_;
  std::unique_ptr<LockstepConductor> conductor_;
  std::vector<JournalEntry> journal_;
  Messages messages_;
  std::vector<std::string> reports_;
  std::priority_queue<Event> events_;
  std::int64_t events_made_ = 0, datagrams_ = 0, next_incarnation_ = 1000;
  SimTime now_;
  int crashes_ = 0, conductor_outputs_ = 0;
  bool may_crash_ = false;  // the conductor has started
};

}  // namespace halocline::conductor::testing
