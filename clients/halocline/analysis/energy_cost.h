// SPDX-License-Identifier: BSD-3-Clause
// What a byte costs in joules, by the modem that sent it and the distance: of vehicles with batteries.
//
// Counted are outcomes at the packet's destination, or at each possible receiver where it went to all: the
// energy of the transmission, whole for each, that of the reception, and the payload where it was received.
// Distances are in octaves: up to 250 m, to 500 m, to 1000 m, and so on.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "bus/messages.h"

namespace halocline::clients {

struct EnergyCost {
  std::int64_t packets = 0, received = 0, bytes = 0;  // bytes received
  double transmit_j = 0, receive_j = 0;
  // J; 0 where none was received.
  double per_byte_j() const { return bytes == 0 ? 0 : (transmit_j + receive_j) / static_cast<double>(bytes); }
};

// By the sender's vehicle id and the upper end of the distance, m. Without those that cost nothing.
using EnergyCosts = std::map<std::pair<std::int32_t, double>, EnergyCost>;
EnergyCosts energy_costs(const std::vector<packet_outcome_t>& outcomes);

}  // namespace halocline::clients
