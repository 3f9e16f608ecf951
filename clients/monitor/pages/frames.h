// SPDX-License-Identifier: BSD-3-Clause
// The binary messages to a page: README.md has their bytes. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "clients/mission/mission_store.h"
#include "core/sim_time.h"

namespace halocline::monitor {

// A state older than this is marked.
inline constexpr SimDuration kStaleAfter = SimDuration::from_milliseconds(2000);

// Kind 1: where the vehicles are at an instant.
std::string vehicle_frame(const clients::MissionStore& mission, SimTime at);

// Depths of a grid: row by row from the south, each from the west; NaN where no ground is known.
struct DepthGrid {
  double south_m = 0, west_m = 0, spacing_m = 0;
  std::uint16_t rows = 0, columns = 0;
  std::vector<float> depth_m;
};
// Kind 2, the answer to request `id`.
std::string terrain_frame(const DepthGrid& grid, std::int64_t id);

struct LinkValue {
  std::uint16_t from = 0, to = 0;  // indices of vehicles
  float value = 0;
};
// Kind 3: one column of the table.
std::string link_frame(std::uint16_t column, SimTime at, const std::vector<LinkValue>& values);

}  // namespace halocline::monitor
