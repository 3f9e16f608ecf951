// SPDX-License-Identifier: BSD-3-Clause
// Small nodes for the tests of those that run them.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bus/runtime/node.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::bus::testing {

// Steps on the grid of a period, and notes it in a journal shared with others. Publishes a CLOCK at each
// step.
class TickingNode : public Node {
 public:
  TickingNode(lcm::LCM& lcm, const std::string& name, SimDuration period, std::vector<std::string>& journal)
      : Node(lcm, {name, 1}), period_(period), journal_(journal) {}

  std::function<void()> at_step = [] {};
  int restarts = 0;

 protected:
  Due on_due() const override { return {.sim = next_}; }
  void on_step(const Now& now) override {
    if (now.sim < next_) return;
    journal_.push_back(name() + "@" + std::to_string(now.sim.to_utime()));
    sim_clock_t clock;
    clock.utime = now.sim.to_utime();
    clock.session = 1;
    clock.sequence = sequence_++;
    clock.clock_rate = 1;
    clock.clock_step_us = period_.nanoseconds() / 1000;
    clock.lockstep = 1;
    bus().publish("TICK." + name(), clock);
    next_ = next_on_grid(now.sim, period_);
    at_step();
  }
  void on_stop(const Now&) override { journal_.push_back(name() + " stopped"); }
  void on_restart(const Now& now) override {
    ++restarts;
    next_ = now.sim;
  }
  void on_archive(Archive& a) override { a(next_, sequence_); }
  std::string status_text() const override { return "ticking"; }

 private:
  SimDuration period_;
  std::vector<std::string>& journal_;
  SimTime next_;
  std::int64_t sequence_ = 0;
};

// Answers each message of a channel at once, as a service does, with the utime that it received.
class EchoNode : public Node {
 public:
  EchoNode(lcm::LCM& lcm, const std::string& name, const std::string& received, const std::string& answered,
           std::int64_t session = 2)
      : Node(lcm, {name, session}), answered_(answered) {
    bus().subscribe<sim_clock_t>(received, [this](const sim_clock_t& m) { waiting_.push_back(m); });
  }
  int answers = 0;

 protected:
  Due on_due() const override { return {.sim = waiting_.empty() ? SimTime::never() : SimTime::at_once()}; }
  void on_step(const Now&) override {
    for (const sim_clock_t& message : waiting_) {
      bus().publish(answered_, message);
      ++answers;
    }
    waiting_.clear();
  }
  std::string status_text() const override { return "echo"; }

 private:
  std::string answered_;
  std::vector<sim_clock_t> waiting_;
};

}  // namespace halocline::bus::testing
