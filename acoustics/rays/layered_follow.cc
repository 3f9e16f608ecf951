// Following of Snell rays from where they were: see acoustics/rays/layered_rays.h.
#include <cmath>
#include <numbers>

#include "acoustics/rays/layered_path.h"
#include "acoustics/rays/layered_rays.h"

namespace halocline::acoustics {
namespace {

// Newton's method at full steps, then, where that left the branch, at short ones.
struct Pace {
  double share;
  int most_steps;
};
constexpr Pace kPaces[] = {{1, 10}, {0.3, 40}};

// Family and cycles of a path: how often it ran U and D follows from its bounces and turns, and where those
// are equal from the way it left.
LayeredRay ray_of(const LayeredLink& link, const PathIdentity& id) {
  const int above = id.surface_bounces + id.upper_turns, below = id.bottom_bounces + id.lower_turns;
  Family family{above > below, below > above};
  if (above == below) family.up = family.down = link.source_is_upper == id.launched_up;
  return {family, above - (family.up ? 1 : 0), 0, 1};
}

// Newton's method in the angle at the barrier, which changes as the ray passes knots. False when it does not
// settle; else `sums` are those of the ray.
bool settle(const LayeredLink& link, LayeredSpans& spans, double xi, Pace pace, LayeredRay& ray,
            SpanSums& sums) {
  double off_before = kNotYet;
  for (int i = 0; i < pace.most_steps; ++i) {
    if (!spans.seek(xi)) xi = (1 - 1e-12) / spans.barrier_mps();
    if (!spans.seek(xi)) return false;
    ray.cosine = xi * spans.barrier_mps();
    ray.sine = std::sqrt((1 - ray.cosine) * (1 + ray.cosine));
    sums = spans.sums(ray.sine, ray.cosine);
    const RangeTerms t = range_terms(sums, ray.family);
    const double off = link.range_m - xi * (t.bq + ray.cycles * t.xq);
    if (is_settled(off, off_before)) return true;
    off_before = off;
    // dr/dtheta = dr/dxi dxi/dtheta, dxi/dtheta = -sin / c*.
    const double slope = -(t.bm + ray.cycles * t.xm) * ray.sine / spans.barrier_mps();
    if (slope == 0) return false;
    const double step = pace.share * off / slope, sine_step = std::sin(step), cosine_step = std::cos(step);
    const bool beyond = !(std::abs(step) < 1) || ray.sine * cosine_step + ray.cosine * sine_step <= 0;
    // Half the angle when the step would pass the horizontal.
    const double cosine =
        beyond ? std::sqrt((1 + ray.cosine) / 2) : ray.cosine * cosine_step - ray.sine * sine_step;
    xi = cosine / spans.barrier_mps();
  }
  return false;
}

// The path as it is now at the end of `paths`; false when it was lost or is too faint.
bool follow_path(const LayeredLink& link, LayeredSpans& spans, const Arrival& before,
                 std::vector<Arrival>& paths) {
  LayeredRay ray = ray_of(link, before.identity);
  SpanSums sums;
  if (ray.cycles < 0) return false;
  for (const Pace pace : kPaces) {
    if (!settle(link, spans, before.launch_slowness_spm, pace, ray, sums)) continue;
    const std::size_t count = paths.size();
    append_arrival(link, spans, ray, sums, paths);
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
