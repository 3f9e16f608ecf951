// SPDX-License-Identifier: BSD-3-Clause
// Delivery statistics of a run: the share of packets received by each pair of vehicles, and by range together
// with the delivery probability that the link tables predicted.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "runs/timeline/run_timeline.h"

namespace halocline::clients {

// Packets that one vehicle received from another. Every transmission counts, whatever its destination, except
// those to others that an OUTCOME summed up as out of reach.
struct PairDelivery {
  std::int32_t from_id = 0, to_id = 0;
  std::int64_t packets = 0, received = 0;
  std::optional<double> snr_db;  // median over link tables, else over outcomes with a path; empty: neither

  double share() const {
    return packets > 0 ? static_cast<double>(received) / static_cast<double>(packets) : 0;
  }
};

// Returns the delivery of every pair in the ledger, sorted by the ids of sender and receiver.
std::vector<PairDelivery> delivery_by_pair(const RunTimeline& timeline);

// Packets whose range lies in one step, and the prediction for them.
struct RangeDelivery {
  double from_m = 0, to_m = 0;  // range from the sender at departure to the receiver at arrival
  std::int64_t packets = 0, received = 0;
  std::optional<double> predicted;  // mean delivery probability from the tables before departure; empty: none
};

// Returns the delivery by range, in steps of 1, 2 or 5 times a power of ten, at most `max_steps` of them.
// Steps without a packet are left out. A prediction counts when its table is at most 10 s older than the
// departure. Only packets that the timeline's packet book still holds are counted.
std::vector<RangeDelivery> delivery_by_range(const RunTimeline& timeline, std::size_t max_steps);

// Returns the smallest of 1, 2 and 5 times a power of ten that is not below `least`, which must be above 0.
double round_step(double least);

}  // namespace halocline::clients
