// SPDX-License-Identifier: BSD-3-Clause
// How well vehicles received each other: by pair, and by range with the prediction of the link tables beside
// it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "clients/mission/mission_store.h"

namespace halocline::clients {

// What one vehicle received of another; every transmission counts, whomever it was addressed to, but those to
// others that were summed up as out of reach.
struct PairDelivery {
  std::int32_t from_id = 0, to_id = 0;
  std::int64_t packets = 0, received = 0;
  std::optional<double>
      snr_db;  // median over the link tables, else over the outcomes with a path; empty: neither

  double share() const {
    return packets > 0 ? static_cast<double>(received) / static_cast<double>(packets) : 0;
  }
};

// Of every pair in the ledger, by ids.
std::vector<PairDelivery> delivery_by_pair(const MissionStore& mission);

struct RangeDelivery {
  double from_m = 0, to_m = 0;  // of range, from the sender at departure to the receiver at arrival
  std::int64_t packets = 0, received = 0;
  std::optional<double>
      predicted;  // mean over these packets of the probability in the table before departure
};

// Ranges in steps of 1, 2 or 5 times a power of ten, at most `max_steps` of them; those without a packet are
// left out. A prediction counts where a table is at most 10 s older than the departure. Only packets whose
// numbers the mission still holds.
std::vector<RangeDelivery> delivery_by_range(const MissionStore& mission, std::size_t max_steps);

// The least of 1, 2 and 5 times a power of ten that is `least` or more; above 0.
double round_step(double least);

}  // namespace halocline::clients
