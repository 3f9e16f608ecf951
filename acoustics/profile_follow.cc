// Following of rays over a bottom profile from where they were: see acoustics/profile_rays.h.
#include <cmath>

#include "acoustics/profile_path.h"
#include "acoustics/profile_rays.h"

namespace halocline::acoustics {
namespace {

constexpr int kMostSteps = 8;
constexpr double kDepthTolerance = 1e-4;  // m before the last step, as in the search

// Launch angle and image of the receiver that a path has now.
struct Settled {
  bool found = false;
  double theta = 0, target = 0;
};

Settled settle(const ArcTracer& tracer, const Arrival& before, TracedRay& ray) {
  const double sign = (before.surface_bounces + before.bottom_bounces) % 2 == 0 ? 1 : -1;
  const double image = sign * tracer.receiver_depth_m(), period = 2 * tracer.bottom_at_receiver_m();
  Settled at{false, before.launch_angle_rad, 0};
  for (int i = 0; i < kMostSteps; ++i) {
    tracer.trace(at.theta, ray);
    if (!ray.arrived || ray.zeta_slope == 0) return at;
    if (i == 0) at.target = image + period * std::round((ray.zeta - image) / period);
    const double off = ray.zeta - at.target;
    at.theta -= off / ray.zeta_slope;
    at.found = std::abs(off) < kDepthTolerance;
    if (at.found) return at;
  }
  return at;
}

bool is_same_path(const Arrival& now, const Arrival& before) {
  return now.surface_bounces == before.surface_bounces && now.bottom_bounces == before.bottom_bounces &&
         now.identity.launched_up == before.identity.launched_up && now.caustics == before.caustics;
}

}  // namespace

FollowedRays follow_profile_rays(const ProfiledSea& sea, const RayLink& link, const std::vector<Arrival>& before) {
  const ArcTracer tracer(sea, link);
  FollowedRays now;
  now.paths.reserve(before.size());
  TracedRay ray;
  for (const Arrival& path : before) {
    const Settled at = settle(tracer, path, ray);
    if (!at.found) return now;
    const std::size_t count = now.paths.size();
    append_profile_arrival(tracer, at.theta, kNoFold, at.target, now.paths);
    if (now.paths.size() == count) continue;  // too faint by now
    if (!is_same_path(now.paths.back(), path)) return now;
  }
  finish(now.paths, sea.options);
  now.complete = true;
  return now;
}

}  // namespace halocline::acoustics
