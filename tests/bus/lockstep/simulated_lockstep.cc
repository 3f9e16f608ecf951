#include "tests/bus/lockstep/simulated_lockstep.h"

#include <stdexcept>

#include "bus/runtime/lockstep_runner.h"

namespace halocline::conductor::testing {
namespace {

constexpr std::int64_t kRunId = 77;
constexpr SimDuration kTick = SimDuration::from_milliseconds(1);

struct Recorder {
  const bus::LockstepRunner* runner = nullptr;
  Said said;
  void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    lockstep_message_t message{};
    message.instant_ns = runner->now().nanoseconds();
    message.channel_name = channel;
    const auto* bytes = static_cast<const std::uint8_t*>(buffer->data);
    message.message_bytes.assign(bytes, bytes + buffer->data_size);
    said.push_back(text_of(message));
  }
};

}  // namespace

std::string text_of(const lockstep_message_t& message) {
  return std::to_string(message.instant_ns) + " " + message.channel_name + " " +
         std::string(message.message_bytes.begin(), message.message_bytes.end());
}

std::vector<Cast> five_nodes() {
  const auto ms = [](std::int64_t n) { return SimDuration::from_milliseconds(n); };
  return {{"clock", bus::Stage::kTime, ms(100)},
          {"mover-a", bus::Stage::kVehicles, ms(7)},
          {"mover-b", bus::Stage::kVehicles, ms(30)},
          {"pilot", bus::Stage::kPilots, ms(50)},
          {"server", bus::Stage::kChannel, ms(70)}};
}

std::unique_ptr<ChattyNode> make_node(lcm::LCM& lcm, const std::vector<Cast>& cast, std::size_t index) {
  const Cast& part = cast[index];
  std::vector<std::string> others;
  for (const Cast& other : cast) {
    if (other.name != part.name) others.push_back(other.name);
  }
  return std::make_unique<ChattyNode>(lcm, part.name, part.stage, part.period, others,
                                      cast[(index + 2) % cast.size()].name);
}

Said said_in_one_process(const std::vector<Cast>& cast, SimTime end) {
  lcm::LCM lcm("memq://");
  std::vector<std::unique_ptr<ChattyNode>> nodes;
  std::vector<bus::Node*> all;
  for (std::size_t i = 0; i < cast.size(); ++i) {
    nodes.push_back(make_node(lcm, cast, i));
    all.push_back(nodes.back().get());
  }
  bus::LockstepRunner runner(lcm, all);
  Recorder recorder{&runner, {}};
  lcm.subscribe(".*", &Recorder::on_message, &recorder);
  runner.run_until(end);
  runner.stop();
  return recorder.said;
}

