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
using Kind = bus::JournalledMessage::Kind;

// How far back the journal reaches. Sound has gone 90 km by then; what is under way for longer is not taken
// up, nor is anything after a longer absence.
constexpr SimDuration kRemembered = SimDuration::from_milliseconds(60'000);
// A time further before the journal's end than this belongs to another run.
constexpr SimDuration kSameRun = SimDuration::from_milliseconds(10'000);
// What was said while nobody listened shows by heartbeats, four a second, and comes within two requests.
constexpr SimDuration kRepairPatience = SimDuration::from_milliseconds(500);
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
  journal_ = std::make_unique<bus::MessageJournal>(bus::MessageJournal::Rule{
      path, kRemembered, {channels::kModem}, {std::string(channels::kSetEnvironment)}});
  auto entries = journal_->take_inherited();
  if (!entries.empty()) {
    recovery_ = std::make_unique<Recovery>();
    recovery_->last = entries.back().at;
  }
  bool after_absence = false;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    bus::JournalledMessage& entry = entries[i];
    const SimTime at = entry.at;
    after_absence = after_absence || entry.kind == Kind::kHeardAfterAbsence;
    entry.kind == Kind::kSaid ? recovery_->said.push_back(std::move(entry))
                              : bus().replay(entry.channel, entry.bytes);
    if (i + 1 < entries.size() && entries[i + 1].at == at) continue;
    // What was due before a step happened before it heard.
    if (!std::exchange(after_absence, false)) recovery_->steps.push_back({at - kInstant, {}});
    recovery_->steps.push_back({at, std::exchange(inbox_, {})});
  }
  bus().set_tap([this](std::string_view channel, const void* data, std::size_t size) {
    if (is_remembered(channel)) journal_->hear(channel, data, size);
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
  }
  return true;
}

void ChannelServerNode::begin_recovery(const bus::Now& now) {
  const SimTime last = recovery_->last;
  if (now.sim < last - kSameRun || now.sim > last + kRemembered) {
    bus().log().info("journal-of-another-run", "last_t=" + std::to_string(last.seconds()));
    journal_->clear();
    return recovery_.reset();
  }
  bus().log().info("resuming", "last_t=" + std::to_string(last.seconds()) +
                                   " steps=" + std::to_string(recovery_->steps.size() / 2));
  recovery_->begun = true;
  recovery_->hear_until = now.steady + kRepairPatience;
  recovery_->patience_ends = now.steady + kTerrainPatience;
  recovery_->reached = recovery_->steps.front().at;
  take_up_said();
}

// What the earlier life said is not said again, its flows go on, and who missed it can still ask for it.
void ChannelServerNode::take_up_said() {
  const auto take = [this]<class Message>(const bus::JournalledMessage& entry, Message message) {
    if (message.decode(entry.bytes.data(), 0, static_cast<int>(entry.bytes.size())) < 0) return;
    said_.insert(name_of_said(entry.channel, message));
    flows_[entry.channel] = {message.session, message.sequence + 1};
    bus().keep_published(entry.channel, message.session, message.sequence, entry.bytes);
  };
  for (const bus::JournalledMessage& entry : recovery_->said) {
    if (entry.channel == channels::kOutcome) take(entry, packet_outcome_t());
    if (entry.channel == channels::kPingAnswer) take(entry, ping_answer_t());
    if (entry.channel.starts_with(channels::kReceipt.prefix)) take(entry, modem_receipt_t());
    if (entry.channel.starts_with(channels::kReceive.prefix)) take(entry, modem_receive_t());
  }
  said_forgotten_at_ = recovery_->last + kRemembered * 2;
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
    journal_->write_heard(now.sim, Kind::kHeardAfterAbsence);
    // Heard before the water passes: nothing of it was too late when it was said.
    recovery_->steps.push_back({std::max(now.sim, recovery_->last), std::exchange(inbox_, {})});
    recovery_->took_present = true;
  }
  if (recovery_->steps.empty()) return false;
  Recovery::Step step = std::move(recovery_->steps.front());
  recovery_->steps.pop_front();
  recovery_->reached = step.at;
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
