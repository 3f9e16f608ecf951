// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/report/chart_texts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "runs/timeline/plan_texts.h"

namespace halocline::clients {

std::string time_text(double seconds) {
  if (seconds < 3600) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<std::int64_t>(seconds);
  return fmt::format("{} h {:02} min {:02} s", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string step_text(double seconds) {
  if (seconds < 60) return fmt::format("{:g} s", seconds);
  return seconds < 3600 ? fmt::format("{:g} min", seconds / 60) : fmt::format("{:g} h", seconds / 3600);
}

std::string distance_text(double metres) {
  return metres < 1000 ? fmt::format("{:.0f} m", metres) : fmt::format("{:.3g} km", metres / 1000);
}

std::string place_text(const Vec3& ned_m) {
  return fmt::format("{:.0f} m north, {:.0f} m east, {:.0f} m deep", whole_number(ned_m.x()),
                     whole_number(ned_m.y()), whole_number(ned_m.z()));
}

std::string packet_title(const packet_outcome_t& o, const VehicleName& name) {
  return fmt::format("{}:{} to {} at {}, {} away", name(o.source_id), o.packet_sequence,
                     o.destination_id == 0 ? "all" : name(o.destination_id),
                     time_text(static_cast<double>(o.departure_utime) * 1e-6), distance_text(o.range_m));
}

double round_time_step(double least_s) {
  constexpr std::array<double, 20> kSteps{1,   2,    5,    10,   20,    30,    60,    120,   300,    600,
                                          900, 1800, 3600, 7200, 10800, 21600, 43200, 86400, 172800, 604800};
  const auto found = std::lower_bound(kSteps.begin(), kSteps.end(), least_s);
  if (found != kSteps.end()) return *found;
  return std::ceil(least_s / kSteps.back()) * kSteps.back();
}

TimeAxis time_axis(SimTime begin, SimTime end, int max_tics) {
  TimeAxis axis;
  axis.begin_s = begin.seconds();
  axis.end_s = std::max(end.seconds(), axis.begin_s + 1);
  const double span_s = axis.end_s - axis.begin_s;
  axis.step_s = round_time_step(span_s / max_tics);
  if (span_s > 3 * 3600) {
    axis.unit_s = 3600;
    axis.unit = "h";
  } else if (span_s > 1200) {
    axis.unit_s = 60;
    axis.unit = "min";
  }
  return axis;
}

}  // namespace halocline::clients
