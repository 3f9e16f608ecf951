// SPDX-License-Identifier: BSD-3-Clause
// Queries of clients that wait for an answer.
#pragma once

#include <algorithm>
#include <deque>

namespace halocline::channel_server {

// Whether the query is a repetition of one that waits: of the same client, with the same request_id.
template <class Waiting, class Query>
bool is_among(const std::deque<Waiting>& waiting, const Query& query) {
  return std::any_of(waiting.begin(), waiting.end(), [&](const Waiting& one) {
    return one.reply.client == query.client && one.reply.request_id == query.request_id;
  });
}

}  // namespace halocline::channel_server
