// Following of Snell rays from where they were: see acoustics/layered_rays.h.
#include <cmath>
#include <numbers>

#include "acoustics/layered_path.h"
#include "acoustics/layered_rays.h"

namespace halocline::acoustics {
namespace {

constexpr int kMostSteps = 12;
constexpr double kRangeTolerance = 1e-4;  // m before the last step, as in the search

// Family and cycles of a path: how often it ran U and D follows from its bounces and turns, and where those are equal
// from the way it left.
LayeredRay ray_of(const LayeredLink& link, const PathIdentity& id) {
  const int above = id.surface_bounces + id.upper_turns, below = id.bottom_bounces + id.lower_turns;
  Family family{above > below, below > above};
  if (above == below) family.up = family.down = link.source_is_upper == id.launched_up;
  return {family, above - (family.up ? 1 : 0), 0, 1};
}

// Newton's method in the angle at the barrier, which changes as the ray passes knots. False when it does not settle.
bool settle(const LayeredLink& link, LayeredSpans& spans, double xi, LayeredRay& ray) {
  bool last = false;
  for (int i = 0; i < kMostSteps; ++i) {
    if (!spans.seek(xi)) xi = (1 - 1e-12) / spans.barrier_mps();
    if (!spans.seek(xi)) return false;
    ray.cosine = xi * spans.barrier_mps();
    ray.sine = std::sqrt((1 - ray.cosine) * (1 + ray.cosine));
    if (last) return true;
    const SpanSums sums = spans.sums(ray.sine, ray.cosine);
    const RangeTerms t = range_terms(sums, ray.family);
    const double off = link.range_m - xi * (t.bq + ray.cycles * t.xq);
    // dr/dtheta = dr/dxi dxi/dtheta, dxi/dtheta = -sin / c*.
    const double slope = -(t.bm + ray.cycles * t.xm) * ray.sine / spans.barrier_mps();
    if (slope == 0) return false;
    const double theta = std::atan2(ray.sine, ray.cosine), next = theta + off / slope;
    xi = std::cos(next > 0 ? next : theta / 2) / spans.barrier_mps();
    last = std::abs(off) < kRangeTolerance;
  }
  return false;
}

bool is_same_path(const Arrival& now, const Arrival& before) {
  const PathIdentity &a = now.identity, &b = before.identity;
  return a.launched_up == b.launched_up && a.surface_bounces == b.surface_bounces &&
         a.bottom_bounces == b.bottom_bounces && a.upper_turns == b.upper_turns && a.lower_turns == b.lower_turns &&
         now.caustics == before.caustics;
}

}  // namespace

FollowedRays follow_layered_rays(const FlatSea& sea, const RayLink& ray_link, const std::vector<Arrival>& before) {
  const LayeredLink link(sea, ray_link);
  LayeredSpans spans(sea.water, link.upper_m, link.lower_m, sea.bottom_depth_m);
  FollowedRays now;
  now.paths.reserve(before.size());
  for (const Arrival& path : before) {
    LayeredRay ray = ray_of(link, path.identity);
    if (ray.cycles < 0 || !settle(link, spans, std::cos(path.launch_angle_rad) / link.source_speed_mps, ray)) return now;
    const std::size_t count = now.paths.size();
    append_arrival(link, spans, ray, now.paths);
    if (now.paths.size() == count) continue;  // too faint by now
    if (!is_same_path(now.paths.back(), path)) return now;
  }
  finish(now.paths, sea.options);
  now.complete = true;
  return now;
}

}  // namespace halocline::acoustics
