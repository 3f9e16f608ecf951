// SPDX-License-Identifier: BSD-3-Clause
// Detailed view of one link: the query for its paths, and the JSON of the reply for a page (viewer/README.md,
// `link`).
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "bus/messages/messages.h"
#include "core/sim_time.h"
#include "runs/timeline/run_timeline.h"
#include "runs/timeline/vehicle_record.h"
#include "viewer/pages/packet_json.h"

namespace halocline::monitor {

struct LinkSubject {
  const clients::VehicleRecord& from;
  const clients::VehicleRecord& to;
  SimTime at;
  std::optional<double> threshold_db = {};  // SINR at which half of the sender's packets survive, dB
};

// Returns a query with names and past positions of both ends; nothing when one of them had no state at that
// time.
std::optional<link_query_t> link_query(const LinkSubject& link);
// Removes the names from a query about the past, because names refer to the present, and gives the modems
// explicitly.
void use_positions(const clients::RunTimeline& timeline, link_query_t& query);

// Returns the view. `reply` is null when there is none; `problem` is then shown as the notice.
nlohmann::json link_view_json(const clients::RunTimeline& timeline, PacketIndex& packets,
                              const LinkSubject& link, const link_reply_t* reply, const std::string& problem);

}  // namespace halocline::monitor
