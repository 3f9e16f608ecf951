// SPDX-License-Identifier: BSD-3-Clause
// Pending queries to a channel server and a bathymetry service: each is repeated every second and fails after
// kPatience_s. A reply is matched by the number of its request. Steady time is passed in.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "bus/messages/message_codec.h"
#include "bus/messages/messages.h"
#include "viewer/sources/handover.h"

namespace halocline::monitor {

class QueryDesk {
 public:
  static constexpr double kPatience_s = 10;
  static constexpr std::size_t kMaxUnderWay = 64;
  using Post = std::function<void(const std::string& channel, bus::Bytes bytes)>;
  // Receives the reply; null when there is none, and `problem` is then a sentence.
  using LinkDone = std::function<void(const link_reply_t* reply, const std::string& problem)>;
  using TileDone = std::function<void(const terrain_tile_t* tile, const std::string& problem)>;

  // Replies arrive on the channels of `client`.
  QueryDesk(std::string client, Post post) : client_(std::move(client)), post_(std::move(post)) {}

  void ask(link_query_t query, LinkDone done);
  void ask(terrain_query_t query, TileDone done);
  bool is_reply(std::string_view channel) const;
  void take(const BusMessage& reply);
  void tick(double steady_s);

 private:
  struct Query {
    std::string channel;
    bus::Bytes bytes;
    LinkDone link_done;
    TileDone tile_done;
    double begun_s = 0, posted_s = 0;
  };
  void begin(Query query);
  static void fail(const Query& query, const std::string& problem);

  std::string client_;
  Post post_;
  double now_s_ = 0;
  std::int64_t last_id_ = 0;
  std::map<std::int64_t, Query> under_way_;  // key: number of the request
};

}  // namespace halocline::monitor
