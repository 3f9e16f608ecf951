#include "conductor/lockstep_run.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "bus/channels.h"
#include "bus/event_log.h"
#include "bus/lockstep/journal.h"
#include "bus/lockstep/lockstep_conductor.h"
#include "bus/lockstep/sequencer.h"
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

// For the last turns after a stop was requested.
constexpr SimDuration kLastTurnTimeout = SimDuration::from_milliseconds(4000);
// After the end, for JOINs of participants that lost the notice.
constexpr SimDuration kLinger = SimDuration::from_milliseconds(600);
// Between warnings that name the participants waited for.
constexpr SimDuration kWaitingPeriod = SimDuration::from_milliseconds(5000);

class Run {
 public:
  Run(lcm::LCM& bus_lcm, const bus::NodeIdentity& identity, const bus::Scenario& scenario,
      const LockstepRun& run)
      : run_(run),
        log_(identity.name),
        grants_lcm_(bus::open_transport(bus::effective_url(run.sync_url))),
        answers_lcm_(bus::open_transport(bus::next_port(bus::effective_url(run.sync_url)))),
        publisher_(*grants_lcm_, {identity.name, 0}),
        receiver_(*answers_lcm_, {identity.name, 0}),
        bus_lcm_(bus_lcm),
        node_(memq_, {identity.name, bus::session_of(scenario.seed, identity.name), bus::Stage::kTime},
              scenario.clock_period, 0.0),
        turns_(memq_, node_) {
    std::function<void(lockstep_message_t)> on_bridged;
    if (run.bridge_bus) on_bridged = [this](lockstep_message_t m) { conductor_->inject(std::move(m)); };
    bridge_.emplace(bus_lcm, on_bridged);
    begin(scenario);
    subscribe();
  }

  void until_over(const std::function<bool()>& should_stop) {
    SimTime give_up_at = SimTime::never();
    while (!conductor_->over() && bus::steady_now() < give_up_at) {
      keep_pace();
      conductor_->on_timer(bus::steady_now());
      if (should_stop() && give_up_at == SimTime::never()) {
        conductor_->request_stop();
        give_up_at = bus::steady_now() + kLastTurnTimeout;
      }
      warn_of_waiting();
      dispatch_until(std::min({conductor_->next_timer(), next_pace_, give_up_at}));
    }
    if (recorder_) recorder_->close();
    if (!conductor_->over()) return log_.warning("unfinished", "the journal keeps the run open");
    const Sequencer& sequencer = conductor_->sequencer();
    log_.info("over", "t=" + std::to_string(sequencer.now().seconds()) + " rounds=" +
                          std::to_string(sequencer.rounds()) + " turns=" + std::to_string(sequencer.turns()) +
                          " retransmissions=" + std::to_string(conductor_->retransmissions()));
    for (const SimTime end = bus::steady_now() + kLinger; bus::steady_now() < end;) dispatch_until(end);
  }

 private:
  void begin(const bus::Scenario& scenario) {
    JournalContents journal;
    if (!run_.journal_path.empty()) journal = read_journal(run_.journal_path);
    if (journal.bytes_cut_off > 0)
      log_.warning("journal-repaired", "bytes=" + std::to_string(journal.bytes_cut_off));
    if (!run_.journal_path.empty()) journal_.emplace(run_.journal_path);
    LockstepRules rules;
    rules.expected = run_.expected;
    rules.expected.insert(node_.name());
    rules.end = SimTime() + scenario.duration;
    rules.drop_after = run_.drop_after;
    rules.scenario_digest = bus::digest_of(scenario);
    rules.lookahead = run_.lookahead && run_.rate == 0;
    conductor_.emplace(std::move(rules), bus::draw_incarnation(), outputs());
    conductor_->add_local(turns_.introduction(), [this](const lockstep_turn_t& t) { return turns_.take(t); });
    if (journal.entries.empty()) {
      conductor_->start();
    } else {
      conductor_->resume(journal.entries);
    }
    open_log();
    is_live_ = true;
    if (run_.rate > 0) conductor_->set_pace(SimTime());
    log_.info("started", "mode=lockstep sync_url=" + run_.sync_url);
  }

