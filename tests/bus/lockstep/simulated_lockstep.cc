// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bus/lockstep/simulated_lockstep.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bus/lockstep/journal.h"
#include "bus/lockstep/lockstep_conductor.h"
#include "bus/lockstep/lockstep_participant.h"
#include "bus/runtime/lockstep_runner.h"
#include "bus/runtime/lockstep_turns.h"
#include "core/sim_time.h"
#include "tests/bus/lockstep/chatty_node.h"
#include "tests/bus/lockstep/sharing_node.h"

namespace halocline::conductor::testing {
namespace {

constexpr std::int64_t kRunId = 77;
constexpr SimDuration kTick = SimDuration::from_milliseconds(1);

}  // namespace

std::string text_of(const lockstep_message_t& message) {
  return std::to_string(message.instant_ns) + " " + message.channel_name + " " +
         std::string(message.message_bytes.begin(), message.message_bytes.end());
}

std::vector<NodeRule> five_nodes() {
  const auto ms = [](std::int64_t n) { return SimDuration::from_milliseconds(n); };
  return {{"clock", bus::Stage::kTime, ms(100)},
          {"mover-a", bus::Stage::kVehicles, ms(7)},
          {"mover-b", bus::Stage::kVehicles, ms(30)},
          {"pilot", bus::Stage::kPilots, ms(50)},
          {"server", bus::Stage::kChannel, ms(70)}};
}

std::vector<NodeRule> sharing_nodes() {
  const auto ms = [](std::int64_t n) { return SimDuration::from_milliseconds(n); };
  using Kind = NodeRule::Kind;
  return {{"clock", bus::Stage::kTime, ms(100)},
          {"bottom", bus::Stage::kTerrain, ms(1), Kind::kService},
          {"mover-a", bus::Stage::kVehicles, ms(20)},
          {"mover-b", bus::Stage::kVehicles, ms(30)},
          {"server-a", bus::Stage::kChannel, ms(2), Kind::kSharing},
          {"server-b", bus::Stage::kChannel, ms(3), Kind::kSharing},
          {"server-c", bus::Stage::kChannel, ms(5), Kind::kSharing}};
}

std::unique_ptr<bus::Node> make_node(lcm::LCM& lcm, const std::vector<NodeRule>& nodes, std::size_t index) {
  const NodeRule& part = nodes[index];
  std::vector<std::string> others, mates, sharing;
  for (const NodeRule& other : nodes) {
    if (other.kind == NodeRule::Kind::kSharing) sharing.push_back(other.name);
    if (other.name != part.name) (other.stage == part.stage ? mates : others).push_back(other.name);
  }
  switch (part.kind) {
    case NodeRule::Kind::kService:
      return std::make_unique<AnsweringNode>(lcm, part.name, sharing);
    case NodeRule::Kind::kSharing:
    case NodeRule::Kind::kLiar:
      return std::make_unique<SharingNode>(lcm, part.name, part.period, others, mates,
                                           part.kind == NodeRule::Kind::kLiar);
    case NodeRule::Kind::kChatty:
      break;
  }
  others.insert(others.end(), mates.begin(), mates.end());
  return std::make_unique<ChattyNode>(lcm, part.name, part.stage, part.period, others,
                                      nodes[(index + 2) % nodes.size()].name);
}

Messages messages_of_one_process(const std::vector<NodeRule>& nodes, SimTime end) {
  lcm::LCM lcm("memq://");
  std::vector<std::unique_ptr<bus::Node>> made;
  std::vector<bus::Node*> all;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    made.push_back(make_node(lcm, nodes, i));
    all.push_back(made.back().get());
  }
  bus::LockstepRunner runner(all);
  Messages messages;
  runner.set_listener([&](SimTime at, std::string_view channel, std::span<const std::uint8_t> bytes) {
    lockstep_message_t message{};
    message.instant_ns = at.nanoseconds();
    message.channel_name = channel;
    message.message_bytes.assign(bytes.begin(), bytes.end());
    messages.push_back(text_of(message));
  });
  runner.run_until(end);
  runner.stop();
  return messages;
}

SimulatedLockstep::SimulatedLockstep(std::vector<NodeRule> nodes, SimTime end, const NetworkRules& rules,
                                     unsigned seed)
    : nodes_(std::move(nodes)), end_(end), rules_(rules), random_(seed), processes_(nodes_.size()) {
  start_conductor();
  for (std::size_t i = rules_.local; i < nodes_.size(); ++i) {
    const auto delay = SimDuration::from_seconds(0.05 * draw());
    later(delay, [this, i] { start_participant(i); });
  }
  later(kTick, [this] { turn_timers(); });
}

SimulatedLockstep::~SimulatedLockstep() = default;

void SimulatedLockstep::later(SimDuration delay, std::function<void()> what) {
  events_.push({now_ + delay, events_made_++, std::move(what)});
}

void SimulatedLockstep::send(std::function<void()> delivery) {
  ++datagrams_;
  const int copies = draw() < rules_.loss ? 0 : draw() < rules_.duplication ? 2 : 1;
  for (int i = 0; i < copies; ++i) {
    later(SimDuration::from_seconds(rules_.longest_delay.seconds() * draw()), delivery);
  }
}

// At every output: before an entry is in the journal, between entry and grant, between two grants.
void SimulatedLockstep::maybe_crash() {
  if (!may_crash_) return;
  if (conductor_outputs_++ == rules_.conductor_crashes_at) throw Crashed();
  constexpr double kOutputsPerSecond = 1000;  // about
  const double probability = rules_.conductor_crashes_per_s / kOutputsPerSecond;
  if (probability > 0 && draw() < probability) throw Crashed();
}

