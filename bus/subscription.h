// What a node subscribes to, as lockstep needs to know it.
#pragma once

#include <string>

namespace halocline::bus {

// What receiving a message may do to a node. kStoreOnly is a promise: its handler only stores, so that the node is due
// when it was due before. Lockstep then need not step the node at once, and others may run ahead.
enum class Wakeup { kMayAdvanceDue, kStoreOnly };

// A subscription: an LCM regular expression, and what its messages may do to the node.
struct Subscribed {
  std::string expression;
  Wakeup wakeup = Wakeup::kMayAdvanceDue;
};

}  // namespace halocline::bus
