// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/pages/query_desk.h"

#include <vector>

#include "bus/messages/channels.h"

namespace halocline::monitor {
namespace {

constexpr double kRepeat_s = 1;

}  // namespace

void QueryDesk::ask(link_query_t query, LinkDone done) {
  query.client_name = client_;
  query.request_id = ++last_id_;
  begin({std::string(bus::channels::kLinkQuery), bus::encoded(query), std::move(done), nullptr});
}

void QueryDesk::ask(terrain_query_t query, TileDone done) {
  query.client_name = client_;
  query.request_id = ++last_id_;
  begin({std::string(bus::channels::kTerrainQuery), bus::encoded(query), nullptr, std::move(done)});
}

void QueryDesk::begin(Query query) {
  if (under_way_.size() >= kMaxUnderWay) return fail(query, "Too many requests are under way.");
  query.begun_s = query.posted_s = now_s_;
  post_(query.channel, query.bytes);
  under_way_.emplace(last_id_, std::move(query));
}

void QueryDesk::fail(const Query& query, const std::string& problem) {
  if (query.link_done) query.link_done(nullptr, problem);
  if (query.tile_done) query.tile_done(nullptr, problem);
}

bool QueryDesk::is_reply(std::string_view channel) const {
  return channel == bus::channels::kLinkReply.of(client_) ||
         channel == bus::channels::kTerrainReply.of(client_);
}

void QueryDesk::take(const BusMessage& reply) {
  if (reply.channel == bus::channels::kLinkReply.of(client_)) {
    const auto link = bus::decoded<link_reply_t>(reply.bytes);
    auto query = link ? under_way_.extract(link->request_id) : decltype(under_way_)::node_type();
    if (query.empty() || !query.mapped().link_done) return;
    if (link->reply_status != link_reply_t::OK)
      query.mapped().link_done(nullptr, "The channel server refused: " + link->refusal + ".");
    else
      query.mapped().link_done(&*link, "");
  } else {
    const auto tile = bus::decoded<terrain_tile_t>(reply.bytes);
    auto query = tile ? under_way_.extract(tile->request_id) : decltype(under_way_)::node_type();
    if (query.empty() || !query.mapped().tile_done) return;
    if (tile->tile_status != terrain_tile_t::OK)
      query.mapped().tile_done(nullptr, "The bathymetry service refused: " + tile->refusal + ".");
    else
      query.mapped().tile_done(&*tile, "");
  }
}

void QueryDesk::tick(double steady_s) {
  now_s_ = steady_s;
  std::vector<std::int64_t> expired;
  for (auto& [id, query] : under_way_) {
    if (now_s_ - query.begun_s > kPatience_s) expired.push_back(id);
    if (now_s_ - query.posted_s < kRepeat_s) continue;
    query.posted_s = now_s_;
    post_(query.channel, query.bytes);
  }
  for (const std::int64_t id : expired) {
    const auto query = under_way_.extract(id);
    fail(query.mapped(), query.mapped().link_done ? "The channel server does not answer."
                                                  : "The bathymetry service does not answer.");
  }
}

}  // namespace halocline::monitor
