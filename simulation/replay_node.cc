// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/replay_node.h"

#include <utility>
#include <variant>

#include "core/sim_time.h"

namespace halocline::clients {

ReplayNode::ReplayNode(lcm::LCM& lcm, bus::NodeIdentity identity, Recording recording)
    : Node(lcm, std::move(identity)), recording_(std::move(recording)) {}

bus::Due ReplayNode::on_due() const {
  const bool done = next_ == recording_.events.size();
  return {.sim = done ? SimTime::never() : recording_.events[next_].at};
}

void ReplayNode::on_step(const bus::Now& now) {
  for (; next_ < recording_.events.size() && recording_.events[next_].at <= now.sim; ++next_) {
    const Recording::Event& event = recording_.events[next_];
    std::visit([&](const auto& message) { bus().publish(event.channel, message); }, event.message);
  }
}

std::string ReplayNode::status_text() const {
  return "played " + std::to_string(next_) + " of " + std::to_string(recording_.events.size()) +
         " recorded messages";
}

}  // namespace halocline::clients
