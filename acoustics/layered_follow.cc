// Following of Snell rays from where they were: see acoustics/layered_rays.h.
#include <cmath>
#include <numbers>

#include "acoustics/layered_path.h"
#include "acoustics/layered_rays.h"

namespace halocline::acoustics {
namespace {

// Newton's method at full steps, then, where that left the branch, at short ones.
struct Pace {
  double share;
  int most_steps;
};
constexpr Pace kPaces[] = {{1, 10}, {0.3, 40}};
constexpr double kRangeTolerance = 1e-4;  // m before the last step, as in the search

// Family and cycles of a path: how often it ran U and D follows from its bounces and turns, and where those
// are equal from the way it left.
LayeredRay ray_of(const LayeredLink& link, const PathIdentity& id) {
  const int above = id.surface_bounces + id.upper_turns, below = id.bottom_bounces + id.lower_turns;
  Family family{above > below, below > above};
  if (above == below) family.up = family.down = link.source_is_upper == id.launched_up;
  return {family, above - (family.up ? 1 : 0), 0, 1};
}

// Newton's method in the angle at the barrier, which changes as the ray passes knots. False when it does not
// settle.
bool settle(const LayeredLink& link, LayeredSpans& spans, double xi, Pace pace, LayeredRay& ray) {
  bool last = false;
  for (int i = 0; i < pace.most_steps; ++i) {
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
    last = std::abs(off) < kRangeTolerance;
    const double theta = std::atan2(ray.sine, ray.cosine),
                 next = theta + (last ? 1 : pace.share) * off / slope;
    xi = std::cos(next > 0 ? next : theta / 2) / spans.barrier_mps();
  }
  return false;
}

// The path as it is now at the end of `paths`; false when it was lost or is too faint.
bool follow_path(const LayeredLink& link, LayeredSpans& spans, const Arrival& before,
                 std::vector<Arrival>& paths) {
  LayeredRay ray = ray_of(link, before.identity);
  if (ray.cycles < 0) return false;
  for (const Pace pace : kPaces) {
    if (!settle(link, spans, before.launch_slowness_spm, pace, ray)) continue;
    const std::size_t count = paths.size();
    append_arrival(link, spans, ray, spans.sums(ray.sine, ray.cosine), paths);
    if (paths.size() == count) return false;
    if (is_followed(paths, before)) return true;
    paths.pop_back();
  }
  return false;
}

}  // namespace

FollowedRays follow_layered_rays(const FlatSea& sea, const RayLink& ray_link,
                                 const std::vector<Arrival>& before) {
  const LayeredLink link(sea, ray_link);
  LayeredSpans spans(sea.water, link.upper_m, link.lower_m, sea.bottom_depth_m);
  return follow_each(before, sea.options, [&](const Arrival& path, std::vector<Arrival>& paths) {
    return follow_path(link, spans, path, paths);
  });
}

}  // namespace halocline::acoustics
