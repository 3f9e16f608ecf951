// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/vehicle_record.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"

namespace halocline::clients {
namespace {

constexpr double kAtRest_m = 0.01;

double between_angles(double from_rad, double to_rad, double share) {
  const double turn = std::remainder(to_rad - from_rad, 2 * std::numbers::pi);
  return std::remainder(from_rad + share * turn, 2 * std::numbers::pi);
}

TrackPoint between(const TrackPoint& a, const TrackPoint& b, double share) {
  TrackPoint point;
  point.position_ned_m = a.position_ned_m + share * (b.position_ned_m - a.position_ned_m);
  point.speed_mps = a.speed_mps + share * (b.speed_mps - a.speed_mps);
  point.attitude = {between_angles(a.attitude.roll, b.attitude.roll, share),
                    between_angles(a.attitude.pitch, b.attitude.pitch, share),
                    between_angles(a.attitude.yaw, b.attitude.yaw, share)};
  return point;
}

}  // namespace

TrackPoint track_point_of(const vehicle_state_t& state) {
  const double* q = state.orientation_wxyz;
  TrackPoint point;
  point.position_ned_m = Vec3(state.position_ned_m[0], state.position_ned_m[1], state.position_ned_m[2]);
  point.attitude = to_euler(Quaternion(q[0], q[1], q[2], q[3]).normalized());
  point.speed_mps = elementary::hypot(state.velocity_ned_mps[0], state.velocity_ned_mps[1]);
  return point;
}

std::optional<TrackState> state_at(const Track& track, SimTime at) {
  const auto* last = track.at_or_before(at);
  if (last == nullptr) return std::nullopt;
  if (last == &track.back()) return TrackState{last->value, at - last->at};
  const auto* next = last + 1;
  return TrackState{
      between(last->value, next->value, (at - last->at).seconds() / (next->at - last->at).seconds()),
      SimDuration()};
}

std::vector<Timed<TrackPoint>> decimated_track(const Track& track, SimTime from, SimTime to,
                                               std::size_t max_points) {
  return decimated(
      track.between(from, to), max_points, [](const TrackPoint& p) { return p.position_ned_m.x(); },
      [](const TrackPoint& p) { return p.position_ned_m.y(); },
      [](const TrackPoint& p) { return p.position_ned_m.z(); });
}

const vehicle_plan_t* VehicleRecord::plan_at(SimTime at) const {
  const auto* last = plans.at_or_before(at);
  return last != nullptr ? &last->value : nullptr;
}

bool VehicleRecord::is_at_rest() const {
  if (described && described->moved_by == scenario_vehicle_t::FIXED) return true;
  return std::all_of(track.all().begin(), track.all().end(), [&](const auto& entry) {
    return (entry.value.position_ned_m - track.front().value.position_ned_m).norm() < kAtRest_m;
  });
}

double VehicleRecord::distance_m() const {
  double distance = 0;
  for (std::size_t i = 1; i < track.size(); ++i)
    distance +=
        (track.all()[i].value.position_ned_m - track.all()[i - 1].value.position_ned_m).head<2>().norm();
  return distance;
}

}  // namespace halocline::clients
