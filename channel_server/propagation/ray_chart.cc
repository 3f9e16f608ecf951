// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/ray_chart.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "acoustics/fading/arrival.h"
#include "acoustics/modem/beam_pattern.h"
#include "acoustics/rays/traced_eigenray.h"
#include "acoustics/sea/bottom_profile.h"
#include "channel_server/propagation/ray_arrival.h"
#include "core/elementary.h"

namespace halocline::channel_server {
namespace {

using acoustics::RayPoint;

std::size_t points_for(std::size_t paths) {
  return std::min(LinkChart::kMaxPoints, LinkChart::kMaxPointsOfAll / std::max<std::size_t>(paths, 1));
}

std::vector<RayPoint> seabed_between(const acoustics::BottomProfile& bottom, double range_m) {
  std::vector<RayPoint> points{{0, bottom.depth_at(0)}};
  for (const acoustics::ProfiledDepth& point : bottom.points()) {
    if (point.range_m > 0 && point.range_m < range_m) points.push_back({point.range_m, point.depth_m});
  }
  if (range_m > 0) points.push_back({range_m, bottom.depth_at(range_m)});
  return acoustics::simplified(points, LinkChart::kMaxSeabed);
}

// Returns the points as seen from the other end.
std::vector<RayPoint> mirrored(std::vector<RayPoint> points, double range_m) {
  std::reverse(points.begin(), points.end());
  for (RayPoint& point : points) point.range_m = range_m - point.range_m;
  return points;
}

// Splits the loss of a path into its terms, dB:
//
//   spreading = -20 log10(amplitude) - reflection loss at the surface - reflection loss at the bottom
//   bottom    = source level - received level - spreading - absorption - surface - beams
//
// The amplitude includes reflection losses. The bottom's term is the remainder: reflected and scattered loss.
void split_losses(const acoustics::Modem& transmitter, const acoustics::Modem& receiver,
                  LinkChart::Row& row) {
  const acoustics::Arrival& arrival = row.arrival;
  row.beam_db =
      (transmitter.beam.loss(arrival.launch_angle_rad) + receiver.beam.loss(-arrival.arrival_angle_rad))
          .value;
  row.spreading_db =
      -20 * elementary::log10(arrival.amplitude) - arrival.surface_loss_db - arrival.bottom_loss_db;
  row.bottom_db = (transmitter.source_level - arrival.level).value - row.spreading_db -
                  arrival.absorption_db - row.surface_db - row.beam_db;
}

}  // namespace

LinkChart chart_of(const acoustics::ProfiledSea& sea, const acoustics::RayLink& searched, bool reversed,
                   std::vector<LinkChart::Row> rows, const acoustics::Modem& transmitter,
                   const acoustics::Modem& receiver) {
  LinkChart chart{.link = searched, .rows = std::move(rows)};
  if (reversed) std::swap(chart.link.source_depth_m, chart.link.receiver_depth_m);
  const auto from_transmitter = [&](std::vector<RayPoint> points) {
    return reversed ? mirrored(std::move(points), searched.range_m) : points;
  };
  chart.keep_strongest();
  for (LinkChart::Row& row : chart.rows) {
    split_losses(transmitter, receiver, row);
    if (row.arrival.diffuse) continue;  // has no single course
    const acoustics::Eigenray eigenray = reversed ? backwards(row.arrival) : row.arrival;
    row.course = from_transmitter(polyline(sea, searched, eigenray, points_for(chart.rows.size())));
  }
  chart.seabed = from_transmitter(seabed_between(sea.profile, searched.range_m));
  return chart;
}

}  // namespace halocline::channel_server
