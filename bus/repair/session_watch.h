// SPDX-License-Identifier: BSD-3-Clause
// Arbiter of duplicate publishers: decides which of several publishers of one name is accepted, on a bus that
// anybody may publish on.
//
// A node has one publisher at a time (HEARTBEAT.<node>, STATUS.<node>), and so has each channel of kHeld. The
// accepted session is kept until nothing has been heard of it for kSilence: no heartbeat of the session, and
// no message on the channel. Until then another session of that name is a duplicate publisher. Its messages
// on all channels are refused, and so are the packets of the vehicles that it sends for (session_of its
// session and a vehicle's name).
//
// A restarted process is accepted as soon as its predecessor has been silent for kSilence; the messages that
// it published meanwhile are repaired (flow_repair.h). A publisher without heartbeats keeps its channels by
// publishing at least once in kSilence.
//
// OUTCOME has one publisher for each receiver, because channel servers share the receivers (shards). An
// OUTCOME for several receivers, which every shard publishes, is refused from a session whose last OUTCOME
// for a single receiver was refused.
//
// The class has no side effects: values in, values out. `steady` is the caller's steady time, which never
// decreases. Memory is bounded: beyond kMaxNames names every session is accepted.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "bus/messages/channels.h"
#include "core/hash.h"
#include "core/limits.h"
#include "core/sim_time.h"

namespace halocline::bus {

class SessionWatch {
 public:
  // Four heartbeat periods.
  static constexpr SimDuration kSilence = SimDuration::from_milliseconds(1000);
  // A duplicate publisher is remembered for this long after its last heartbeat or STATUS; STATUS comes once a
  // second.
  static constexpr SimDuration kDuplicatePublisherMemory = SimDuration::from_milliseconds(2500);
  static constexpr std::size_t kMaxNames = 4 * kMaxVehicles;
  // Channel families with one publisher for each channel.
  static constexpr std::array kHeld{channels::kState, channels::kReceipt, channels::kReceive};

  // Channel families whose sessions are derived from those of the sending programs (session_of).
  static constexpr std::array kSent{channels::kSend, channels::kListen};

  // Processes HEARTBEAT.<node>. Returns false for a duplicate publisher.
  bool on_heartbeat(SimTime steady, std::string_view node, std::int64_t session);
  // Processes a message on any channel. `session` is 0 if it has none; `receiver` is that of an OUTCOME, 0
  // for several receivers. Returns false for a duplicate publisher.
  bool on_message(SimTime steady, std::string_view channel, std::int64_t session,
                  std::optional<std::int32_t> receiver = {});

 private:
  struct Holder {
    std::int64_t session = 0;
    SimTime heard;
  };
  using Times = std::unordered_map<std::int64_t, SimTime>;  // keyed by session
  static bool is_recent(SimTime steady, const Times& times, std::int64_t session,
                        SimDuration memory = kSilence);
  static void forget_silent(SimTime steady, Times& times);
  static void note(SimTime steady, Times& times, std::int64_t session);
  bool holds(SimTime steady, std::string_view name, std::int64_t session);
  bool decides(SimTime steady, std::int32_t receiver, std::int64_t session);
  bool is_of_duplicate_publisher(SimTime steady, std::string_view channel, std::int64_t session) const;

  std::unordered_map<std::string, Holder, TextHash, std::equal_to<>> holders_;  // keyed by node or channel
  // Last heartbeats of accepted nodes and of duplicate ones.
  Times heartbeats_, duplicate_publishers_;
  Times refused_outcomes_;  // sessions whose last OUTCOME for a receiver was refused
};

}  // namespace halocline::bus
