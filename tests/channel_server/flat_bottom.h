// SPDX-License-Identifier: BSD-3-Clause
// A bathymetry service over a bottom of the test's own.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "bus/bus.h"
#include "bus/messages/channels.h"
#include "bus/runtime/node.h"

namespace halocline::channel_server::testing {

namespace channels = bus::channels;

// Answers RAY_QUERY over a flat bottom, or over any: every way free.
class FlatBottom {
 public:
  using DepthAt = std::function<double(double north_m, double east_m)>;

  FlatBottom(lcm::LCM& lcm, double bottom_z_m)
      : FlatBottom(lcm, [bottom_z_m](double, double) { return bottom_z_m; }) {}
  FlatBottom(lcm::LCM& lcm, DepthAt bottom_z_m)
      : bus_(lcm, {"bathymetry", 11}), bottom_z_m_(std::move(bottom_z_m)) {
    bus_.subscribe<ray_query_t>(channels::kRayQuery, [this](const ray_query_t& query) { on_query(query); });
  }
  void set_away(bool away) { away_ = away; }
  // Keeps queries from now on, until release().
  void hold() { holds_ = true; }
  void release() {
    holds_ = false;
    for (const ray_query_t& query : std::exchange(held_, {})) answer(query);
  }
  void set_terrain(const std::string& version) { terrain_ = version; }
  const std::vector<ray_query_t>& queries() const { return queries_; }

 private:
  void on_query(const ray_query_t& query) {
    queries_.push_back(query);
    if (away_) return;
    if (holds_) {
      held_.push_back(query);
    } else {
      answer(query);
    }
  }
  void answer(const ray_query_t& query) {
    ray_reply_t reply{};
    reply.utime = query.utime;
    reply.session = 11;
    reply.request_id = query.request_id;
    reply.terrain_version = terrain_;
    for (const auto& place : query.offset_m) {
      if (query.query_mode == ray_query_t::DEPTH_TILES) {
        for (int i = 0; i < 64; ++i)
          reply.result_m.push_back(bottom_z_m_(place[0] + query.sample_spacing_m * (i / 8),
                                               place[1] + query.sample_spacing_m * (i % 8)));
      } else {
        reply.result_m.push_back(query.query_mode == ray_query_t::DEPTH ? bottom_z_m_(place[0], place[1])
                                                                        : 0);
      }
    }
    reply.num_rays = static_cast<std::int32_t>(reply.result_m.size());
    reply.ray_status.assign(reply.result_m.size(),
                            query.query_mode == ray_query_t::OCCLUDED ? ray_reply_t::MISS : ray_reply_t::HIT);
    bus_.publish(channels::kRayReply.of(query.client_name), reply);
  }

  bus::Bus bus_;
  DepthAt bottom_z_m_;
  bool away_ = false, holds_ = false;
  std::vector<ray_query_t> held_;
  std::string terrain_ = "flat-1";
  std::vector<ray_query_t> queries_;
};

}  // namespace halocline::channel_server::testing
