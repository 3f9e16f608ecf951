// Following of rays over a bottom profile from where they were: see acoustics/rays/profile_rays.h.
#include <algorithm>
#include <cmath>

#include "acoustics/rays/profile_path.h"
#include "acoustics/rays/profile_rays.h"

namespace halocline::acoustics {
namespace {

// Newton's method at full steps, then, where that left the branch, at short ones.
struct Pace {
  double share;
  int most_steps;
};
constexpr Pace kPaces[] = {{1, 6}, {0.3, 30}};
constexpr double kDepthTolerance = 1e-4;  // m before the last step, as in the search

// Launch angle and image of the receiver that a path has now.
struct Settled {
  bool found = false;
  double theta = 0, target = 0;
};

Settled settle(const ArcTracer& tracer, const Arrival& before, Pace pace, TracedRay& ray) {
  const double sign = (before.surface_bounces + before.bottom_bounces) % 2 == 0 ? 1 : -1;
  const double image = sign * tracer.receiver_depth_m(), period = 2 * tracer.bottom_at_receiver_m();
  // With the same invariant of Snell as before: what grazed a layer still does when the source has changed
  // depth.
  const double cosine = before.launch_slowness_spm * tracer.source_speed_mps();
  const double start =
      cosine < 1 ? std::copysign(std::acos(cosine), before.launch_angle_rad) : before.launch_angle_rad;
  Settled at{false, start, 0};
  for (int i = 0; i < pace.most_steps; ++i) {
    tracer.trace(at.theta, ray);
    if (!ray.arrived || ray.zeta_slope == 0) return at;
    if (i == 0) at.target = image + period * std::round((ray.zeta - image) / period);
    const double off = ray.zeta - at.target;
    at.found = std::abs(off) < kDepthTolerance;
    at.theta -= (at.found ? 1 : pace.share) * off / ray.zeta_slope;
    if (at.found) return at;
  }
  return at;
}

// The path as it is now at the end of `paths`; false when it was lost or is too faint.
bool follow_path(const ArcTracer& tracer, const Arrival& before, TracedRay& ray,
                 std::vector<Arrival>& paths) {
  for (const Pace pace : kPaces) {
    const Settled at = settle(tracer, before, pace, ray);
    if (!at.found) continue;
    const std::size_t count = paths.size();
    append_profile_arrival(tracer, at.theta, Fold{}, at.target, paths);
    if (paths.size() == count) return false;
    if (is_followed(paths, before)) return true;
    paths.pop_back();
  }
  return false;
}

// Searches about where a path was, and appends what is there and not known yet.
void look_around(const ArcTracer& tracer, const Arrival& lost, std::vector<Arrival>& paths) {
  constexpr double kAround = 0.02;   // rad: some metres at some hundred metres
  constexpr double kSameRay = 1e-6;  // rad: nearer than that two rays would be one fold
  const double theta = lost.launch_angle_rad;
  for (const Arrival& found : profile_rays_between(tracer, theta - kAround, theta + kAround)) {
    const bool known = std::any_of(paths.begin(), paths.end(), [&found](const Arrival& path) {
      return std::abs(path.launch_angle_rad - found.launch_angle_rad) < kSameRay &&
             path.surface_bounces == found.surface_bounces && path.bottom_bounces == found.bottom_bounces;
    });
    if (!known) paths.push_back(found);
  }
}

}  // namespace

FollowedRays follow_profile_rays(const ProfiledSea& sea, const RayLink& link,
                                 const std::vector<Arrival>& before) {
  const ArcTracer tracer(sea, link);
  TracedRay ray;
  return follow_each(
      before, sea.options,
      [&](const Arrival& path, std::vector<Arrival>& paths) { return follow_path(tracer, path, ray, paths); },
      [&](const Arrival& lost, std::vector<Arrival>& paths) { look_around(tracer, lost, paths); });
}

}  // namespace halocline::acoustics
