// SPDX-License-Identifier: BSD-3-Clause
#include "runs/export/date_line.h"

#include <cmath>

namespace halocline::clients {
namespace {

constexpr double kHalfTurn_deg = 180, kTurn_deg = 360;

bool crosses(const LinePlace& from, const LinePlace& to) {
  return std::abs(to.longitude_deg - from.longitude_deg) > kHalfTurn_deg;
}

// Returns the place on the meridian between two places on opposite sides of it, on the side of `from`.
LinePlace crossing(const LinePlace& from, const LinePlace& to) {
  const double side_deg = std::copysign(kHalfTurn_deg, from.longitude_deg);
  const double step_deg = to.longitude_deg + std::copysign(kTurn_deg, side_deg) - from.longitude_deg;
  const double share = step_deg == 0 ? 0 : (side_deg - from.longitude_deg) / step_deg;
  const auto between = [share](double a, double b) { return a + share * (b - a); };
  return {side_deg, between(from.latitude_deg, to.latitude_deg), between(from.height_m, to.height_m),
          between(from.time_s, to.time_s)};
}

}  // namespace

std::vector<std::vector<LinePlace>> cut_at_date_line(const std::vector<LinePlace>& line) {
  std::vector<std::vector<LinePlace>> pieces(1);
  const auto add = [&pieces](const LinePlace& place) {
    auto& piece = pieces.back();
    if (piece.empty() || std::abs(place.longitude_deg) != kHalfTurn_deg ||
        piece.back().longitude_deg != place.longitude_deg || piece.back().time_s != place.time_s)
      piece.push_back(place);
  };
  for (const LinePlace& place : line) {
    if (!pieces.back().empty() && crosses(pieces.back().back(), place)) {
      LinePlace on_it = crossing(pieces.back().back(), place);
      add(on_it);
      if (pieces.back().size() == 1) pieces.pop_back();  // the line began on the meridian
      pieces.emplace_back();
      on_it.longitude_deg = -on_it.longitude_deg;
      add(on_it);
    }
    add(place);
  }
  if (pieces.size() > 1 && pieces.back().size() == 1) pieces.pop_back();  // the line ends on the meridian
  return pieces;
}

}  // namespace halocline::clients
