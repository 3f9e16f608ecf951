// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/lockstep_process.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <stdexcept>

#include <unistd.h>

#include "bus/config/config.h"
#include "bus/lockstep/agreement.h"
#include "bus/lockstep/lockstep_participant.h"
#include "bus/messages/channels.h"
#include "bus/runtime/lockstep_turns.h"
#include "bus/runtime/node_process.h"
#include "bus/transport/event_log.h"
#include "bus/transport/receive_filter.h"
#include "bus/transport/transport.h"
#include "core/hash.h"
#include "core/sim_time.h"

namespace halocline::bus {
namespace {

// Waiting time for the last turn after a stop was requested.
constexpr SimDuration kLastTurnTimeout = SimDuration::from_milliseconds(800);

// The participant's side of the synchronisation channel: receives grants and notices, publishes joins and
// answers.
class SyncPlane {
 public:
  SyncPlane(const std::string& url, const std::string& name, const std::string& accept)
      : grants_lcm_(open_transport(url)),
        answers_lcm_(open_transport(next_port(url))),
        receiver_(*grants_lcm_, {name, 0}),
        publisher_(*answers_lcm_, {name, 0}),
        filter_(*grants_lcm_, url, accepted_hosts(accept, url)) {}

  void connect(LockstepParticipant& participant, const std::string& name) {
    const auto on_grant = [&participant](const lockstep_grant_t& m) {
      participant.on_grant(m, steady_now());
    };
    receiver_.subscribe<lockstep_grant_t>(channels::kLockstepGrant, on_grant);
    receiver_.subscribe<lockstep_grant_t>(std::string(channels::kLockstepGrant) + "." + name, on_grant);
    receiver_.subscribe<lockstep_notice_t>(
        channels::kLockstepNotice,
        [&participant](const lockstep_notice_t& m) { participant.on_notice(m, steady_now()); });
    filter_.follow(&receiver_.receives(), nullptr);
  }
  LockstepParticipant::Outputs outputs() {
    return {[this](const lockstep_join_t& m) { publisher_.publish(channels::kLockstepJoin, m); },
            [this](const lockstep_answer_t& m) { publisher_.publish(channels::kLockstepAnswer, m); }};
  }
  void wait_and_dispatch(SimTime wake) {
    bus::wait_and_dispatch(*grants_lcm_, wake);
    receiver_.rethrow_if_failed();
  }

 private:
  std::unique_ptr<lcm::LCM> grants_lcm_, answers_lcm_;
  Bus receiver_, publisher_;
  ReceiveFilter filter_;
};

}  // namespace

std::string agreement_on(const Scenario& scenario) {
  Scenario shared = scenario;
  const std::string text = to_toml([&](ConfigVisitor& v) { visit(v, shared); }, /*with_comments=*/false);
  return agreement_on(std::to_string(fnv1a(text)));
}

std::int64_t draw_incarnation() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count() * 1000 + getpid() % 1000;
}

void run_lockstep_participant(Node& node, const std::string& sync_url, const Scenario& scenario,
                              const std::function<bool()>& should_stop) {
  EventLog log(node.name());
  LockstepTurns turns(node);
  lockstep_join_t join = turns.introduction();
  join.incarnation = draw_incarnation();
  join.scenario_digest = agreement_on(scenario);
  SyncPlane plane(effective_url(sync_url), node.name(), scenario.accept);
  LockstepParticipant participant(
      join, [&turns](const lockstep_turn_t& turn) { return turns.take(turn); }, plane.outputs());
  plane.connect(participant, node.name());
  log.info("started", "sync_url=" + sync_url);
  SimTime give_up_at = SimTime::never();
  while (!participant.has_ended() && steady_now() < give_up_at) {
    participant.on_timer(steady_now());
    if (should_stop() && give_up_at == SimTime::never()) {
      participant.request_leave();
      give_up_at = steady_now() + kLastTurnTimeout;
      continue;
    }
    plane.wait_and_dispatch(std::min(participant.next_timer(), give_up_at));
  }
  if (participant.state() == LockstepParticipant::State::kExpelled)
    throw std::runtime_error("expelled by the conductor: " + participant.reason());
}

}  // namespace halocline::bus
