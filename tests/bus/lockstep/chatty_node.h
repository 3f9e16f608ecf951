// SPDX-License-Identifier: BSD-3-Clause
// A node whose every message depends on all it has received and on their order: one message lost, duplicated,
// late or reordered changes all that it publishes afterwards, and when.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "bus/runtime/node.h"
#include "bus/transport/subscription.h"
#include "core/sim_time.h"

namespace halocline::conductor::testing {

class ChattyNode : public bus::Node {
 public:
  // Subscribes to the news and events of others (NEWS.<other>, EVENT.<other>, stored), and to requests
  // (REQUEST.<name>, answered at the same instant). Now and then sends a request to `neighbour`.
  ChattyNode(lcm::LCM& lcm, const std::string& name, bus::Stage stage, SimDuration period,
             const std::vector<std::string>& others, std::string neighbour)
      : Node(lcm, {name, 1, stage}), period_(period), neighbour_(std::move(neighbour)) {
    for (const std::string& other : others) {
      for (const std::string family : {"NEWS.", "EVENT."}) {
        bus().subscribe<sim_clock_t>(
            family + other, [this](const sim_clock_t& m) { fold(m.clock_step_us); }, bus::Wakeup::kStoreOnly);
      }
    }
    bus().subscribe<sim_clock_t>("REQUEST." + name, [this](const sim_clock_t& m) {
      fold(m.clock_step_us);
      ++requests_;
    });
  }

 protected:
  bus::Due on_due() const override { return {.sim = requests_ > 0 ? SimTime::at_once() : next_}; }
  void on_step(const bus::Now& now) override {
    for (; requests_ > 0; --requests_) send("NEWS." + name(), now.sim);
    if (now.sim < next_) return;
    send("NEWS." + name(), now.sim);
    if (state_ % 3 == 0) send("REQUEST." + neighbour_, now.sim);
    // The period varies with the messages received, on a grid, so that several are due at one instant.
    next_ = next_on_grid(now.sim + period_ * static_cast<std::int64_t>(state_ % 4), period_);
  }
  std::string status_text() const override { return std::to_string(state_); }

 private:
  void fold(std::int64_t number) { state_ = (state_ ^ static_cast<std::uint64_t>(number)) * 0x100000001b3u; }
  void send(const std::string& channel, SimTime now) {
    sim_clock_t message{};
    message.utime = now.to_utime();
    message.clock_rate = 1;
    message.clock_step_us = 1 + static_cast<std::int64_t>(state_ % 3'000'000'000u);
    bus().publish(channel, message);
    fold(message.utime + 1);
  }

  SimDuration period_;
  std::string neighbour_;
  SimTime next_;
  std::uint64_t state_ = 0x1234567;
  int requests_ = 0;
};

}  // namespace halocline::conductor::testing
