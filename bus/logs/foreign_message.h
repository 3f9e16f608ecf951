// SPDX-License-Identifier: BSD-3-Clause
// Decodes messages of third-party vehicles, which may be incomplete: a vehicle_id or source_id of 0, or an
// orientation of all zeros, which is replaced by level and facing north.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <type_traits>

#include "bus/messages/message_codec.h"

namespace halocline::clients {

struct ForeignMessage {
  std::string problem;  // result of bus::decode(); empty: none
  bool orientation_filled = false;
  bool is_sound() const { return problem.empty(); }
};

inline bool fill_orientation(vehicle_state_t& state) {
  for (const double part : state.orientation_wxyz) {
    if (part != 0) return false;
  }
  state.orientation_wxyz[0] = 1;
  return true;
}

// Everything else is checked as in bus::decode(). An id of 0 is kept.
template <class Message>
[[nodiscard]] ForeignMessage decode_foreign(std::span<const std::uint8_t> bytes, Message& message) {
  ForeignMessage result;
  result.problem = bus::decode_unchecked(bytes, message);
  if (!result.problem.empty()) return result;
  if constexpr (std::is_same_v<Message, vehicle_state_t>) {
    result.orientation_filled = fill_orientation(message);
    Message with_id = message;
    if (with_id.vehicle_id == 0) with_id.vehicle_id = 1;
    result.problem = bus::problem_in(with_id);
  } else if constexpr (std::is_same_v<Message, modem_send_t>) {
    const std::int32_t id = message.source_id;
    if (id == 0) message.source_id = 1;
    result.problem = bus::problem_in(message);
    message.source_id = id;
  } else {
    result.problem = bus::problem_in(message);
  }
  return result;
}

}  // namespace halocline::clients
