// SPDX-License-Identifier: BSD-3-Clause
// Recognition of repeated queries among those that wait for an answer.
#pragma once

#include <algorithm>
#include <deque>

namespace halocline::channel_server {

// True when a query with the same client and request_id is already waiting.
template <class Waiting, class Query>
bool is_among(const std::deque<Waiting>& waiting, const Query& query) {
  return std::any_of(waiting.begin(), waiting.end(), [&](const Waiting& one) {
    return one.reply.client == query.client && one.reply.request_id == query.request_id;
  });
}

}  // namespace halocline::channel_server
