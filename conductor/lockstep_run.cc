// SPDX-License-Identifier: BSD-3-Clause
#include "conductor/lockstep_run.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "bus/lockstep/journal.h"
#include "bus/lockstep/lockstep_conductor.h"
#include "bus/lockstep/sequencer.h"
#include "bus/messages/channels.h"
#include "bus/runtime/lockstep_process.h"
#include "bus/runtime/lockstep_turns.h"
#include "bus/runtime/node_process.h"
#include "bus/transport/event_log.h"
#include "bus/transport/receive_filter.h"
#include "bus/transport/transport.h"
#include "conductor/bus_bridge.h"
#include "conductor/conductor_node.h"
#include "conductor/lockstep_log.h"
#include "conductor/lockstep_pace.h"
#include "conductor/wait_monitor.h"

namespace halocline::conductor {
namespace {

// Time for the last turns after a stop was requested.
constexpr SimDuration kLastTurnTimeout = SimDuration::from_milliseconds(800);
// Time after the end in which JOINs of participants that missed the notice are answered.
constexpr SimDuration kLinger = SimDuration::from_milliseconds(600);

class Run {
 public:
  Run(lcm::LCM& bus_lcm, const bus::NodeIdentity& identity, const bus::Scenario& scenario,
      const LockstepRun& run)
      : run_(run),
        events_(identity.name),
        grants_lcm_(bus::open_transport(bus::effective_url(run.sync_url))),
        answers_lcm_(bus::open_transport(answers_url(run))),
        publisher_(*grants_lcm_, {identity.name, 0}),
        receiver_(*answers_lcm_, {identity.name, 0}),
        filter_(*answers_lcm_, answers_url(run), bus::accepted_hosts(scenario.accept, answers_url(run))),
        bus_lcm_(bus_lcm),
        node_(memq_, {identity.name, bus::session_of(scenario.seed, identity.name), bus::Stage::kTime},
              scenario.clock_period, 0.0),
        turns_(node_),
        log_(run.log_path),
        pace_(run.rate) {
    std::function<void(lockstep_message_t)> on_bridged;
    if (run.bridge_bus) {
      bus_filter_.emplace(bus_lcm, run.bus_url, bus::accepted_hosts(scenario.accept, run.bus_url));
      on_bridged = [this](lockstep_message_t m) { conductor_->inject(std::move(m)); };
    }
    bridge_.emplace(bus_lcm, on_bridged);
    begin(scenario);
    subscribe();
  }

  void until_over(const std::function<bool()>& should_stop) {
    SimTime give_up_at = SimTime::never();
    while (!conductor_->over() && bus::steady_now() < give_up_at) {
      pace_.keep(*conductor_, bus::steady_now());
      conductor_->on_timer(bus::steady_now());
      if (should_stop() && give_up_at == SimTime::never()) {
        conductor_->request_stop();
        give_up_at = bus::steady_now() + kLastTurnTimeout;
      }
      const std::string waiting_for = wait_monitor_.overdue(*conductor_, bus::steady_now());
      if (!waiting_for.empty()) events_.warning("waiting", "for=" + waiting_for);
      dispatch_until(std::min({conductor_->next_timer(), pace_.next_due(), give_up_at}));
    }
    log_.close();
    if (!conductor_->over()) return events_.warning("unfinished", "the journal keeps the run open");
    const Sequencer& sequencer = conductor_->sequencer();
    events_.info("over", "t=" + std::to_string(sequencer.now().seconds()) +
                             " rounds=" + std::to_string(sequencer.rounds()) +
                             " turns=" + std::to_string(sequencer.turns()) +
                             " retransmissions=" + std::to_string(conductor_->retransmissions()));
    const SimTime end = std::min(bus::steady_now() + kLinger, give_up_at);
    while (bus::steady_now() < end) dispatch_until(end);
  }

 private:
  static std::string answers_url(const LockstepRun& run) {
    return bus::next_port(bus::effective_url(run.sync_url));
  }

