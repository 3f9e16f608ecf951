// SPDX-License-Identifier: BSD-3-Clause
// Lockstep steps per second: a conductor and N participants, each a process of its own, over udpm on
// loopback.
//
// All participants are due at every step and publish one vehicle state each, which the conductor puts in
// order; none subscribes to another (a received message costs its bytes in the grant). The first argument is
// N, the second the share of datagrams that each participant and the conductor drop, in percent.
// scripts/bench provides a private bus.
#include <csignal>
#include <cstdint>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bus/lockstep/journal.h"
#include "bus/lockstep/lockstep_conductor.h"
#include "bus/lockstep/lockstep_participant.h"
#include "bus/messages/channels.h"
#include "bus/runtime/lockstep_process.h"
#include "bus/runtime/lockstep_turns.h"
#include "bus/runtime/node.h"
#include "bus/runtime/node_process.h"
#include "bus/transport/transport.h"
#include "core/sim_time.h"

namespace halocline {
namespace {

constexpr SimDuration kStep = SimDuration::from_milliseconds(1);

class Mover : public bus::Node {
 public:
  Mover(lcm::LCM& lcm, const std::string& name) : Node(lcm, {name, 1, bus::Stage::kVehicles}) {}

 protected:
  bus::Due on_due() const override { return {.sim = next_}; }
  void on_step(const bus::Now& now) override {
    vehicle_state_t state{};
    state.utime = now.sim.to_utime();
    state.vehicle_id = 1;
    state.orientation_wxyz[0] = 1;
    bus().publish(bus::channels::kState.of(name()), state);
    next_ = now.sim + kStep;
  }
  std::string status_text() const override { return ""; }

 private:
  SimTime next_;
};

// Drops a share of the datagrams.
class LossyLink {
 public:
  LossyLink(double loss, unsigned seed) : loss_(loss), random_(seed) {}
  bool carries() { return loss_ == 0 || std::uniform_real_distribution<double>(0, 1)(random_) >= loss_; }

 private:
  double loss_;
  std::mt19937 random_;
};

[[noreturn]] void run_participant(const std::string& name, double loss, unsigned seed) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  lcm::LCM memq("memq://");
  Mover mover(memq, name);
  bus::LockstepTurns turns(mover);
  lockstep_join_t join = turns.introduction();
  join.incarnation = bus::draw_incarnation() * 1000 + seed;
  const std::string url(bus::kDefaultSyncUrl);
  const auto grants_lcm = bus::open_transport(url), answers_lcm = bus::open_transport(bus::next_port(url));
  bus::Bus receiver(*grants_lcm, {name, 0}), publisher(*answers_lcm, {name, 0});
  LossyLink link(loss, seed);
  bus::LockstepParticipant participant(
      join, [&](const lockstep_turn_t& turn) { return turns.take(turn); },
      {[&](const lockstep_join_t& m) { publisher.publish(bus::channels::kLockstepJoin, m); },
       [&](const lockstep_answer_t& m) {
         if (link.carries()) publisher.publish(bus::channels::kLockstepAnswer, m);
       }});
  const auto on_grant = [&](const lockstep_grant_t& m) {
    if (link.carries()) participant.on_grant(m, bus::steady_now());
  };
  receiver.subscribe<lockstep_grant_t>(bus::channels::kLockstepGrant, on_grant);
  receiver.subscribe<lockstep_grant_t>(std::string(bus::channels::kLockstepGrant) + "." + name, on_grant);
  for (;;) {
    participant.on_timer(bus::steady_now());
    bus::wait_and_dispatch(*grants_lcm, participant.next_timer());
  }
}

class SyntheticFleet {
 public:
  SyntheticFleet(int count, double loss) {
    for (int i = 0; i < count; ++i) {
      const std::string name = "mover-" + std::to_string(i);
      names.insert(name);
      const pid_t pid = fork();
      if (pid == 0) run_participant(name, loss, static_cast<unsigned>(i) + 1);
      pids_.push_back(pid);
    }
  }
  ~SyntheticFleet() {
    for (const pid_t pid : pids_) kill(pid, SIGKILL);
    for (const pid_t pid : pids_) waitpid(pid, nullptr, 0);
  }
  std::set<std::string> names;

 private:
  std::vector<pid_t> pids_;
};

void lockstep_steps(benchmark::State& bench) {
  const int count = static_cast<int>(bench.range(0));
  const double loss = static_cast<double>(bench.range(1)) / 100;
  const SyntheticFleet fleet(count, loss);
  const std::string url(bus::kDefaultSyncUrl);
  const auto grants_lcm = bus::open_transport(url), answers_lcm = bus::open_transport(bus::next_port(url));
  bus::Bus publisher(*grants_lcm, {"conductor", 0}), receiver(*answers_lcm, {"conductor", 0});
  std::int64_t published = 0;
  conductor::LockstepConductor conductor(
      {.expected = fleet.names, .end = SimTime::from_seconds(1e6)}, bus::draw_incarnation(),
      {[&](const std::string& channel, const lockstep_grant_t& m) { publisher.publish(channel, m); },
       [&](const lockstep_notice_t& m) { publisher.publish(bus::channels::kLockstepNotice, m); },
       [](const conductor::JournalEntry&) {}, [&](const lockstep_message_t&) { ++published; },
       [](const std::string&, const std::string&) {}});
  receiver.subscribe<lockstep_join_t>(bus::channels::kLockstepJoin, [&](const lockstep_join_t& m) {
    conductor.on_join(m, bus::steady_now());
  });
  receiver.subscribe<lockstep_answer_t>(bus::channels::kLockstepAnswer, [&](const lockstep_answer_t& m) {
    conductor.on_answer(m, bus::steady_now());
  });
  conductor.start();
  const auto step_to = [&](std::int64_t rounds) {
    while (conductor.sequencer().rounds() < rounds) {
      conductor.on_timer(bus::steady_now());
      bus::wait_and_dispatch(*answers_lcm, conductor.next_timer());
    }
  };
  step_to(200);  // all have joined, and the timers have samples
  for (auto _ : bench) step_to(conductor.sequencer().rounds() + 1);
  const auto rounds = static_cast<double>(bench.iterations());
  bench.counters["steps"] = benchmark::Counter(rounds, benchmark::Counter::kIsRate);
  bench.counters["retransmitted"] =
      static_cast<double>(conductor.retransmissions()) / static_cast<double>(conductor.sequencer().turns());
}
BENCHMARK(lockstep_steps)
    ->ArgsProduct({{2, 8, 32, 64}, {0, 1, 10}})
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace halocline
