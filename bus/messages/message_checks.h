// SPDX-License-Identifier: BSD-3-Clause
// Validity checks of a decoded message. A message is refused for numbers that are not finite or outside the
// range that lcmtypes/*.lcm states, enumerators without a meaning, names, lengths and times out of range, and
// fields that contradict each other.
//
// An invalid message is counted, reported with channel and reason, and ignored; it is never repaired or
// guessed. Conditions that only a model can judge (a position beyond the terrain, a source level too low) are
// left to its node. So are the fields marked `unchecked` in lcmtypes; the node answers each faulty request.
#pragma once

#include <string>

#include "bus/messages/messages.h"

namespace halocline::bus {

// Returns an empty string, or the faulty field and its permitted values. Defined for each message type.
template <class Message>
[[nodiscard]] std::string problem_in(const Message& message);

// Checks relations between fields, which lcmtypes/*.lcm cannot state. The types that have such relations have
// an overload.
template <class Message>
[[nodiscard]] std::string problem_between_fields(const Message&) {
  return "";
}
[[nodiscard]] std::string problem_between_fields(const vehicle_state_t& message);
[[nodiscard]] std::string problem_between_fields(const environment_change_t& message);
[[nodiscard]] std::string problem_between_fields(const link_search_t& message);
[[nodiscard]] std::string problem_between_fields(const modem_config_t& message);
[[nodiscard]] std::string problem_between_fields(const modem_send_t& message);
[[nodiscard]] std::string problem_between_fields(const modem_receive_t& message);
[[nodiscard]] std::string problem_between_fields(const scenario_info_t& message);
[[nodiscard]] std::string problem_between_fields(const terrain_tile_t& message);
[[nodiscard]] std::string problem_between_fields(const lockstep_grant_t& message);
[[nodiscard]] std::string problem_between_fields(const lockstep_answer_t& message);
[[nodiscard]] std::string problem_between_fields(const lockstep_join_t& message);

}  // namespace halocline::bus
