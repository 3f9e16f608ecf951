// SPDX-License-Identifier: BSD-3-Clause
// Handler of messages of which the latest counts: what is older than one that came before, of the same
// session, changes nothing. Repair brings lost messages late, and anybody may send an old one again. Of a
// publisher that keeps no numbers (session and sequence 0) every message counts.
#pragma once

#include <cstdint>
#include <utility>

namespace halocline::bus {

template <class Message, class Handler>
auto newest(Handler handler) {
  return [handler = std::move(handler), session = std::int64_t{0},
          sequence = std::int64_t{0}](const Message& message) mutable {
    if (message.session == session && message.sequence < sequence) return;
    session = message.session;
    sequence = message.sequence;
    handler(message);
  };
}

}  // namespace halocline::bus
