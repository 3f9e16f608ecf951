// SPDX-License-Identifier: BSD-3-Clause
// Energy cost of a received byte in joules, by sender and distance, for vehicles with batteries.
//
// Counted are the outcomes at a packet's destination, or at every possible receiver of a broadcast. Each
// counts the whole energy of the transmission, the energy of the reception, and the payload if it was
// received. Distances are grouped in octaves: up to 250 m, 500 m, 1000 m, and so on.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "bus/messages/messages.h"

namespace halocline::clients {

// Sums over the outcomes of one sender and range of distances.
struct EnergyCost {
  std::int64_t packets = 0, received = 0, bytes = 0;  // bytes: received payload
  double transmit_j = 0, receive_j = 0;
  // Returns the energy per received byte, J; 0 when no byte was received.
  double per_byte_j() const { return bytes == 0 ? 0 : (transmit_j + receive_j) / static_cast<double>(bytes); }
};

// Costs keyed by the sender's vehicle id and the upper end of the distance, m. Outcomes that cost no energy
// are left out.
using EnergyCosts = std::map<std::pair<std::int32_t, double>, EnergyCost>;
EnergyCosts energy_costs(const std::vector<packet_outcome_t>& outcomes);

}  // namespace halocline::clients
