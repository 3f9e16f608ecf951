// SPDX-License-Identifier: BSD-3-Clause
// Conversion to messages and back of link tables, link queries, best-place queries and ray queries, with
// their replies.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "bus/messages/messages.h"
#include "channel_server/links/best_place_service.h"
#include "channel_server/links/link_query_service.h"
#include "channel_server/links/link_table.h"
#include "channel_server/links/ray_query_client.h"
#include "channel_server/propagation/seabed_map.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

link_t to_message(const LinkRow& row);
// Returns the messages of a table. A table with more than kMaxPeers rows is split into parts, in the order of
// receivers; one without rows is a single message.
inline constexpr std::size_t kMaxPeers = 240;  // rows of one link_table_t, 58 kB
std::vector<link_table_t> to_messages(const LinkTable& table, SimTime at);

// Returns a query; an end that cannot be read (a modem with a NaN) states its problem.
LinkQuery to_query(const link_query_t& message);
link_reply_t to_message(const LinkReply& reply);

BestPlaceQuery to_query(const best_place_query_t& message);
best_place_reply_t to_message(const BestPlaceReply& reply);

ray_query_t to_message(const RayQueryBatch& batch, std::string_view client, SimTime asked_at);
std::vector<RayAnswer> to_answers(const ray_reply_t& message);

}  // namespace halocline::channel_server
