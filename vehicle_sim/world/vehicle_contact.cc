// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/world/vehicle_contact.h"

#include <algorithm>
#include <cmath>

namespace halocline::vehicle_sim {
namespace {

constexpr int kThirds = 3;
constexpr double kCoarsest = 0.5, kFinest = 1e-5;  // steps of the search, in units of the focal distance
constexpr double kSameAxis = 1e-6;                 // m, axes closer than this have no direction between them

struct AxisSegment {
  double low, high;
};

// Positions along the two axes, -1 at the aft focus, 1 at the forward focus.
struct Places {
  double first, second;
};

// Centre of the sphere at s = `along`: p + s c axis, with c = sqrt(a^2 - b^2) the focal distance.
Vec3 center_at(const HullPose& h, double along) {
  const double a = h.hull.length_m / 2, b = h.hull.diameter_m / 2;
  return h.position_ned_m + along * std::sqrt(a * a - b * b) * h.axis_ned;
}

// Radius of the sphere at s = `along`: b sqrt(1 - s^2).
double radius_at(const HullPose& h, double along) {
  return h.hull.diameter_m / 2 * std::sqrt(std::max(0.0, 1 - along * along));
}

double gap_at(const HullPose& a, const HullPose& b, const Places& p) {
  return (center_at(a, p.first) - center_at(b, p.second)).norm() - radius_at(a, p.first) -
         radius_at(b, p.second);
}

// Returns the positions of the least gap, the first within `third`: moves to the best of eight neighbours as
// long as one is better, then halves the step.
Places closest_places(const HullPose& a, const HullPose& b, const AxisSegment& third) {
  Places best{(third.low + third.high) / 2, 0};
  double min_gap = gap_at(a, b, best);
  for (double step = kCoarsest; step > kFinest;) {
    Places better = best;
    for (int i = -1; i <= 1; ++i) {
      for (int k = -1; k <= 1; ++k) {
        const Places tried{std::clamp(best.first + i * step, third.low, third.high),
                           std::clamp(best.second + k * step, -1.0, 1.0)};
        const double gap = gap_at(a, b, tried);
        if (gap < min_gap) {
          min_gap = gap;
          better = tried;
        }
      }
    }
    if (better.first == best.first && better.second == best.second) step /= 2;
    best = better;
  }
  return best;
}

bool overlap(const std::vector<VehicleContact>& contacts) {
  constexpr double kTouching = 1e-3;  // m
  return std::any_of(contacts.begin(), contacts.end(),
                     [](const VehicleContact& c) { return c.gap_m < -kTouching; });
}

VehicleContact contact_at(const HullPose& a, const HullPose& b, const Places& p) {
  const Vec3 between = center_at(a, p.first) - center_at(b, p.second);
  const double distance = between.norm();
  // Axes that intersect have no direction between them; the shorter way to separate them is normal to both.
  Vec3 normal = distance > kSameAxis ? Vec3(between / distance) : a.axis_ned.cross(b.axis_ned);
  if (normal.norm() < kSameAxis) normal = a.axis_ned.unitOrthogonal();
  normal.normalize();
  const double gap = distance - radius_at(a, p.first) - radius_at(b, p.second);
  const Vec3 point = center_at(b, p.second) + (radius_at(b, p.second) + gap / 2) * normal;
  return {point, normal, gap};
}

}  // namespace

void find_vehicle_contacts(const HullPose& first, const HullPose& second, double margin_m,
                           std::vector<VehicleContact>& contacts) {
  contacts.clear();
  const double reach = (first.hull.length_m + second.hull.length_m) / 2 + margin_m;
  if ((first.position_ned_m - second.position_ned_m).squaredNorm() > reach * reach) return;
  for (int third = 0; third < kThirds; ++third) {
    const AxisSegment interval{-1 + 2.0 * third / kThirds, -1 + 2.0 * (third + 1) / kThirds};
    const VehicleContact contact = contact_at(first, second, closest_places(first, second, interval));
    if (contact.gap_m < margin_m) contacts.push_back(contact);
  }
}

HullPath path_of(const HullShape& hull, const VehicleState& from, const VehicleState& to) {
  return {hull, from.position_ned_m, to.position_ned_m, from.orientation, to.orientation};
}

HullPose HullPath::at(double time) const {
  return {hull, from + time * (to - from), between(orientation_from, orientation_to, time) * Vec3::UnitX()};
}

double find_first_touch(const HullPath& first, const HullPath& second, double margin_m,
                        std::vector<VehicleContact>& contacts) {
  constexpr int kHalvings = 7;
  const auto overlap_at = [&](double time) {
    find_vehicle_contacts(first.at(time), second.at(time), margin_m, contacts);
    return overlap(contacts);
  };
  if (!overlap_at(1)) return 1;
  double free_at = 0, overlaps_at = 1;
  for (int i = 0; i < kHalvings; ++i) {
    const double time = (free_at + overlaps_at) / 2;
    if (overlap_at(time)) {
      overlaps_at = time;
    } else {
      free_at = time;
    }
  }
  overlap_at(free_at);
  return free_at;
}

}  // namespace halocline::vehicle_sim
