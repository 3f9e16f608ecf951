// SPDX-License-Identifier: BSD-3-Clause
// Searches for paths as messages and back, exact to the last bit.
#pragma once

#include <cstdint>
#include <optional>

#include "bus/messages.h"
#include "channel_server/propagation/path_search.h"

namespace halocline::channel_server {

// Of a link that is not over a bottom that was given. Empty for what the message cannot hold
// (lcmtypes/link_search_t.lcm).
std::optional<link_search_t> to_message(std::int64_t sea_hash, const PathQuery& query,
                                        const FoundPaths& found);

// The part of a query that is the same for every server: water and seabed are the message's sea.
PathQuery to_query(const link_search_t& message);
FoundPaths to_found(const link_search_t& message);

}  // namespace halocline::channel_server
