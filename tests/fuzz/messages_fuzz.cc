// SPDX-License-Identifier: BSD-3-Clause
// The decoder and the checks of each type: the key of the type, then its body. What is accepted is encoded as
// the same bytes.
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "bus/messages/message_codec.h"
#include "bus/messages/messages.h"
#include "core/check.h"
#include "tests/fuzz/bus_message.h"
#include "tests/fuzz/fuzz_input.h"

namespace {

using namespace halocline;

template <class Message>
void take(std::span<const std::uint8_t> body) {
  const bus::Bytes bytes = fuzz::with_fingerprint(Message::getHash(), body);
  Message message;
  if (!bus::decode(bytes, message).empty()) return;
  ensure(bus::encoded(message) == bytes, "an accepted message is encoded as it was received");
  const auto list = bus::encoded_list<Message>(std::span(&message, 1));
  ensure(bus::decoded_list<Message>(list).has_value(), "a list of valid messages is valid");
}

struct Type {
  std::uint16_t key;
  void (*take)(std::span<const std::uint8_t> body);
};

const std::vector<Type>& types() {
  static const std::vector<Type> all = [] {
    std::vector<Type> found;
#define HALOCLINE_TYPE(type) found.push_back({fuzz::key_of(#type), take<type>});
    HALOCLINE_EACH_MESSAGE(HALOCLINE_TYPE)
#undef HALOCLINE_TYPE
    std::sort(found.begin(), found.end(), [](const Type& a, const Type& b) { return a.key < b.key; });
    return found;
  }();
  return all;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const Type& type = fuzz::with_key(types(), input.number<std::uint16_t>());
  type.take(input.rest());
  return 0;
}
