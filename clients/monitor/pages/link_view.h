// SPDX-License-Identifier: BSD-3-Clause
// One link in detail: the query for its paths, and what a page is shown of the reply (README.md, `link`).
// Pure.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "bus/messages.h"
#include "clients/mission/mission_store.h"
#include "clients/mission/mission_vehicle.h"
#include "clients/monitor/pages/packet_json.h"
#include "core/sim_time.h"

namespace halocline::monitor {

struct LinkSubject {
  const clients::MissionVehicle& from;
  const clients::MissionVehicle& to;
  SimTime at;
  std::optional<double> threshold_db = {};  // SINR that the sender's modem needs
};

// Both ends by name and by where they were. Empty when one of them had no state then.
std::optional<link_query_t> link_query(const LinkSubject& link);
// The same for positions of the past: without names, which stand for the present.
void use_positions(const clients::MissionStore& mission, link_query_t& query);

// `reply` is null where there is none; `problem` is then the notice.
nlohmann::json link_view_json(const clients::MissionStore& mission, PacketIndex& packets,
                              const LinkSubject& link, const link_reply_t* reply, const std::string& problem);

}  // namespace halocline::monitor
