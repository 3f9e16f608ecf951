// SPDX-License-Identifier: BSD-3-Clause
// What a node subscribes to, as those need to know it who deliver its messages.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <utility>

namespace halocline::bus {

// What receiving a message may do to a node. kStoreOnly is a promise: its handler only stores, so that the
// node is due when it was due before. Lockstep then need not step the node at once, and others may run ahead.
enum class Wakeup { kMayAdvanceDue, kStoreOnly };

// A subscription: an LCM regular expression, and what its messages may do to the node.
struct Subscribed {
  std::string expression;
  Wakeup wakeup = Wakeup::kMayAdvanceDue;
};

// Handler of messages of which the latest counts: what is older than one that came before, of the same
// session, changes nothing. Repair brings lost messages late, and anybody may send an old one again. Of a
// publisher that keeps no numbers (session and sequence 0) every message counts.
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

// The LCM regular expressions on which a Bus receives messages now.
class Subscriptions {
 public:
  void add(const std::string& expression) {
    expressions_.insert(expression);
    ++changes_;
  }
  void remove(const std::string& expression) {
    expressions_.erase(expressions_.find(expression));
    ++changes_;
  }
  const std::multiset<std::string>& expressions() const { return expressions_; }
  // Counts additions and removals.
  std::uint64_t changes() const { return changes_; }

 private:
  std::multiset<std::string> expressions_;
  std::uint64_t changes_ = 0;
};

}  // namespace halocline::bus
