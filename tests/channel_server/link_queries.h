// SPDX-License-Identifier: BSD-3-Clause
// LINK_QUERY messages for tests.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "bus/messages/messages.h"

namespace halocline::channel_server::testing {

inline link_end_t at(double north_m, double depth_m) {
  link_end_t end{};
  end.position_ned_m[0] = north_m;
  end.position_ned_m[2] = depth_m;
  return end;
}

inline link_end_t named(const std::string& vehicle) {
  link_end_t end{};
  end.vehicle_name = vehicle;
  return end;
}

// Of the links from each first end to the second.
inline link_query_t link_query(const std::vector<std::pair<link_end_t, link_end_t>>& links,
                               std::int64_t request_id) {
  link_query_t query{};
  query.client_name = "tester";
  query.request_id = request_id;
  query.num_links = static_cast<std::int32_t>(links.size());
  for (const auto& [from, to] : links) {
    query.transmitters.push_back(from);
    query.receivers.push_back(to);
  }
  return query;
}

}  // namespace halocline::channel_server::testing