  void begin(const bus::Scenario& scenario) {
    JournalContents journal;
    if (!run_.journal_path.empty()) journal = read_journal(run_.journal_path);
    if (journal.bytes_cut_off > 0)
      events_.warning("journal-repaired", "bytes_cut_off=" + std::to_string(journal.bytes_cut_off));
    if (!run_.journal_path.empty()) journal_.emplace(run_.journal_path);
    LockstepRules rules;
    rules.expected = run_.expected;
    rules.expected.insert(node_.name());
    rules.end = SimTime() + scenario.duration;
    rules.drop_after = run_.drop_after;
    rules.agreement = bus::agreement_on(scenario);
    rules.lookahead = run_.lookahead && run_.rate == 0;
    conductor_.emplace(std::move(rules), bus::draw_incarnation(), outputs());
    conductor_->add_local(turns_.introduction(), [this](const lockstep_turn_t& t) { return turns_.take(t); });
    if (journal.entries.empty()) {
      conductor_->start();
    } else {
      conductor_->resume(journal.entries);
    }
    log_.open();
    is_live_ = true;
    events_.info("started", "mode=lockstep sync_url=" + run_.sync_url);
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
      if (!journal_ || journal_->append(entry)) return;
      events_.error("journal-given-up",
                    "reason=\"the disk refused it, or it was deleted or truncated; the run cannot be "
                    "continued after a kill\"");
      journal_.reset();
      std::remove(run_.journal_path.c_str());
    };
    outputs.publish = [this](const lockstep_message_t& m) { on_message(m); };
    outputs.report = [this](const std::string& event, const std::string& detail) {
      events_.set_time(conductor_ ? conductor_->sequencer().now() : SimTime());
      if (event == "dropped" || event == "expelled") {
        events_.warning(event, detail);
      } else {
        events_.info(event, detail);
      }
    };
    return outputs;
  }

  // A resumed run writes its log again from the start; messages that an earlier incarnation mirrored on the
  // bus are not mirrored again.
  void on_message(const lockstep_message_t& message) {
    log_.record(message);
    if (is_live_) bridge_->mirror(message);
  }

  void subscribe() {
    receiver_.subscribe<lockstep_join_t>(bus::channels::kLockstepJoin, [this](const lockstep_join_t& m) {
      conductor_->on_join(m, bus::steady_now());
    });
    receiver_.subscribe<lockstep_answer_t>(
        bus::channels::kLockstepAnswer,
        [this](const lockstep_answer_t& m) { conductor_->on_answer(m, bus::steady_now()); });
    filter_.follow(&receiver_.receives(), nullptr);
  }

  void dispatch_until(SimTime wake) {
    bus::wait_and_dispatch(*answers_lcm_, wake);
    receiver_.rethrow_if_failed();
    if (run_.bridge_bus) bus::dispatch_waiting(bus_lcm_);
  }

  LockstepRun run_;
  bus::EventLog events_;
  std::unique_ptr<lcm::LCM> grants_lcm_, answers_lcm_;
  bus::Bus publisher_, receiver_;
  bus::ReceiveFilter filter_;
  std::optional<bus::ReceiveFilter> bus_filter_;
  lcm::LCM& bus_lcm_;
  lcm::LCM memq_{"memq://"};
  ConductorNode node_;
  bus::LockstepTurns turns_;
  std::optional<BusBridge> bridge_;
  LockstepLog log_;
  LockstepPace pace_;
  WaitMonitor wait_monitor_;
  std::optional<Journal> journal_;
  std::optional<LockstepConductor> conductor_;
  bool is_live_ = false;
};

}  // namespace

void run_lockstep(lcm::LCM& bus_lcm, const bus::NodeIdentity& identity, const bus::Scenario& scenario,
                  const LockstepRun& run, const std::function<bool()>& should_stop) {
  Run(bus_lcm, identity, scenario, run).until_over(should_stop);
}

}  // namespace halocline::conductor
