// A conductor and participants on a network that is simulated: datagrams are lost, doubled, delayed and overtaken,
// participants and the conductor die in the middle of what they do and are started again. All by a seed.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <queue>
#include <random>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "bus/lockstep/lockstep_conductor.h"
#include "bus/lockstep/lockstep_participant.h"
#include "bus/runtime/lockstep_turns.h"
#include "tests/bus/lockstep/chatty_node.h"

namespace halocline::conductor::testing {

// What a message of the run was, for comparison: "instant channel bytes".
using Said = std::vector<std::string>;
std::string text_of(const lockstep_message_t& message);

// One of the nodes that take part: a name, its stage and its period.
struct Cast {
  std::string name;
  bus::Stage stage;
  SimDuration period;
};
std::vector<Cast> five_nodes();
std::unique_ptr<ChattyNode> make_node(lcm::LCM& lcm, const std::vector<Cast>& cast, std::size_t index);

// What all nodes say in one process on memq, by bus::LockstepRunner.
Said said_in_one_process(const std::vector<Cast>& cast, SimTime end);

struct NetworkRules {
  double loss = 0, doubling = 0;
  SimDuration longest_delay = SimDuration::from_microseconds(100);
  double participant_deaths_per_s = 0, conductor_deaths_per_s = 0;  // of steady time, all together
  SimDuration drop_after = SimDuration();
  bool windows = true;
  std::size_t local = 0;  // how many of the cast live in the conductor's process
  // A participant that never answers after this many turns and never returns; -1: none.
  int dies_for_good_after = -1;
};

class SimulatedLockstep {
 public:
  SimulatedLockstep(std::vector<Cast> cast, SimTime end, const NetworkRules& rules, unsigned seed);
  ~SimulatedLockstep();

  // Until the run is over and all have heard it; throws std::runtime_error after `patience` of steady time.
  void run(SimDuration patience = SimDuration::from_seconds(600));

  const Said& said() const { return said_; }
  const std::vector<std::string>& reports() const { return reports_; }
  LockstepConductor& conductor() { return *conductor_; }
  int deaths() const { return deaths_; }
  std::int64_t datagrams() const { return datagrams_; }
  SimTime steady() const { return now_; }

  // Called between two events.
  std::function<void(SimulatedLockstep&)> between_events = [](SimulatedLockstep&) {};
  void start_participant(std::size_t index);
  void kill_participant(std::size_t index);
  bus::LockstepParticipant* participant(std::size_t index);

 private:
  struct Process {
    lcm::LCM memq{"memq://"};
    std::unique_ptr<ChattyNode> node;
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
  struct Died {};

  void start_conductor();
  void kill_conductor();
  void maybe_die();
  void send(std::function<void()> delivery);
  void later(SimDuration delay, std::function<void()> what);
  void to_conductor(const std::function<void(LockstepConductor&)>& tell);
  void turn_timers();
  double draw() { return std::uniform_real_distribution<double>(0, 1)(random_); }

  std::vector<Cast> cast_;
  SimTime end_;
  NetworkRules rules_;
  std::mt19937 random_;
  std::vector<std::unique_ptr<Process>> processes_, local_;
  std::unique_ptr<LockstepConductor> conductor_;
  std::vector<JournalEntry> journal_;
  Said said_;
  std::vector<std::string> reports_;
  std::priority_queue<Event> events_;
  std::int64_t events_made_ = 0, datagrams_ = 0, next_life_ = 1000;
  SimTime now_;
  int deaths_ = 0;
  double conductor_death_ = 0;  // probability at each thing it says
};

}  // namespace halocline::conductor::testing
