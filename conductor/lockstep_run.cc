#include "conductor/lockstep_run.h"

#include <algorithm>
#include <memory>
#include <optional>

#include "bus/channels.h"
#include "bus/lockstep/lockstep_conductor.h"
#include "bus/logs/log_recorder.h"
#include "bus/runtime/lockstep_process.h"
#include "bus/runtime/lockstep_turns.h"
#include "bus/runtime/node_process.h"
#include "bus/transport.h"
#include "conductor/bus_bridge.h"
#include "conductor/conductor_node.h"
#include "core/check.h"

namespace halocline::conductor {
namespace {

// How long farewells are waited for after a stop was wished for; how long the end is told to who asks; how
// often who is waited for is named.
constexpr SimDuration kFarewellPatience = SimDuration::from_milliseconds(4000);
constexpr SimDuration kLastWords = SimDuration::from_milliseconds(600);
constexpr SimDuration kNamingPeriod = SimDuration::from_milliseconds(5000);

class Run {
 public:
  Run(lcm::LCM& bus_lcm, const bus::NodeIdentity& identity, const bus::Scenario& scenario,
      const LockstepRun& run)
      : run_(run),
        log_(identity.name),
        grants_lcm_(bus::open_transport(bus::effective_url(run.sync_url))),
        answers_lcm_(bus::open_transport(bus::next_port(bus::effective_url(run.sync_url)))),
        mouth_(*grants_lcm_, {identity.name, 0}),
        ears_(*answers_lcm_, {identity.name, 0}),
        bus_lcm_(bus_lcm),
        node_(memq_, {identity.name, bus::session_of(scenario.seed, identity.name), bus::Stage::kTime},
              scenario.clock_period, 0.0),
        turns_(memq_, node_) {
    std::function<void(lockstep_message_t)> heard;
    if (run.hear_outside) heard = [this](lockstep_message_t m) { conductor_->on_outside(std::move(m)); };
    outside_.emplace(bus_lcm, heard);
    if (!run.log_path.empty()) recorder_.emplace(log_lcm_, run.log_path, [this] { return stamp_; });
    begin(scenario);
    listen();
  }

  void until_over(const std::function<bool()>& should_stop) {
    SimTime patience_ends = SimTime::never();
    while (!conductor_->over() && bus::steady_now() < patience_ends) {
      keep_pace();
      conductor_->on_timer(bus::steady_now());
      if (should_stop() && patience_ends == SimTime::never()) {
        conductor_->ask_to_stop();
        patience_ends = bus::steady_now() + kFarewellPatience;
      }
      name_who_is_waited_for();
      hear_until(std::min({conductor_->next_timer(), next_pace_, patience_ends}));
    }
    if (recorder_) recorder_->close();
    if (!conductor_->over()) return log_.warning("unfinished", "the journal keeps the run open");
    const Sequencer& sequencer = conductor_->sequencer();
    log_.info("over", "t=" + std::to_string(sequencer.now().seconds()) + " rounds=" +
                          std::to_string(sequencer.rounds()) + " turns=" + std::to_string(sequencer.turns()) +
                          " repetitions=" + std::to_string(conductor_->repetitions()));
    for (const SimTime end = bus::steady_now() + kLastWords; bus::steady_now() < end;) hear_until(end);
  }

 private:
  void begin(const bus::Scenario& scenario) {
    JournalContents past;
    if (!run_.journal_path.empty()) past = read_journal(run_.journal_path);
    if (past.bytes_cut_off > 0) log_.warning("journal-mended", "bytes=" + std::to_string(past.bytes_cut_off));
    require(past.entries.empty() || past.entries.back().kind != EntryKind::kOver,
            "the run of the journal " + run_.journal_path + " is over; remove it or name another");
    if (!run_.journal_path.empty()) journal_.emplace(run_.journal_path);
    LockstepRules rules;
    rules.expected = run_.expected;
    rules.expected.insert(node_.name());
    rules.end = SimTime() + scenario.duration;
    rules.drop_after = run_.drop_after;
    rules.scenario_digest = bus::digest_of(scenario);
    rules.windows = run_.windows && run_.rate == 0;
    conductor_.emplace(std::move(rules), bus::draw_life(), mouth());
    conductor_->add_local(turns_.introduction(), [this](const lockstep_turn_t& t) { return turns_.take(t); });
    past.entries.empty() ? conductor_->start() : conductor_->resume(past.entries);
    live_ = true;
    if (run_.rate > 0) conductor_->set_pace(SimTime());
    log_.info("started", "mode=lockstep sync_url=" + run_.sync_url);
  }

