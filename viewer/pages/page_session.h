// SPDX-License-Identifier: BSD-3-Clause
// Session of one page: sends positions, packets, links and the state, each when it has changed and no faster
// than the connection accepts it. Messages go to an outbox, and steady time is passed in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/sim_time.h"
#include "viewer/pages/packet_json.h"
#include "viewer/pages/playback.h"
#include "viewer/sources/source.h"

namespace halocline::monitor {

using Outbox = std::function<void(std::string message, bool binary)>;

class PageSession {
 public:
  // Packets that departed within this time before the shown instant are sent at the start.
  static constexpr SimDuration kPacketsShown = SimDuration::from_milliseconds(60'000);

  // `source` must outlive it.
  PageSession(const Source& source, bool may_command, Outbox outbox);

  // Sends what is due at `steady_s`. Frequent messages are sent only when `idle`, that is when the connection
  // has sent everything before.
  void tick(double steady_s, bool idle, PacketIndex& packets);

  // Takes a request that changes what is shown: watch, play, pause, speed, seek, live. Returns false for any
  // other request. Throws InvalidArgument for an invalid one.
  [[nodiscard]] bool take(const nlohmann::json& request);

  SimTime at() const { return playback_.at(); }
  void send(const nlohmann::json& message) {
    outbox_(message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), false);
  }
  void send_binary(std::string bytes) { outbox_(std::move(bytes), true); }

 private:
  void send_state(double steady_s, bool at_once);
  void send_run(double steady_s);
  void send_packets(PacketIndex& packets);
  void send_links(double steady_s, PacketIndex& packets);

  const Source& source_;
  Outbox outbox_;
  Playback playback_;
  std::vector<std::size_t> watched_;  // indices in link_displays()
  bool greets_ = true, may_command_;
  bool state_wanted_ = true;
  double state_sent_s_ = 0, run_seen_s_ = 0, links_seen_s_ = 0;
  nlohmann::json last_state_, last_run_;
  std::string last_frame_;
  std::map<std::size_t, std::string> last_links_;  // frames without their time; key: column
  bool packets_restart_ = true;
  SimTime packets_until_;           // latest departure that was shown
  std::uint64_t packets_seen_ = 0;  // revision of the packet book
};

}  // namespace halocline::monitor
