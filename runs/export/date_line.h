// SPDX-License-Identifier: BSD-3-Clause
// Cuts lines on the earth where they cross the 180 degree meridian (RFC 7946, section 3.1.9).
#pragma once

#include <vector>

namespace halocline::clients {

struct LinePlace {
  double longitude_deg = 0, latitude_deg = 0, height_m = 0, time_s = 0;  // longitude -180 to 180
};

// Returns the pieces of a line of two places or more; each piece has two or more. Places whose longitudes
// differ by more than 180 degrees are on opposite sides of the meridian: one piece ends and the next begins
// on it, with latitude, height and time interpolated linearly in longitude. A line that passes a pole within
// one step is cut there too.
std::vector<std::vector<LinePlace>> cut_at_date_line(const std::vector<LinePlace>& line);

}  // namespace halocline::clients
