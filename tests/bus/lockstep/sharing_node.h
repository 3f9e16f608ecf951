// SPDX-License-Identifier: BSD-3-Clause
// Nodes whose stage shares lookahead, as channel servers do: each acts at instants of its own, asks a service
// now and then, and tells the others at ticks alone. All that it publishes depends on all that it has
// received, and on the order.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bus/runtime/node.h"
#include "bus/transport/subscription.h"
#include "core/sim_time.h"

namespace halocline::conductor::testing {

class NumberNode : public bus::Node {
 public:
  using Node::Node;

 protected:
  std::string status_text() const override { return std::to_string(state_); }
  std::uint64_t state() const { return state_; }
  void fold(std::uint64_t number) { state_ = (state_ ^ number) * 0x100000001b3u; }
  void send(const std::string& channel, SimTime now) {
    sim_clock_t message{};
    message.utime = now.to_utime();
    message.clock_rate = 1;
    message.clock_step_us = 1 + static_cast<std::int64_t>((state_ >> 8) % 3'000'000'000u);
    bus().publish(channel, message);
    fold(static_cast<std::uint64_t>(message.utime) + 1);
  }
  void receive(const std::string& channel, bus::Wakeup wakeup, int& count) {
    bus().subscribe<sim_clock_t>(
        channel,
        [this, &count](const sim_clock_t& m) {
          fold(static_cast<std::uint64_t>(m.clock_step_us));
          ++count;
        },
        wakeup);
  }

 private:
  std::uint64_t state_ = 0x1234567;
};

// Answers ASK.<client> with ANSWER.<client>, at the instant.
class AnsweringNode : public NumberNode {
 public:
  AnsweringNode(lcm::LCM& lcm, const std::string& name, const std::vector<std::string>& clients)
      : NumberNode(lcm, {name, 1, bus::Stage::kTerrain}), clients_(clients), asked_(clients.size()) {
    for (std::size_t i = 0; i < clients.size(); ++i)
      receive("ASK." + clients[i], bus::Wakeup::kMayAdvanceDue, asked_[i]);
  }

 protected:
  bus::Due on_due() const override {
    const bool waits = std::any_of(asked_.begin(), asked_.end(), [](int count) { return count > 0; });
    return {.sim = waits ? SimTime::at_once() : SimTime::never()};
  }
  void on_step(const bus::Now& now) override {
    for (std::size_t i = 0; i < clients_.size(); ++i) {
      for (; asked_[i] > 0; --asked_[i]) send("ANSWER." + clients_[i], now.sim);
    }
  }
  // STATUS tells of nothing that depends on when others asked.
  std::string status_text() const override { return ""; }

 private:
  std::vector<std::string> clients_;
  std::vector<int> asked_;
};

class SharingNode : public NumberNode {
 public:
  // Publishes EVENT.<name> between ticks and MARK.<name> at each; receives NEWS of `others`, REQUEST.<name>
  // and the marks of `mates`. A `liar` promises to be quiet and is not.
  SharingNode(lcm::LCM& lcm, const std::string& name, SimDuration period,
              const std::vector<std::string>& others, const std::vector<std::string>& mates,
              bool liar = false)
      : NumberNode(lcm, {name, 1, bus::Stage::kChannel}), period_(period), is_liar_(liar) {
    for (const std::string& other : others) receive("NEWS." + other, bus::Wakeup::kStoreOnly, stored_);
    for (const std::string& mate : mates) receive("MARK." + mate, bus::Wakeup::kMayAdvanceDue, marks_);
    receive("REQUEST." + name, bus::Wakeup::kMayAdvanceDue, requests_);
    receive("ANSWER." + name, bus::Wakeup::kMayAdvanceDue, answers_);
  }

 protected:
  bus::Due on_due() const override {
    if (requests_ + answers_ + marks_ > 0) return {.sim = SimTime::at_once()};
    return {.sim = waits_ ? next_tick_ : std::min(next_event_, next_tick_)};
  }
  SimTime on_lookahead(const ChannelTest& matters) const override {
    if (is_liar_) return SimTime::never();
    return matters("EVENT." + name()) ? SimTime::at_once() : next_tick_;
  }
  void on_step(const bus::Now& now) override {
    if (answers_ > 0) waits_ = false;
    for (; requests_ > 0; --requests_) send("EVENT." + name(), now.sim);
    answers_ = marks_ = 0;
    if (!waits_ && next_event_ <= now.sim) act(now.sim);
    if (now.sim < next_tick_) return;
    send("MARK." + name(), now.sim);
    next_tick_ = next_on_grid(now.sim, kTick);
  }

 private:
  static constexpr SimDuration kTick = SimDuration::from_milliseconds(50);
  // Some of its events are published, at some it asks, and waits for the answer; some come twice at one
  // instant.
  void act(SimTime now) {
    fold(7);
    const std::uint64_t drawn = state() >> 20;
    if (drawn % 4 != 0) send("EVENT." + name(), now);
    if (is_liar_) send("MARK." + name(), now);
    if (drawn % 64 < 2) {
      send("ASK." + name(), now);
      waits_ = true;
    }
    if (drawn % 11 == 0) return;
    next_event_ = next_on_grid(now + period_ * static_cast<std::int64_t>(drawn % 3), period_);
  }

  SimDuration period_;
  bool is_liar_;
  SimTime next_event_, next_tick_;
  int stored_ = 0, marks_ = 0, requests_ = 0, answers_ = 0;
  bool waits_ = false;
};

}  // namespace halocline::conductor::testing
