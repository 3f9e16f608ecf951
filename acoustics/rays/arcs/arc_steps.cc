// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/arcs/arc_steps.h"

#include <algorithm>
#include <vector>

#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kTouching = 1e-9;  // m: a point nearer than that to a facet lies on it
constexpr double kMargin = 1e-7;    // m: added to bounds of depth, against rounding

// Returns sin(x). For |x| <= 0.3, which few bends exceed unless the crease angle is wide, it sums the Taylor
// series, to 1e-16.
double sine_of_bend(double x) {
  if (std::abs(x) > 0.3) return elementary::sin(x);
  constexpr double k3 = 1.0 / 6, k5 = k3 / 20, k7 = k5 / 42, k9 = k7 / 72, k11 = k9 / 110;
  const double y = x * x;
  return x * (1 - y * (k3 - y * (k5 - y * (k7 - y * (k9 - y * k11)))));
}

// The slope dz/dr of a straight line from the start of a step, below which the arc never dips. An arc that
// curves down lies above its chord, one that curves up above its tangent:
//   z(x) <= z + slope x,  x the range from the start, z positive down.
double deepest_slope(double curvature, const ArcPoint& s, const ArcStep& step) {
  if (curvature > 0 && step.dr > 0) return (step.z - s.z) / step.dr;
  return curvature == 0 && step.z == s.z ? 0 : s.sine * s.per_xi / s.c;
}

// Returns half of the curvature of an arc that curves down, 1/m; 0 for any other arc. The arc has
//   d2z/dr2 = kappa / cos^3 >= kappa,
// so after the range x it lies above its chord by at least (kappa / 2) x (dr - x).
double bow_of(double curvature, const ArcStep& step) {
  return curvature > 0 && step.dr > 0 ? curvature / 2 : 0;
}

// Intersects the ray's circle with the line of a facet, y = d + b x; x and y are measured from the ray, along
// range and down. With the curvature kappa the circle is kappa (x^2 + y^2) / 2 = y cos - x sin, so that
//   A x^2 + B x + C = 0,
//   A = kappa (1 + b^2) / 2,  B = kappa d b + sin - b cos,  C = kappa d^2 / 2 - d cos.
// A ray that starts on the facet (d = 0) meets it again at x = -B / A. Returns false when the root lies
// outside of the facet or beyond `until`.
bool solve_facet(double curvature, const Facet& facet, const ArcPoint& s, bool on_it, double until,
                 double& dr) {
  const double st = s.sine, ct = s.xi * s.c, b = facet.slope;
  double d = facet.z0 + b * (s.r - facet.r0) - s.z;  // depth of the line below the ray, m
  double x;
  if (on_it) {
    const double a2 = curvature * (1 + b * b) / 2, b2 = st - ct * b;
    x = b2 < 0 && a2 > 0 ? -b2 / a2 : -1;
  } else {
    if (std::abs(d) < kTouching) d = std::max(d, 0.0);
    const double a2 = curvature * (1 + b * b) / 2, b2 = curvature * d * b + st - ct * b;
    const double c2 = curvature * d * d / 2 - ct * d, disc = b2 * b2 - 4 * a2 * c2;
    const double root = disc >= 0 ? std::sqrt(disc) : -1, bottom = b2 + root;
    // The root at which the ray crosses the line downwards is the intersection. A ray that bends down and
    // lies below the line, extended beyond its facet (before a crest), first crosses it upwards.
    if (root < 0) return false;
    x = bottom > 0 ? -2 * c2 / bottom : c2 > 0 && a2 > 0 ? (root - b2) / (2 * a2) : -1;
  }
  const double first = std::max(facet.r0 - s.r, 0.0), last = std::min(facet.r1 - s.r, until);
  if (!(x >= first - kTouching && x <= last + kTouching)) return false;
  dr = std::clamp(x, first, std::max(first, last));
  return true;
}

}  // namespace

