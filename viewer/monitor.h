// SPDX-License-Identifier: BSD-3-Clause
// Monitor: a source of messages, the connected pages, and the loop between them.
#pragma once

#include <functional>
#include <iosfwd>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "core/sim_time.h"
#include "runs/foxglove/foxglove_session.h"
#include "viewer/monitor_options.h"
#include "viewer/pages/command_desk.h"
#include "viewer/pages/packet_json.h"
#include "viewer/pages/page_session.h"
#include "viewer/pages/playback.h"
#include "viewer/pages/query_desk.h"
#include "viewer/sources/source.h"
#include "viewer/web/web_server.h"

namespace halocline::monitor {

class Monitor {
 public:
  // Opens the source and listens. Throws InvalidArgument for options that cannot be satisfied.
  explicit Monitor(const MonitorOptions& options);

  std::string url() const { return server_->url(); }
  // Serves connections for one tick, and passes new messages to the pages.
  void tick();

 private:
  void open(ConnectionId id, WebProtocol protocol);
  // Returns false when the time for requests of this tick is spent; the message is then delivered again
  // later.
  bool receive(ConnectionId id, std::string_view message);
  void answer(ConnectionId id, PageSession& session, std::string_view message);
  // Begins a request that is answered later. Returns false for any other request.
  bool begin(ConnectionId id, PageSession& session, const nlohmann::json& request);
  void begin_terrain(ConnectionId id, PageSession& session, const nlohmann::json& request);
  void begin_command(ConnectionId id, const nlohmann::json& request);
  void begin_link(ConnectionId id, const nlohmann::json& request);
  void finish(ConnectionId id, nlohmann::json reply);
  // Queries the overview of the terrain, which the bathymetry service publishes only once, perhaps before
  // this program started.
  void request_overview(double now_s);
  void tick_pages(double now_s);
  void tick_foxgloves(double now_s);
  void start_again();

  std::unique_ptr<Source> source_;
  bool may_command_;
  QueryDesk queries_;
  int run_;
  double overview_due_s_ = 0;  // next query of the overview, steady time
  CommandDesk commands_;
  PacketIndex packets_;
  std::map<ConnectionId, PageSession> pages_;
  struct Foxglove {
    clients::FoxgloveSession session;
    Playback playback;
  };
  std::map<ConnectionId, Foxglove> foxgloves_;
  SimDuration request_time_;           // time spent in this tick
  std::unique_ptr<WebServer> server_;  // last member: its callbacks use the others
};

// Prints the URL to `out` and serves until `should_stop` returns true (it is called at least every 0.1 s), or
// until the run whose network is shown has ended.
void run_monitor(MonitorOptions options, std::ostream& out, const std::function<bool()>& should_stop);

}  // namespace halocline::monitor