  LockstepConductor::Outputs outputs() {
    LockstepConductor::Outputs outputs;
    outputs.grant = [this](const std::string& channel, const lockstep_grant_t& m) {
      publisher_.publish(channel, m);
    };
    outputs.notice = [this](const lockstep_notice_t& m) {
      publisher_.publish(bus::channels::kLockstepNotice, m);
    };
    outputs.record = [this](const JournalEntry& entry) {
      if (journal_) journal_->append(entry);
    };
    outputs.publish = [this](const lockstep_message_t& m) { on_message(m); };
    outputs.report = [this](const std::string& event, const std::string& detail) {
      log_.set_time(conductor_ ? conductor_->sequencer().now() : SimTime());
      if (event == "dropped" || event == "expelled") {
        log_.warning(event, detail);
      } else {
        log_.info(event, detail);
      }
    };
    return outputs;
  }

  // Not before the journal has proved to be of this scenario: a refused one leaves the log as it was.
  void open_log() {
    if (!recorder_ && !run_.log_path.empty())
      recorder_.emplace(log_lcm_, run_.log_path, [this] { return stamp_; });
  }

  // A resumed run writes its log anew; what an earlier incarnation mirrored on the bus is not mirrored again.
  void on_message(const lockstep_message_t& message) {
    open_log();
    if (recorder_) {
      stamp_ = SimTime::from_nanoseconds(message.instant_ns);
      log_lcm_.publish(message.channel_name, message.message_bytes.data(),
                       static_cast<unsigned int>(message.message_bytes.size()));
      log_lcm_.handleTimeout(0);
    }
    if (is_live_) bridge_->mirror(message);
  }

  void subscribe() {
    receiver_.subscribe<lockstep_join_t>(bus::channels::kLockstepJoin, [this](const lockstep_join_t& m) {
      conductor_->on_join(m, bus::steady_now());
    });
    receiver_.subscribe<lockstep_answer_t>(
        bus::channels::kLockstepAnswer,
        [this](const lockstep_answer_t& m) { conductor_->on_answer(m, bus::steady_now()); });
  }

  void dispatch_until(SimTime wake) {
    bus::wait_and_dispatch(*answers_lcm_, wake);
    receiver_.rethrow_if_failed();
    if (run_.bridge_bus) bus::dispatch_waiting(bus_lcm_);
  }

  // Simulation time may advance as far as the wall clock has since the run began, or was resumed.
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

  void warn_of_waiting() {
    const SimTime steady = bus::steady_now();
    const std::int64_t turns = conductor_->sequencer().turns();
    if (turns != turns_before_) {
      turns_before_ = turns;
      next_warning_ = steady + kWaitingPeriod;
    }
    if (steady < next_warning_) return;
    next_warning_ = steady + kWaitingPeriod;
    std::string names;
    for (const std::string& name : conductor_->waiting_for()) names += (names.empty() ? "" : ",") + name;
    if (!names.empty()) log_.warning("waiting", "for=" + names);
  }

  LockstepRun run_;
  bus::EventLog log_;
  std::unique_ptr<lcm::LCM> grants_lcm_, answers_lcm_;
  bus::Bus publisher_, receiver_;
  lcm::LCM& bus_lcm_;
  lcm::LCM memq_{"memq://"};
  ConductorNode node_;
  bus::LockstepTurns turns_;
  std::optional<BusBridge> bridge_;
  lcm::LCM log_lcm_{"memq://"};  // carries the messages to record, and nothing else
  SimTime stamp_;
  std::optional<bus::LogRecorder> recorder_;
  std::optional<Journal> journal_;
  std::optional<LockstepConductor> conductor_;
  bool is_live_ = false;
  std::optional<std::pair<SimTime, SimTime>> paced_from_;  // steady, simulation
  SimTime next_pace_ = SimTime::never(), next_warning_ = SimTime() + kWaitingPeriod;
  std::int64_t turns_before_ = 0;
};

}  // namespace

void run_lockstep(lcm::LCM& bus_lcm, const bus::NodeIdentity& identity, const bus::Scenario& scenario,
                  const LockstepRun& run, const std::function<bool()>& should_stop) {
  Run(bus_lcm, identity, scenario, run).until_over(should_stop);
}

}  // namespace halocline::conductor