SimulatedLockstep::SimulatedLockstep(std::vector<Cast> cast, SimTime end, const NetworkRules& rules,
                                     unsigned seed)
    : cast_(std::move(cast)), end_(end), rules_(rules), random_(seed), processes_(cast_.size()) {
  start_conductor();
  for (std::size_t i = rules_.local; i < cast_.size(); ++i) {
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
  const int copies = draw() < rules_.loss ? 0 : draw() < rules_.doubling ? 2 : 1;
  for (int i = 0; i < copies; ++i) {
    later(SimDuration::from_seconds(rules_.longest_delay.seconds() * draw()), delivery);
  }
}

// It may die at whatever it does: before an entry is in the journal, between entry and grant, between two grants.
void SimulatedLockstep::maybe_die() {
  if (conductor_death_ > 0 && draw() < conductor_death_) throw Died();
}

void SimulatedLockstep::start_conductor() {
  LockstepRules rules;
  for (const Cast& part : cast_) rules.expected.insert(part.name);
  rules.end = end_;
  rules.drop_after = rules_.drop_after;
  rules.windows = rules_.windows;
  LockstepConductor::Mouth mouth;
  mouth.grant = [this](const std::string&, const lockstep_grant_t& grant) {
    maybe_die();
    for (std::size_t i = 0; i < processes_.size(); ++i) {
      send([this, i, grant] {
        if (auto* one = participant(i)) one->on_grant(grant, now_);
      });
    }
  };
  mouth.notice = [this](const lockstep_notice_t& notice) {
    for (std::size_t i = 0; i < processes_.size(); ++i) {
      send([this, i, notice] {
        if (auto* one = participant(i)) one->on_notice(notice, now_);
      });
    }
  };
  mouth.record = [this](const JournalEntry& entry) {
    maybe_die();
    journal_.push_back(entry);
    maybe_die();
  };
  mouth.said = [this](const lockstep_message_t& message) { said_.push_back(text_of(message)); };
  mouth.report = [this](const std::string& event, const std::string& detail) {
    reports_.push_back(event + " " + detail);
  };
  said_.clear();
  conductor_death_ = 0;
  conductor_ = std::make_unique<LockstepConductor>(rules, kRunId, std::move(mouth));
  local_.clear();
  for (std::size_t i = 0; i < rules_.local; ++i) {
    local_.push_back(std::make_unique<Process>());
    Process& process = *local_.back();
    process.node = make_node(process.memq, cast_, i);
    process.turns = std::make_unique<bus::LockstepTurns>(process.memq, *process.node);
    conductor_->add_local(process.turns->introduction(),
                          [&process](const lockstep_turn_t& turn) { return process.turns->take(turn); });
  }
  journal_.empty() ? conductor_->start() : conductor_->resume(journal_);
  // Says about a thousand things a second.
  conductor_death_ = rules_.conductor_deaths_per_s / 1000;
}

void SimulatedLockstep::kill_conductor() {
  ++deaths_;
  conductor_.reset();
  later(SimDuration::from_seconds(0.05 * draw()), [this] { start_conductor(); });
}

void SimulatedLockstep::start_participant(std::size_t index) {
  auto process = std::make_unique<Process>();
  process->node = make_node(process->memq, cast_, index);
  process->turns = std::make_unique<bus::LockstepTurns>(process->memq, *process->node);
  lockstep_join_t join = process->turns->introduction();
  join.incarnation = next_life_++;
  bus::LockstepTurns* turns = process->turns.get();
  bus::LockstepParticipant::Mouth mouth;
  mouth.join = [this](const lockstep_join_t& m) {
    send([this, m] { to_conductor([&](LockstepConductor& c) { c.on_join(m, now_); }); });
  };
  mouth.answer = [this](const lockstep_answer_t& m) {
    send([this, m] { to_conductor([&](LockstepConductor& c) { c.on_answer(m, now_); }); });
  };
  process->participant = std::make_unique<bus::LockstepParticipant>(
      join, [turns](const lockstep_turn_t& turn) { return turns->take(turn); }, std::move(mouth));
  processes_[index] = std::move(process);
}

void SimulatedLockstep::kill_participant(std::size_t index) {
  ++deaths_;
  processes_[index].reset();
}

bus::LockstepParticipant* SimulatedLockstep::participant(std::size_t index) {
  return processes_[index] == nullptr ? nullptr : processes_[index]->participant.get();
}

void SimulatedLockstep::to_conductor(const std::function<void(LockstepConductor&)>& tell) {
  if (conductor_ == nullptr) return;
  try {
    tell(*conductor_);
  } catch (const Died&) {
    kill_conductor();
  }
}

void SimulatedLockstep::turn_timers() {
  to_conductor([&](LockstepConductor& conductor) { conductor.on_timer(now_); });
  for (std::size_t i = rules_.local; i < cast_.size(); ++i) {
    bus::LockstepParticipant* one = participant(i);
    if (one == nullptr) continue;
    one->on_timer(now_);
    const bool put_out = one->state() == bus::LockstepParticipant::State::kExpelled;
    const bool for_good = i == cast_.size() - 1 && rules_.dies_for_good_after >= 0;
    if (for_good && conductor_ != nullptr &&
        conductor_->sequencer().turns_taken(cast_[i].name) >= rules_.dies_for_good_after) {
      kill_participant(i);
    } else if (put_out || draw() < rules_.participant_deaths_per_s * kTick.seconds() /
                                       static_cast<double>(cast_.size() - rules_.local)) {
      if (one->state() == bus::LockstepParticipant::State::kOver) continue;
      kill_participant(i);
      later(SimDuration::from_seconds(0.05 * draw()), [this, i] { start_participant(i); });
    }
  }
  later(kTick, [this] { turn_timers(); });
}

void SimulatedLockstep::run(SimDuration patience) {
  const auto all_have_heard = [this] {
    for (std::size_t i = rules_.local; i < cast_.size(); ++i) {
      if (participant(i) != nullptr && !participant(i)->has_ended()) return false;
    }
    return true;
  };
  while (conductor_ == nullptr || !conductor_->over() || !all_have_heard()) {
    if (now_ > SimTime() + patience) throw std::runtime_error("the run does not end");
    const Event event = events_.top();
    events_.pop();
    now_ = event.when;
    event.what();
    between_events(*this);
  }
}

}  // namespace halocline::conductor::testing
