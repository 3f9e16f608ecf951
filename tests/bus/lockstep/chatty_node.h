// A node whose every word depends on every word it has heard and on their order: one message missed, doubled, late
// or out of order changes all that it says afterwards, and when it says it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bus/runtime/node.h"

namespace halocline::conductor::testing {

class ChattyNode : public bus::Node {
 public:
  // Hears what others say (SAY.<other>, stored), and what is asked of it (ASK.<name>, answered at the same
  // instant). Now and then asks `neighbour`.
  ChattyNode(lcm::LCM& lcm, const std::string& name, bus::Stage stage, SimDuration period,
             const std::vector<std::string>& others, std::string neighbour)
      : Node(lcm, {name, 1, stage}), period_(period), neighbour_(std::move(neighbour)) {
    for (const std::string& other : others) {
      bus().subscribe<sim_clock_t>(
          "SAY." + other, [this](const sim_clock_t& m) { fold(m.clock_step_us); }, bus::Wakeup::kStoreOnly);
    }
    bus().subscribe<sim_clock_t>("ASK." + name, [this](const sim_clock_t& m) {
      fold(m.clock_step_us);
      ++asked_;
    });
  }

 protected:
  bus::Due on_due() const override { return {.sim = asked_ > 0 ? SimTime::at_once() : next_}; }
  void on_step(const bus::Now& now) override {
    for (; asked_ > 0; --asked_) say("SAY." + name(), now.sim);
    if (now.sim < next_) return;
    say("SAY." + name(), now.sim);
    if (heard_ % 3 == 0) say("ASK." + neighbour_, now.sim);
    // The period wanders with what was heard, on a grid, so that several are due at one instant.
    next_ = next_on_grid(now.sim + period_ * static_cast<std::int64_t>(heard_ % 4), period_);
  }
  std::string status_text() const override { return std::to_string(heard_); }

 private:
  void fold(std::int64_t number) { heard_ = (heard_ ^ static_cast<std::uint64_t>(number)) * 0x100000001b3u; }
  void say(const std::string& channel, SimTime now) {
    sim_clock_t message{};
    message.utime = now.to_utime();
    message.clock_rate = 1;
    message.clock_step_us = 1 + static_cast<std::int64_t>(heard_ % 3'000'000'000u);
    bus().publish(channel, message);
    fold(message.utime + 1);
  }

  SimDuration period_;
  std::string neighbour_;
  SimTime next_;
  std::uint64_t heard_ = 0x1234567;
  int asked_ = 0;
};

}  // namespace halocline::conductor::testing
