// SPDX-License-Identifier: BSD-3-Clause
// Which of several publishers of one name is believed, on a bus that anybody may publish on.
//
// A node has one publisher at a time (HEARTBEAT.<node>, STATUS.<node>), and so has each channel of kHeld. Its
// session is kept until nothing was heard of it for kSilence: no heartbeat of the session, and no message on
// the channel. Until then another session of that name is a rival: its messages on all channels are refused,
// and the packets of the vehicles that it speaks for (session_of its session and a vehicle's name). A
// restarted process is taken up at once when the one before has been silent so long; what it published
// meanwhile is repaired (flow_repair.h). A publisher without heartbeats keeps its channels by publishing once
// in kSilence. OUTCOME is of one publisher for each receiver, because channel servers share the receivers
// (shards). A row of several receivers, which every shard publishes, is refused from whoever was last refused
// one of a single receiver.
//
// Pure: values in, values out; `steady` is the caller's steady time, never set back. Bounded: of names beyond
// kMaxNames every session is believed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "bus/channels.h"
#include "core/hash.h"
#include "core/limits.h"
#include "core/sim_time.h"

namespace halocline::bus {

class SessionWatch {
 public:
  // Four heartbeats.
  static constexpr SimDuration kSilence = SimDuration::from_milliseconds(1000);
  // A rival is one for so long after its last heartbeat or STATUS, which comes once a second.
  static constexpr SimDuration kRivalMemory = SimDuration::from_milliseconds(2500);
  static constexpr std::size_t kMaxNames = 4 * kMaxVehicles;
  // Their channels are of one publisher each.
  static constexpr std::array kHeld{channels::kState, channels::kReceipt, channels::kReceive};

  // Their sessions are made of those of the programs that send (session_of).
  static constexpr std::array kSent{channels::kSend, channels::kListen};

  // HEARTBEAT.<node> of a session. False: of a rival.
  bool on_heartbeat(SimTime steady, std::string_view node, std::int64_t session);
  // A message on any channel, of a session or of none (0); of an OUTCOME with its receiver, 0 of several.
  // False: of a rival.
  bool on_message(SimTime steady, std::string_view channel, std::int64_t session,
                  std::optional<std::int32_t> receiver = {});

 private:
  struct Holder {
    std::int64_t session = 0;
    SimTime heard;
  };
  using Times = std::unordered_map<std::int64_t, SimTime>;  // by session
  static bool is_recent(SimTime steady, const Times& times, std::int64_t session,
                        SimDuration memory = kSilence);
  static void forget_silent(SimTime steady, Times& times);
  static void note(SimTime steady, Times& times, std::int64_t session);
  bool holds(SimTime steady, std::string_view name, std::int64_t session);
  bool decides(SimTime steady, std::int32_t receiver, std::int64_t session);
  bool is_of_rival(SimTime steady, std::string_view channel, std::int64_t session) const;

  std::unordered_map<std::string, Holder, TextHash, std::equal_to<>> holders_;  // by node, by channel
  Times heartbeats_,
      rivals_;              // of the nodes that are believed, and of those that are not: the last heartbeat
  Times refused_outcomes_;  // of those that were last refused the outcome of a receiver
};

}  // namespace halocline::bus
