// SPDX-License-Identifier: BSD-3-Clause
// Subscriptions of a node, as seen by the runners that deliver its messages.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <utility>

namespace halocline::bus {

// Effect of a message on the time at which the node is due. kStoreOnly is a promise that the handler only
// stores, so that this time is unchanged. Lockstep then need not step the node at once, and other nodes may
// run ahead.
enum class Wakeup { kMayAdvanceDue, kStoreOnly };

// A subscription: an LCM regular expression, and the effect of its messages on the node.
struct Subscribed {
  std::string expression;
  Wakeup wakeup = Wakeup::kMayAdvanceDue;
};

// Wraps a handler for messages of which only the newest counts: a message older than a previous one of the
// same session is ignored. Repair delivers lost messages late, and anybody may send an old one again. Every
// message counts of a publisher that uses no numbers (session and sequence 0).
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

// The LCM regular expressions to which a Bus is subscribed at present.
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
  // Number of additions and removals.
  std::uint64_t changes() const { return changes_; }

 private:
  std::multiset<std::string> expressions_;
  std::uint64_t changes_ = 0;
};

}  // namespace halocline::bus
