// How a channel server that was killed goes on where it was (ChannelServerNode::remember_in).
//
// Its journal holds what it heard and said in the last minute. The new life is told what was heard again,
// step by step, and lets the water pass as then: decisions depend on contents and instants alone, so they are
// the same. What was said is not said again; what was due while it was away is said at once, with its own
// instant, and counted as late. Three things take wall time on the way: the bottom under the links is asked
// for anew, tick by tick; what vehicles said meanwhile is waited for, as repair brings it; and no table of a
// tick that has passed is told.
#include <algorithm>
#include <utility>

#include "bus/channels.h"
#include "channel_server/channel_server_node.h"

namespace halocline::channel_server {
namespace {

namespace channels = bus::channels;

// How far back the journal reaches. Sound has gone 90 km by then; what is under way for longer is not taken
// up, nor is anything after a longer absence.
constexpr SimDuration kRemembered = SimDuration::from_milliseconds(60'000);
// The whole recovery waits for the terrain no longer than this; then paths are straight where the bottom is unknown.
constexpr SimDuration kTerrainPatience = SimDuration::from_milliseconds(1500);
constexpr SimDuration kInstant = SimDuration::from_nanoseconds(1);

bool is_remembered(std::string_view channel) {
  const auto in = [&](const bus::Family& family) { return channel.starts_with(family.prefix); };
  return in(channels::kState) || in(channels::kModem) || in(channels::kSend) ||
         channel == channels::kSetEnvironment || channel == channels::kPingAnswer;
}

}  // namespace

void ChannelServerNode::remember_in(const std::string& path) {
  journal_.open(
      {path, kRemembered, is_remembered, {channels::kModem}, {std::string(channels::kSetEnvironment)}});
  if (!journal_.last_step()) return;
  recovery_ = std::make_unique<Recovery>();
  journal_.replay_inputs([this](const bus::ReplayedStep& step) {
    // What was due before a step happened before it heard.
    if (!step.after_absence) recovery_->steps.push_back({step.at - kInstant, {}});
    recovery_->steps.push_back({step.at, std::exchange(inbox_, {})});
  });
}

bus::Due ChannelServerNode::recovery_due() const {
  if (!recovery_->begun) return {.sim = kBeforeAll};
  return {.steady = ray_replies_.empty() ? std::min(asker_.due(), recovery_->wake) : SimTime::at_once()};
}

bool ChannelServerNode::recover(const bus::Now& now) {
  if (!recovery_->begun) begin_recovery(now);
  while (recovery_ && !waits_for_terrain(now.steady)) {
    open_instants(recovery_->reached);
    const SimTime instant = std::min(next_tick_, next_environment_);
    if (instant <= recovery_->reached) {
      run_instant(instant);
      continue;
    }
    for (const MediumEvent& event : medium_.advance_to(recovery_->reached)) publish_event(event);
    if (!take_next_step(now)) break;
  }
  if (recovery_ && !recovery_->took_present) return false;
  if (recovery_ && waits_for_terrain(now.steady)) return false;
  if (recovery_) {
    bus().log().info("resumed", "said_late=" + std::to_string(recovery_->said_late));
    recovery_.reset();
    journal_.end_recovery();
  }
  return true;
}

void ChannelServerNode::begin_recovery(const bus::Now& now) {
  if (!journal_.resume(now.sim)) return recovery_.reset();
  recovery_->begun = true;
  recovery_->hear_until = now.steady + bus::CrashJournal::kRepairTime;
  recovery_->patience_ends = now.steady + kTerrainPatience;
  recovery_->reached = recovery_->steps.front().at;
  journal_.redo_step(recovery_->reached);
}

bool ChannelServerNode::waits_for_terrain(SimTime steady) const {
  const bool waits = !surveyed_pairs_.empty() && !asker_.is_away() && steady < recovery_->patience_ends;
  if (waits) recovery_->wake = recovery_->patience_ends;
  return waits;
}

// The last step is the present one: what was heard by now, once repair has had its time. False when there is
// none (yet).
bool ChannelServerNode::take_next_step(const bus::Now& now) {
  if (recovery_->steps.empty() && !recovery_->took_present) {
    recovery_->wake = recovery_->hear_until;
    if (now.steady < recovery_->hear_until) return false;
    journal_.write_inputs(now.sim);
    // Heard before the water passes: nothing of it was too late when it was said.
    recovery_->steps.push_back({std::max(now.sim, *journal_.last_step()), std::exchange(inbox_, {})});
    recovery_->took_present = true;
  }
  if (recovery_->steps.empty()) return false;
  Recovery::Step step = std::move(recovery_->steps.front());
  recovery_->steps.pop_front();
  recovery_->reached = step.at;
  journal_.redo_step(step.at);
  Inbox present = std::exchange(inbox_, std::move(step.heard));
  take_heard(step.at);
  inbox_ = std::move(present);
  return true;
}

// In the place of the tables of a tick that has passed.
void ChannelServerNode::survey(SimTime tick) {
  for (const RayQueryClient::SurveyId dropped : asker_.begin_tick()) surveyed_pairs_.erase(dropped);
  if (propagation_->uses_bottom()) ask_for_profiles(place_all(fleet_, tick));
}

}  // namespace halocline::channel_server