bool find_hit(double curvature, const BottomProfile& profile, const ArcPoint& s, const ArcStep& step,
              double until, ArcHit& hit) {
  const std::vector<Facet>& facets = profile.facets();
  const std::vector<double>& blocks = profile.block_shallowest_m();
  const double end = s.r + until, slope = deepest_slope(curvature, s, step), bow = bow_of(curvature, step);
  // Upper bound of the arc's depth after the range `way`, m. It is a straight line or convex, so over any
  // interval it is greatest at an end.
  const auto deepest = [&](double way) { return s.z + way * (slope - bow * (step.dr - way)) + kMargin; };
  // True when the arc stays shallower than `shallowest` between the ranges r0 and r1.
  const auto below = [&](double shallowest, double r0, double r1) {
    return std::max(deepest(std::max(r0 - s.r, 0.0)), deepest(std::min(r1, end) - s.r)) < shallowest;
  };
  // True when the arc stays above the facet's line at both ends of the facet, and so above all of it.
  const auto misses = [&](const Facet& facet) {
    const double first = std::max(facet.r0, s.r), last = std::min(facet.r1, end);
    return deepest(first - s.r) < facet.z0 + facet.slope * (first - facet.r0) &&
           deepest(last - s.r) < facet.z0 + facet.slope * (last - facet.r0);
  };
  std::size_t i = s.facet;
  // The arc cannot meet the bottom before it is as deep as the shallowest bottom on its way.
  if (slope > 0) {
    double shallowest = blocks[i / BottomProfile::kBlock];
    for (std::size_t next = i / BottomProfile::kBlock + 1;
         next < blocks.size() && facets[next * BottomProfile::kBlock].r0 <= end; ++next) {
      shallowest = std::min(shallowest, blocks[next]);
    }
    i = profile.facet_from(i, std::min(s.r + (shallowest - kMargin - s.z) / slope, end));
  }
  while (i < facets.size() && facets[i].r0 <= end) {
    const std::size_t block = i / BottomProfile::kBlock,
                      next = std::min((block + 1) * BottomProfile::kBlock, facets.size());
    if (below(blocks[block], facets[i].r0, facets[next - 1].r1)) {
      i = next;
      continue;
    }
    for (; i < next && facets[i].r0 <= end; ++i) {
      if (misses(facets[i])) continue;
      if (solve_facet(curvature, facets[i], s, s.on_facet && i == s.facet, until, hit.dr)) {
        hit.facet = i;
        return true;
      }
    }
  }
  return false;
}

// Specular reflection, by sums and differences of angles a (of the ray, positive down) and b (of the slope):
//   sin(a - b) = sin a cos b - cos a sin b,  cos(a - b) = cos a cos b + sin a sin b
// On a bent facet the reflecting angle b + t changes from t = turn0 to turn1 along the facet.
FacetBounce bounce_off(const Facet& facet, const ArcPoint& s) {
  const double ct = s.xi * s.c, st = s.sine;
  double sine = facet.sine, cosine = facet.cosine, bend = 0;  // the reflecting slope
  const double grazing_facet = st * cosine - ct * sine;       // sin(angle - slope)
  if (facet.bent()) {
    const double share = (s.r - facet.r0) / (facet.r1 - facet.r0);
    const double ts = sine_of_bend(facet.turn_at(share)), tc = std::sqrt(1 - ts * ts);
    const double bent_sine = sine * tc + cosine * ts, bent_cosine = cosine * tc - sine * ts;
    // The facet's own slope reflects when a ray reflected by the bent slope would enter the facet, or when
    // the ray does not meet the bent slope from above.
    const double grazing = st * bent_cosine - ct * bent_sine;
    const double leaving =
        grazing * tc - (ct * bent_cosine + st * bent_sine) * ts;  // sin(angle - 2 bent + own)
    if (grazing > kMinSine && leaving > kMinSine) {
      sine = bent_sine;
      cosine = bent_cosine;
      bend = facet.bend_at(share);
    }
  }
  // The reflected ray leaves at the angle slope - G, with the grazing angle G = angle - slope.
  const double sin_g = std::max(st * cosine - ct * sine, kMinSine), cos_g = ct * cosine + st * sine;
  return {sin_g,
          cos_g,
          sine * cos_g - cosine * sin_g,
          cosine * cos_g + sine * sin_g,
          std::max(grazing_facet, kMinSine),
          bend};
}

}  // namespace halocline::acoustics
