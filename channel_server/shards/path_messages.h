// SPDX-License-Identifier: BSD-3-Clause
// Conversion of eigenray searches to messages and back, exact to the last bit.
#pragma once

#include <cstdint>
#include <optional>

#include "bus/messages/messages.h"
#include "channel_server/propagation/path_search.h"

namespace halocline::channel_server {

// Returns the message of a search; empty when the message cannot hold it (lcmtypes/link_search_t.lcm). The
// search must not be over a bottom that was given with the query.
std::optional<link_search_t> to_message(std::int64_t sea_hash, const PathQuery& query,
                                        const SearchResult& found);

// Returns the part of a query that is the same for every server; water and seabed are identified by the
// message's sea_hash.
PathQuery to_query(const link_search_t& message);
SearchResult to_result(const link_search_t& message);

}  // namespace halocline::channel_server
