// SPDX-License-Identifier: BSD-3-Clause
// Lines on the earth, cut where they cross the meridian of 180 degrees (RFC 7946, section 3.1.9).
#pragma once

#include <vector>

namespace halocline::clients {

struct LinePlace {
  double longitude_deg = 0, latitude_deg = 0, height_m = 0, time_s = 0;  // longitude -180 to 180
};

// The pieces of a line of two places or more, each of two or more. Places whose longitudes differ by more
// than 180 degrees lie on both sides of the meridian: one piece ends and the next begins on it, at latitude,
// height and time interpolated linearly in longitude. A line that passes by a pole within one step is cut
// there as well.
std::vector<std::vector<LinePlace>> cut_at_date_line(const std::vector<LinePlace>& line);

}  // namespace halocline::clients
