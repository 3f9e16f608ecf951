// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/monitor.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <iostream>
#include <optional>
#include <ostream>
#include <utility>

#include <unistd.h>

#include "bus/runtime/node_process.h"
#include "core/check.h"
#include "runs/timeline/run_timeline.h"
#include "viewer/pages/binary_messages.h"
#include "viewer/pages/link_view.h"
#include "viewer/pages/request_fields.h"
#include "viewer/pages/requests.h"
#include "viewer/pages/run_json.h"
#include "viewer/pages/terrain_window.h"
#include "viewer/run_network.h"
#include "viewer/sources/bus_source.h"
#include "viewer/sources/handover.h"
#include "viewer/sources/log_source.h"
#include "viewer/web/web_server_socket.h"

namespace halocline::monitor {
namespace {

using nlohmann::json;

constexpr std::chrono::milliseconds kTick{50};
// Time that the requests of all pages together may take in a tick.
constexpr SimDuration kRequestTime = SimDuration::from_milliseconds(25);

std::unique_ptr<Source> open_source(const MonitorOptions& options) {
  if (!options.logs.empty()) return std::make_unique<LogSource>(options.logs, options.scenario);
  return std::make_unique<BusSource>(options.lcm_url, options.accept,
                                     SimDuration::from_seconds(options.history_s));
}

}  // namespace

Monitor::Monitor(const MonitorOptions& options)
    : source_(open_source(options)),
      may_command_(options.may_command),
      queries_(
          "monitor-" + std::to_string(::getpid()),
          [this](const std::string& channel, bus::Bytes bytes) { source_->post(channel, std::move(bytes)); }),
      run_(source_->run()),
      commands_(
          bus::wall_now().to_utime(),
          [this](const std::string& channel, bus::Bytes bytes) { source_->post(channel, std::move(bytes)); }),
      server_(open_web_server(
          options.web, {.opened = [this](ConnectionId id, WebProtocol protocol) { open(id, protocol); },
                        .received = [this](ConnectionId id, std::string_view message,
                                           bool) { return receive(id, message); },
                        .closed =
                            [this](ConnectionId id) {
                              pages_.erase(id);
                              foxgloves_.erase(id);
                            }})) {
  source_->set_replies([this](std::string_view channel) { return queries_.is_reply(channel); });
}

void Monitor::tick() {
  request_time_ = SimDuration();
  server_->resume();
  server_->run_for(kTick);
  source_->update();
  if (source_->run() != run_) start_again();
  const double now_s = bus::steady_now().seconds();
  for (const BusMessage& reply : source_->take_replies()) queries_.take(reply);
  queries_.tick(now_s);
  request_overview(now_s);
  commands_.tick(now_s, source_->timeline(), source_->now());
  tick_pages(now_s);
  tick_foxgloves(now_s);
}

void Monitor::request_overview(double now_s) {
  constexpr double kPause_s = QueryDesk::kPatience_s + 2;
  const bool is_wanted = !source_->is_log() && !source_->timeline().terrain() && now_s >= overview_due_s_;
  if (!is_wanted || !source_->state().bathymetry) return;
  overview_due_s_ = now_s + kPause_s;
  collect_overview(queries_, [this, run = run_](const terrain_tile_t& overview) {
    if (run == run_ && overview.post_spacing_m > 0) source_->set_terrain(overview);
  });
}

void Monitor::tick_pages(double now_s) {
  for (auto& [id, page] : pages_) page.tick(now_s, server_->is_idle(id), packets_);
}

void Monitor::tick_foxgloves(double now_s) {
  const clients::RunTimeline& timeline = source_->timeline();
  for (auto& [id, client] : foxgloves_) {
    client.playback.advance(now_s, timeline.begin(), source_->now());
    client.session.tick(now_s, server_->is_idle(id), timeline, client.playback.at());
  }
}

void Monitor::start_again() {
  run_ = source_->run();
  packets_ = PacketIndex();
  // The pages connect again by themselves.
  while (!pages_.empty()) server_->close(pages_.begin()->first);
  while (!foxgloves_.empty()) server_->close(foxgloves_.begin()->first);
}

void Monitor::open(ConnectionId id, WebProtocol protocol) {
  const auto send = [this, id](std::string message, bool binary) {
    server_->send(id, std::make_shared<const std::string>(std::move(message)), binary);
  };
  if (protocol == WebProtocol::kMonitor) {
    pages_.try_emplace(id, *source_, may_command_, send);
    return;
  }
  Foxglove client{clients::FoxgloveSession("Halocline: " + source_->name(), send),
                  Playback(!source_->is_log())};
  client.playback.play(source_->timeline().begin(), source_->now());
  foxgloves_.emplace(id, std::move(client));
}

bool Monitor::receive(ConnectionId id, std::string_view message) {
  if (request_time_ >= kRequestTime) return false;
  const SimTime begin = bus::steady_now();
  const auto page = pages_.find(id);
  if (page != pages_.end()) answer(id, page->second, message);
  const auto foxglove = foxgloves_.find(id);
  if (foxglove != foxgloves_.end()) foxglove->second.session.take(message);
  request_time_ = request_time_ + (bus::steady_now() - begin);
  return true;
}

void Monitor::answer(ConnectionId id, PageSession& session, std::string_view message) {
  json reply = {{"type", "reply"}, {"id", nullptr}, {"ok", true}};
  try {
    const json request = json::parse(message);
    reply["id"] = request_id(request);
    if (begin(id, session, request)) return;
    if (!session.take(request)) reply.update(answer_request(source_->timeline(), packets_, request));
  } catch (const std::exception& problem) {
    reply["ok"] = false;
    reply["error"] = problem.what();
  }
  session.send(reply);
}

bool Monitor::begin(ConnectionId id, PageSession& session, const json& request) {
  const std::string ask = text_in(request, "ask");
  if (ask == "terrain") begin_terrain(id, session, request);
  if (ask == "link") begin_link(id, request);
  if (ask == "command" || ask == "send") begin_command(id, request);
  return ask == "terrain" || ask == "link" || ask == "command" || ask == "send";
}

void Monitor::finish(ConnectionId id, json reply) {
  const auto page = pages_.find(id);
  if (page == pages_.end()) return;
  reply["type"] = "reply";
  if (!reply.contains("ok")) reply["ok"] = true;
  page->second.send(reply);
}

void Monitor::begin_terrain(ConnectionId id, PageSession& session, const json& request) {
  if (!request.contains("rows")) {
    const auto grid = overview_grid(source_->timeline());
    require(grid.has_value(), "no terrain is known: the bathymetry service has not answered");
    session.send({{"type", "reply"}, {"id", request["id"]}, {"ok", true}});
    return session.send_binary(terrain_frame(*grid, request["id"]));
  }
  collect_terrain(queries_, terrain_window_in(request),
                  [this, id, number = request["id"]](const DepthGrid* grid, const std::string& problem) {
                    if (grid == nullptr)
                      return finish(id, {{"id", number}, {"ok", false}, {"error", problem}});
                    finish(id, {{"id", number}});
                    const auto page = pages_.find(id);
                    if (page != pages_.end()) page->second.send_binary(terrain_frame(*grid, number));
                  });
}

void Monitor::begin_command(ConnectionId id, const json& request) {
  require(!source_->is_log(), "a log takes no commands");
  require(may_command_, "commands are not allowed: start halocline-monitor with --allow-commands");
  const json number = request["id"];
  if (request["ask"] == "command") {
    commands_.command(source_->timeline(), request);
    return finish(id, {{"id", number}});
  }
  commands_.send(source_->timeline(), request, source_->now(), [this, id, number](const std::string& key) {
    finish(id, {{"id", number}, {"key", key.empty() ? json() : json(key)}});
  });
}

void Monitor::begin_link(ConnectionId id, const json& request) {
  const clients::RunTimeline& timeline = source_->timeline();
  const std::size_t from = vehicle_in(timeline, request, "from").index,
                    to = vehicle_in(timeline, request, "to").index;
  require(from != to, "from and to are one vehicle");
  const SimTime at = SimTime::from_seconds(number_in(request, "time_s", -9e9, 9e9));
  const auto finish_link = [this, id, from, to, at, number = request["id"], run = run_](
                               const link_reply_t* reply, const std::string& problem) {
    const auto& vehicles = source_->timeline().vehicles();
    if (run != run_ || std::max(from, to) >= vehicles.size()) return;
    const auto& modem = vehicles[from].modem;
    const LinkSubject link{vehicles[from], vehicles[to], at,
                           modem ? source_->threshold_db(*modem) : std::nullopt};
    json view = link_view_json(source_->timeline(), packets_, link, reply, problem);
    view["id"] = number;
    finish(id, std::move(view));
  };
  auto query = link_query({timeline.vehicles()[from], timeline.vehicles()[to], at});
  if (!query) return finish_link(nullptr, "One of the two had no state at that time.");
  if (const auto limits = source_->limits(); !limits.empty()) return finish_link(nullptr, limits.front());
  const bool is_past = source_->now() - at > SimDuration::from_milliseconds(2000);
  if (source_->names_stand_for_now() && is_past) use_positions(timeline, *query);
  queries_.ask(std::move(*query), finish_link);
}

void run_monitor(MonitorOptions options, std::ostream& out, const std::function<bool()>& should_stop) {
  options.web.socket = listening_socket(options.web.access);  // before the run's network is entered
  const RunNetwork network(options.network);
  Monitor monitor(options);
  out << monitor.url() << std::endl;  // flushed: a script waits for it
  while (!should_stop() && !network.has_ended()) monitor.tick();
  if (network.has_ended()) std::cerr << "halocline-monitor: the run has ended" << std::endl;
}

}  // namespace halocline::monitor
