// SPDX-License-Identifier: BSD-3-Clause
// Answers to the requests of a page that need only the stored run; viewer/README.md lists them.
#pragma once

#include <cstdint>

#include <nlohmann/json.hpp>

#include "runs/timeline/run_timeline.h"
#include "viewer/pages/packet_json.h"

namespace halocline::monitor {

// Returns the `id` of a request. Throws InvalidArgument when the request is not an object or lacks such a
// number.
std::int64_t request_id(const nlohmann::json& request);

// Returns the members of the reply. Throws InvalidArgument, with a sentence, for a request that cannot be
// answered.
nlohmann::json answer_request(const clients::RunTimeline& timeline, PacketIndex& packets,
                              const nlohmann::json& request);

}  // namespace halocline::monitor
