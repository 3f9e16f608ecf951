// SPDX-License-Identifier: BSD-3-Clause
// The monitor: a source of messages, the pages that are open, and the loop between them.
#pragma once

#include <functional>
#include <iosfwd>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "clients/foxglove/foxglove_session.h"
#include "clients/monitor/monitor_options.h"
#include "clients/monitor/pages/command_desk.h"
#include "clients/monitor/pages/packet_json.h"
#include "clients/monitor/pages/page_session.h"
#include "clients/monitor/pages/playback.h"
#include "clients/monitor/pages/query_desk.h"
#include "clients/monitor/sources/source.h"
#include "clients/monitor/web/web_server.h"
#include "core/sim_time.h"

namespace halocline::monitor {

class Monitor {
 public:
  // Opens the source and listens. Throws InvalidArgument for options that cannot be met.
  explicit Monitor(const MonitorOptions& options);

  std::string url() const { return server_->url(); }
  // Serves for one tick, and brings what came to the pages.
  void tick();

 private:
  void open(ConnectionId id, WebProtocol protocol);
  // False when the time for requests of this tick is spent.
  bool receive(ConnectionId id, std::string_view message);
  void answer(ConnectionId id, PageSession& session, std::string_view message);
  // Those that are answered later, and by others. False for another request.
  bool begin(ConnectionId id, PageSession& session, const nlohmann::json& request);
  void begin_terrain(ConnectionId id, PageSession& session, const nlohmann::json& request);
  void begin_command(ConnectionId id, const nlohmann::json& request);
  void begin_link(ConnectionId id, const nlohmann::json& request);
  void finish(ConnectionId id, nlohmann::json reply);
  // The terrain is published once: who came later queries it.
  void request_overview(double now_s);
  void tick_pages(double now_s);
  void tick_foxgloves(double now_s);
  void start_again();

  std::unique_ptr<Source> source_;
  bool may_command_;
  QueryDesk queries_;
  int run_;
  double overview_due_s_ = 0;  // steady
  CommandDesk commands_;
  PacketIndex packets_;
  std::map<ConnectionId, PageSession> pages_;
  struct Foxglove {
    clients::FoxgloveSession session;
    Playback playback;
  };
  std::map<ConnectionId, Foxglove> foxgloves_;
  SimDuration request_time_;           // spent in this tick
  std::unique_ptr<WebServer> server_;  // last: its callbacks use the others
};

// Prints the URL to `out` and serves until `should_stop`, which is called at least every 0.1 s, or until the
// run whose network was entered has ended.
void run_monitor(MonitorOptions options, std::ostream& out, const std::function<bool()>& should_stop);

}  // namespace halocline::monitor
