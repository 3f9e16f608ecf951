// SPDX-License-Identifier: BSD-3-Clause
#include "runs/analysis/energy_cost.h"

namespace halocline::clients {
namespace {

double octave_of(double range_m) {
  double end_m = 250;
  while (end_m < range_m) end_m *= 2;
  return end_m;
}

}  // namespace

EnergyCosts energy_costs(const std::vector<packet_outcome_t>& outcomes) {
  EnergyCosts costs;
  for (const packet_outcome_t& o : outcomes) {
    const bool is_for_it = o.destination_id == 0 || o.destination_id == o.receiver_id;
    const bool costs_energy = o.transmit_energy_j > 0 || o.receive_energy_j > 0;
    if (!is_for_it || o.receiver_id == 0 || !costs_energy) continue;
    EnergyCost& cost = costs[{o.source_id, octave_of(o.range_m)}];
    ++cost.packets;
    cost.transmit_j += o.transmit_energy_j;
    cost.receive_j += o.receive_energy_j;
    if (o.outcome != packet_outcome_t::RECEIVED) continue;
    ++cost.received;
    cost.bytes += o.payload_bytes;
  }
  return costs;
}

}  // namespace halocline::clients
