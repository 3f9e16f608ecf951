// SPDX-License-Identifier: BSD-3-Clause
// Answers to a page's requests that the mission holds: README.md lists them. Pure.
#pragma once

#include <cstdint>

#include <nlohmann/json.hpp>

#include "clients/mission/mission_store.h"
#include "clients/monitor/pages/packet_json.h"

namespace halocline::monitor {

// The `id` of a request. Throws InvalidArgument when it is no object with a number of that name.
std::int64_t request_id(const nlohmann::json& request);

// The members of the reply. Throws InvalidArgument, with a sentence, for what cannot be answered.
nlohmann::json answer_request(const clients::MissionStore& mission, PacketIndex& packets,
                              const nlohmann::json& request);

}  // namespace halocline::monitor