void SimulatedLockstep::start_conductor() {
  LockstepRules rules;
  for (const NodeRule& part : nodes_) rules.expected.insert(part.name);
  rules.end = end_;
  rules.drop_after = rules_.drop_after;
  rules.lookahead = rules_.lookahead;
  LockstepConductor::Outputs outputs;
  outputs.grant = [this](const std::string&, const lockstep_grant_t& grant) {
    maybe_crash();
    for (std::size_t i = 0; i < processes_.size(); ++i) {
      send([this, i, grant] {
        if (auto* one = participant(i)) one->on_grant(grant, now_);
      });
    }
  };
  outputs.notice = [this](const lockstep_notice_t& notice) {
    for (std::size_t i = 0; i < processes_.size(); ++i) {
      send([this, i, notice] {
        if (auto* one = participant(i)) one->on_notice(notice, now_);
      });
    }
  };
  outputs.record = [this](const JournalEntry& entry) {
    maybe_crash();
    journal_.push_back(entry);
    maybe_crash();
  };
  outputs.publish = [this](const lockstep_message_t& message) { messages_.push_back(text_of(message)); };
  outputs.report = [this](const std::string& event, const std::string& detail) {
    reports_.push_back(event + " " + detail);
  };
  messages_.clear();
  may_crash_ = false;
  conductor_ = std::make_unique<LockstepConductor>(rules, kRunId, std::move(outputs));
  local_.clear();
  for (std::size_t i = 0; i < rules_.local; ++i) {
    local_.push_back(std::make_unique<Process>());
    Process& process = *local_.back();
    process.node = make_node(process.memq, nodes_, i);
    process.turns = std::make_unique<bus::LockstepTurns>(*process.node);
    conductor_->add_local(process.turns->introduction(),
                          [&process](const lockstep_turn_t& turn) { return process.turns->take(turn); });
  }
  journal_.empty() ? conductor_->start() : conductor_->resume(journal_);
  may_crash_ = true;
}

void SimulatedLockstep::crash_conductor() {
  ++crashes_;
  conductor_.reset();
  later(SimDuration::from_seconds(0.05 * draw()), [this] { start_conductor(); });
}

void SimulatedLockstep::start_participant(std::size_t index) {
  auto process = std::make_unique<Process>();
  process->node = make_node(process->memq, nodes_, index);
  process->turns = std::make_unique<bus::LockstepTurns>(*process->node);
  lockstep_join_t join = process->turns->introduction();
  join.incarnation = next_incarnation_++;
  bus::LockstepTurns* turns = process->turns.get();
  bus::LockstepParticipant::Outputs outputs;
  outputs.join = [this](const lockstep_join_t& m) {
    send([this, m] { to_conductor([&](LockstepConductor& c) { c.on_join(m, now_); }); });
  };
  outputs.answer = [this](const lockstep_answer_t& m) {
    send([this, m] { to_conductor([&](LockstepConductor& c) { c.on_answer(m, now_); }); });
  };
  process->participant = std::make_unique<bus::LockstepParticipant>(
      join, [turns](const lockstep_turn_t& turn) { return turns->take(turn); }, std::move(outputs));
  processes_[index] = std::move(process);
}

void SimulatedLockstep::crash_participant(std::size_t index) {
  ++crashes_;
  processes_[index].reset();
}

bus::LockstepParticipant* SimulatedLockstep::participant(std::size_t index) {
  return processes_[index] == nullptr ? nullptr : processes_[index]->participant.get();
}

void SimulatedLockstep::to_conductor(const std::function<void(LockstepConductor&)>& deliver) {
  if (conductor_ == nullptr) return;
  try {
    deliver(*conductor_);
  } catch (const Crashed&) {
    crash_conductor();
  }
}

void SimulatedLockstep::turn_timers() {
  to_conductor([&](LockstepConductor& conductor) { conductor.on_timer(now_); });
  for (std::size_t i = rules_.local; i < nodes_.size(); ++i) {
    bus::LockstepParticipant* one = participant(i);
    if (one == nullptr) continue;
    one->on_timer(now_);
    const bool expelled = one->state() == bus::LockstepParticipant::State::kExpelled;
    const bool for_good = i == nodes_.size() - 1 && rules_.crashes_for_good_after >= 0;
    if (for_good && conductor_ != nullptr &&
        conductor_->sequencer().turns_taken(nodes_[i].name) >= rules_.crashes_for_good_after) {
      crash_participant(i);
    } else if (expelled || draw() < rules_.participant_crashes_per_s * kTick.seconds() /
                                        static_cast<double>(nodes_.size() - rules_.local)) {
      if (one->state() == bus::LockstepParticipant::State::kOver) continue;
      crash_participant(i);
      later(SimDuration::from_seconds(0.05 * draw()), [this, i] { start_participant(i); });
    }
  }
  later(kTick, [this] { turn_timers(); });
}

void SimulatedLockstep::run(SimDuration limit) {
  const auto all_have_ended = [this] {
    for (std::size_t i = rules_.local; i < nodes_.size(); ++i) {
      if (participant(i) != nullptr && !participant(i)->has_ended()) return false;
    }
    return true;
  };
  while (conductor_ == nullptr || !conductor_->over() || !all_have_ended()) {
    if (now_ > SimTime() + limit) throw std::runtime_error("the run does not end");
    const Event event = events_.top();
    events_.pop();
    now_ = event.when;
    event.what();
    between_events(*this);
  }
}

}  // namespace halocline::conductor::testing
