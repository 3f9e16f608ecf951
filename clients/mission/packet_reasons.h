// SPDX-License-Identifier: BSD-3-Clause
// Why a packet was received or lost: as a reason with its numbers, as a sentence, and as the ladder of
// numbers that decided it, from the transmitted level to the draws. All from OUTCOME; docs/packets.md
// explains the steps.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bus/messages.h"

namespace halocline::clients {

using VehicleName = std::function<std::string(std::int32_t id)>;

// "auv-1:12 auv-2:3": the packets that disturbed this one, or its receiver's own, the strongest first.
std::string colliders_text(const packet_outcome_t& outcome, const VehicleName& name);

// What decided the outcome, with its numbers: the end of a sentence, without a full stop.
std::string deciding_reason(const packet_outcome_t& outcome, const VehicleName& name);

// "Lost at auv-3: too quiet: 95.2 dB arrived of the 100.0 dB that its modem needs."
std::string sentence(const packet_outcome_t& outcome, const VehicleName& name);

// "data", "ping", "ping_reply", "ack", "mini_packet", "janus", "janus_cargo"; what is none of them counts as
// data.
const char* packet_kind_name(std::int8_t packet_kind);

// Why a SEND was not transmitted, by the result of its receipt; empty where it was.
std::string refusal(std::int8_t receipt_result);

struct LadderStep {
  std::string step;             // key: source, loss, level, ...
  std::string quantity;         // for a person
  std::optional<double> value;  // empty where the step is a decision alone
  std::string unit;             // "dB re 1 uPa", "dB", "" of a probability
  std::optional<double> limit;  // what the value had to reach; empty where nothing is decided here
  std::optional<bool> passed;   // empty likewise
  std::string help;             // what it is, in a sentence
};

// The steps that were reached, the outcome last. Steps after the one that lost the packet are left out.
std::vector<LadderStep> ladder(const packet_outcome_t& outcome);

}  // namespace halocline::clients