  LockstepConductor::Mouth mouth() {
    LockstepConductor::Mouth mouth;
    mouth.grant = [this](const std::string& channel, const lockstep_grant_t& m) {
      mouth_.publish(channel, m);
    };
    mouth.notice = [this](const lockstep_notice_t& m) { mouth_.publish(bus::channels::kLockstepNotice, m); };
    mouth.record = [this](const JournalEntry& entry) {
      if (journal_) journal_->append(entry);
    };
    mouth.said = [this](const lockstep_message_t& m) { take_down(m); };
    mouth.report = [this](const std::string& event, const std::string& detail) {
      log_.set_time(conductor_ ? conductor_->sequencer().now() : SimTime());
      event == "dropped" || event == "put-out" ? log_.warning(event, detail) : log_.info(event, detail);
    };
    return mouth;
  }

  // What an earlier life showed is not shown again; the log is written anew.
  void take_down(const lockstep_message_t& message) {
    if (recorder_) {
      stamp_ = SimTime::from_nanoseconds(message.instant_ns);
      log_lcm_.publish(message.channel_name, message.message_bytes.data(),
                       static_cast<unsigned int>(message.message_bytes.size()));
      log_lcm_.handleTimeout(0);
    }
    if (live_) outside_->show(message);
  }

  void listen() {
    ears_.subscribe<lockstep_join_t>(bus::channels::kLockstepJoin, [this](const lockstep_join_t& m) {
      conductor_->on_join(m, bus::steady_now());
    });
    ears_.subscribe<lockstep_answer_t>(bus::channels::kLockstepAnswer, [this](const lockstep_answer_t& m) {
      conductor_->on_answer(m, bus::steady_now());
    });
  }

  void hear_until(SimTime wake) {
    bus::wait_and_dispatch(*answers_lcm_, wake);
    ears_.rethrow_if_failed();
    if (run_.hear_outside) bus::dispatch_waiting(bus_lcm_);
  }

  // Simulation time is let go as far as the wall has come since the run began, or was taken up.
  void keep_pace() {
    const SimTime steady = bus::steady_now();
    const Sequencer& sequencer = conductor_->sequencer();
    if (run_.rate <= 0 || sequencer.rounds() == 0) return;
    if (!paced_from_) paced_from_ = {steady, sequencer.now()};
    const auto& [wall_start, sim_start] = *paced_from_;
    conductor_->set_pace(sim_start + SimDuration::from_seconds((steady - wall_start).seconds() * run_.rate));
    next_pace_ = steady + SimDuration::from_milliseconds(1);
    const SimTime next = sequencer.next_instant();
    if (sequencer.in_round() || next == SimTime::never()) return;
    next_pace_ = std::max(next_pace_,
                          wall_start + SimDuration::from_seconds((next - sim_start).seconds() / run_.rate));
  }

  void name_who_is_waited_for() {
    const SimTime steady = bus::steady_now();
    const std::int64_t turns = conductor_->sequencer().turns();
    if (turns != turns_seen_) {
      turns_seen_ = turns;
      next_naming_ = steady + kNamingPeriod;
    }
    if (steady < next_naming_) return;
    next_naming_ = steady + kNamingPeriod;
    std::string names;
    for (const std::string& name : conductor_->waiting_for()) names += (names.empty() ? "" : ",") + name;
    if (!names.empty()) log_.warning("waiting", "for=" + names);
  }

  LockstepRun run_;
  bus::EventLog log_;
  std::unique_ptr<lcm::LCM> grants_lcm_, answers_lcm_;
  bus::Bus mouth_, ears_;
  lcm::LCM& bus_lcm_;
  lcm::LCM memq_{"memq://"};
  ConductorNode node_;
  bus::LockstepTurns turns_;
  std::optional<BusBridge> outside_;
  lcm::LCM log_lcm_{"memq://"};  // what is recorded, and nothing else
  SimTime stamp_;
  std::optional<bus::LogRecorder> recorder_;
  std::optional<Journal> journal_;
  std::optional<LockstepConductor> conductor_;
  bool live_ = false;
  std::optional<std::pair<SimTime, SimTime>> paced_from_;  // steady, simulation
  SimTime next_pace_ = SimTime::never(), next_naming_ = SimTime() + kNamingPeriod;
  std::int64_t turns_seen_ = 0;
};

}  // namespace

void run_lockstep(lcm::LCM& bus_lcm, const bus::NodeIdentity& identity, const bus::Scenario& scenario,
                  const LockstepRun& run, const std::function<bool()>& should_stop) {
  Run(bus_lcm, identity, scenario, run).until_over(should_stop);
}

}  // namespace halocline::conductor
