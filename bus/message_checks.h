// SPDX-License-Identifier: BSD-3-Clause
// Validity of a decoded message. It is refused for numbers that are not finite or beyond the range that
// lcmtypes/*.lcm gives them, enumerations without a meaning, names, lengths and times out of range, fields
// that contradict each other.
//
// A message that fails is counted, reported with channel and reason, and ignored; never repaired, never
// guessed. What only a model can judge (a position beyond the terrain, a modem too weak) is the business of
// its node; so are the fields that are `unchecked` in lcmtypes, which are answered one by one.
#pragma once

#include <string>

#include "bus/messages.h"

namespace halocline::bus {

// An empty string, or the field and what it may hold. For each type of the bus.
template <class Message>
[[nodiscard]] std::string problem_in(const Message& message);

// The part that lcmtypes/*.lcm cannot state: relations between fields. An overload for each type that has
// some.
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
