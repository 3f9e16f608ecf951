// SPDX-License-Identifier: BSD-3-Clause
#include "bus/repair/session_watch.h"

#include <algorithm>

#include "bus/transport/node_identity.h"

namespace halocline::bus {

bool SessionWatch::is_recent(SimTime steady, const Times& times, std::int64_t session, SimDuration memory) {
  const auto found = times.find(session);
  return found != times.end() && steady - found->second < memory;
}

void SessionWatch::note(SimTime steady, Times& times, std::int64_t session) {
  constexpr std::size_t kMaxSessions = 4096;
  if (times.size() >= kMaxSessions) forget_silent(steady, times);
  if (times.size() < kMaxSessions || times.contains(session)) times[session] = steady;
}

void SessionWatch::forget_silent(SimTime steady, Times& times) {
  std::erase_if(times, [&](const auto& entry) { return steady - entry.second >= kDuplicatePublisherMemory; });
}

bool SessionWatch::holds(SimTime steady, std::string_view name, std::int64_t session) {
  const auto found = holders_.find(name);
  if (found == holders_.end()) {
    if (holders_.size() < kMaxNames) holders_.emplace(name, Holder{session, steady});
    return true;
  }
  Holder& holder = found->second;
  const bool is_alive = steady - holder.heard < kSilence || is_recent(steady, heartbeats_, holder.session);
  if (holder.session != session && is_alive) return false;
  holder = {session, steady};
  return true;
}

// A session that is accepted under one name does not become a duplicate because another name is claimed with
// it: anybody may claim a name.
bool SessionWatch::on_heartbeat(SimTime steady, std::string_view node, std::int64_t session) {
  if (holds(steady, node, session)) {
    if (!heartbeats_.contains(session)) {
      forget_silent(steady, heartbeats_);
      forget_silent(steady, duplicate_publishers_);
    }
    note(steady, heartbeats_, session);
    duplicate_publishers_.erase(session);
    return true;
  }
  if (!is_recent(steady, heartbeats_, session)) note(steady, duplicate_publishers_, session);
  return false;
}

bool SessionWatch::decides(SimTime steady, std::int32_t receiver, std::int64_t session) {
  if (receiver == 0) return !refused_outcomes_.contains(session);
  const bool is_holder = holds(steady, "OUTCOME." + std::to_string(receiver), session);
  if (is_holder) {
    refused_outcomes_.erase(session);
  } else {
    note(steady, refused_outcomes_, session);
  }
  return is_holder;
}

// Programs derive the session of the packets that they send for a vehicle from their own session.
bool SessionWatch::is_of_duplicate_publisher(SimTime steady, std::string_view channel,
                                             std::int64_t session) const {
  constexpr std::size_t kMaxCompared = 256;  // bounds the hashing in a flood of forged publishers
  if (session == 0 || duplicate_publishers_.empty()) return false;
  if (is_recent(steady, duplicate_publishers_, session, kDuplicatePublisherMemory)) return true;
  const auto sender = std::find_if(kSent.begin(), kSent.end(),
                                   [&](const Family& family) { return channel.starts_with(family.prefix); });
  if (sender == kSent.end() || duplicate_publishers_.size() > kMaxCompared) return false;
  const std::string_view vehicle = channel.substr(sender->prefix.size());
  return std::any_of(duplicate_publishers_.begin(), duplicate_publishers_.end(), [&](const auto& duplicate) {
    return steady - duplicate.second < kDuplicatePublisherMemory &&
           session_of(static_cast<std::uint64_t>(duplicate.first), vehicle) == session;
  });
}

bool SessionWatch::on_message(SimTime steady, std::string_view channel, std::int64_t session,
                              std::optional<std::int32_t> receiver) {
  constexpr std::string_view kStatus = channels::kStatus.prefix;
  if (session != 0 && channel.starts_with(kStatus))
    return on_heartbeat(steady, channel.substr(kStatus.size()), session);
  if (is_of_duplicate_publisher(steady, channel, session)) return false;
  if (receiver) return decides(steady, *receiver, session);
  const bool is_held = std::any_of(kHeld.begin(), kHeld.end(),
                                   [&](const Family& family) { return channel.starts_with(family.prefix); });
  return !is_held || holds(steady, channel, session);
}

}  // namespace halocline::bus
