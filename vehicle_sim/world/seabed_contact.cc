// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/world/seabed_contact.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace halocline::vehicle_sim {
namespace {

constexpr int kSpheres = 41;
constexpr int kThirds = 3;
constexpr double kSteepestSeen = 5.7;        // tan(80 degrees)
constexpr double kSamePlaneCosine = 0.9986;  // cos(3 degrees): planes at a smaller angle count as one
// m, height above the seabed from which a plane's nearest point is not part of it.
constexpr double kHangingTolerance = 0.005;

struct Sphere {
  Vec3 center = Vec3::Zero();
  double radius = 0;
};

struct Candidate {
  HullContact contact;
  bool found = false;
};

// Least gap of each third of the hull to one of the planes (below, left, right).
using BestOfThirds = std::array<Candidate, kThirds>;

double gap_to(const Sphere& sphere, const SeabedPlane& plane, const Vec3& on_plane) {
  return plane.normal_ned.dot(sphere.center - on_plane) - sphere.radius;
}

// True when the plane's point nearest to the sphere lies in the water, not on the seabed.
bool hangs(const Seabed& seabed, const Vec3& nearest) {
  const auto plane = seabed.plane_at(nearest.x(), nearest.y());
  return plane && nearest.z() < plane->z_m - kHangingTolerance;
}

void keep_least(Candidate& best, const Sphere& sphere, const SeabedPlane& plane, double gap) {
  if (best.found && best.contact.gap_m <= gap) return;
  best = {{sphere.center - sphere.radius * plane.normal_ned, plane.normal_ned, gap}, true};
}

// True when the seabed below bow, centre and stern is so deep that no slope up to the steepest reaches the
// hull.
bool is_far_from_seabed(const HullShape& hull, const Vec3& center, const Vec3& axis, const Seabed& seabed,
                        double margin) {
  const double half = hull.length_m / 2;
  const double clear = hull.diameter_m / 2 + margin + kSteepestSeen * (half / 2 + hull.diameter_m / 2);
  for (const double along : {0.0, half, -half}) {
    const Vec3 point = center + along * axis;
    const auto plane = seabed.plane_at(point.x(), point.y());
    if (plane && plane->z_m - point.z() < clear) return false;
  }
  return true;
}

// Finds the candidates of one sphere: for the plane below in best[0], for those on the sides, where they
// differ from it, in best[1] and best[2].
void find_candidates(const Sphere& sphere, const Vec3& sideways, int third, const Seabed& seabed,
                     double margin, std::array<BestOfThirds, 3>& best) {
  const auto below = seabed.plane_at(sphere.center.x(), sphere.center.y());
  if (!below) return;
  const Vec3 under(sphere.center.x(), sphere.center.y(), below->z_m);
  const double gap = gap_to(sphere, *below, under);
  if (gap < margin) keep_least(best[0][third], sphere, *below, gap);
  if (gap > margin + 2 * sphere.radius || sphere.radius <= 0) return;
  for (int side = 1; side <= 2; ++side) {
    const Vec3 beside = sphere.center + (side == 1 ? sphere.radius : -sphere.radius) * sideways;
    const auto plane = seabed.plane_at(beside.x(), beside.y());
    if (!plane || plane->normal_ned.dot(below->normal_ned) > kSamePlaneCosine) continue;
    const double side_gap = gap_to(sphere, *plane, {beside.x(), beside.y(), plane->z_m});
    if (side_gap >= margin) continue;
    if (hangs(seabed, sphere.center - (side_gap + sphere.radius) * plane->normal_ned)) continue;
    keep_least(best[side][third], sphere, *plane, side_gap);
  }
}

Vec3 level_and_across(const Vec3& axis) {
  const Vec3 across(-axis.y(), axis.x(), 0);
  const double length = across.norm();
  return length > 1e-6 ? Vec3(across / length) : Vec3::UnitY();  // any level direction for an upright hull
}

}  // namespace

void find_contacts(const HullShape& hull, const Vec3& position_ned_m, const Quaternion& orientation,
                   const Seabed& seabed, double margin_m, std::vector<HullContact>& contacts) {
  contacts.clear();
  const Vec3 axis = orientation * Vec3::UnitX();
  if (is_far_from_seabed(hull, position_ned_m, axis, seabed, margin_m)) return;
  const Vec3 sideways = level_and_across(axis);
  std::array<BestOfThirds, 3> best;
  for (int i = 0; i < kSpheres; ++i) {
    const double along = 2.0 * i / (kSpheres - 1) - 1;  // -1 at the stern, 1 at the bow
    const Sphere sphere{position_ned_m + along * hull.length_m / 2 * axis,
                        hull.diameter_m / 2 * std::sqrt(std::max(0.0, 1 - along * along))};
    find_candidates(sphere, sideways, i * kThirds / kSpheres, seabed, margin_m, best);
  }
  for (const BestOfThirds& thirds : best) {
    for (const Candidate& c : thirds) {
      if (c.found) contacts.push_back(c.contact);
    }
  }
}

}  // namespace halocline::vehicle_sim
