// SPDX-License-Identifier: BSD-3-Clause
// Reasons why a packet was received or lost: as a phrase with its numbers, as a sentence, and as the ladder
// of numbers that decided it, from the transmitted level to the random draws. All of it is derived from the
// OUTCOME message; docs/packets.md explains the steps.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bus/messages/messages.h"

namespace halocline::clients {

using VehicleName = std::function<std::string(std::int32_t id)>;

// Returns "auv-1:12 auv-2:3": the packets that disturbed this one, which may be the receiver's own, the
// strongest first.
std::string colliders_text(const packet_outcome_t& outcome, const VehicleName& name);

// Returns the cause of the outcome with its numbers, as the end of a sentence without a full stop.
std::string deciding_reason(const packet_outcome_t& outcome, const VehicleName& name);

// Returns a sentence: "Lost at auv-3: too quiet: 95.2 dB arrived of the 100.0 dB that its modem needs."
std::string sentence(const packet_outcome_t& outcome, const VehicleName& name);

// Returns "data", "ping", "ping_reply", "ack", "mini_packet", "janus" or "janus_cargo"; "data" for an unknown
// kind.
const char* packet_kind_name(std::int8_t packet_kind);

// Returns why a SEND was not transmitted, by the result of its receipt; empty when it was transmitted.
std::string refusal(std::int8_t receipt_result);

// Step of the ladder: one quantity, and the limit that it had to reach if the step decides anything.
struct LadderStep {
  std::string step;             // key: source, loss, level, ...
  std::string quantity;         // name of the quantity for a reader
  std::optional<double> value;  // empty: the step is a decision without a value
  std::string unit;             // "dB re 1 uPa", "dB", or "" for a probability
  std::optional<double> limit;  // value to reach; empty: nothing is decided here
  std::optional<bool> passed;   // empty: nothing is decided here
  std::string help;             // explanation of the quantity in a sentence
};

// Returns the steps that were reached, the outcome last. Steps after the one at which the packet was lost are
// left out.
std::vector<LadderStep> ladder(const packet_outcome_t& outcome);

}  // namespace halocline::clients
