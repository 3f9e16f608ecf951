// SPDX-License-Identifier: BSD-3-Clause
// Encoder of the binary messages to a page; viewer/README.md has their layout.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/sim_time.h"
#include "runs/timeline/run_timeline.h"

namespace halocline::monitor {

// Age beyond which a vehicle's state is marked as stale.
inline constexpr SimDuration kStaleAfter = SimDuration::from_milliseconds(2000);

// Encodes a message of kind 1: positions and attitudes of all vehicles at one time.
std::string vehicle_frame(const clients::RunTimeline& timeline, SimTime at);

// Grid of depths below z = 0 of the world frame: rows from south to north, each from west to east; NaN where
// the depth is unknown. `south_m` and `west_m` are the north and east coordinates of the first post.
struct DepthGrid {
  double south_m = 0, west_m = 0, spacing_m = 0;
  std::uint16_t rows = 0, columns = 0;
  std::vector<float> depth_m;
};
// Encodes a message of kind 2, the answer to request `id`.
std::string terrain_frame(const DepthGrid& grid, std::int64_t id);

struct LinkValue {
  std::uint16_t from = 0, to = 0;  // indices of vehicles
  float value = 0;                 // in the display unit of the column
};
// Encodes a message of kind 3: one quantity of the link table.
std::string link_frame(std::uint16_t column, SimTime at, const std::vector<LinkValue>& values);

}  // namespace halocline::monitor
