// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/arcs/arc_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kTouching = 1e-9;  // m: nearer than that to a facet is on it
constexpr double kMargin = 1e-7;    // m: added to bounds of depth

// sin(x) to 1e-16 by its series for |x| up to 0.3, which is more than half of any bend but those of a wide
// crease angle.
double sine_of_bend(double x) {
  if (std::abs(x) > 0.3) return elementary::sin(x);
  constexpr double k3 = 1.0 / 6, k5 = k3 / 20, k7 = k5 / 42, k9 = k7 / 72, k11 = k9 / 110;
  const double y = x * x;
  return x * (1 - y * (k3 - y * (k5 - y * (k7 - y * (k9 - y * k11)))));
}

// The arc of a step stays above z + slope * (way): curving up above its tangent, curving down above its
// chord.
double deepest_slope(double curvature, const ArcPoint& s, const ArcStep& step) {
  if (curvature > 0 && step.dr > 0) return (step.z - s.z) / step.dr;
  return curvature == 0 && step.z == s.z ? 0 : s.sine * s.per_xi / s.c;
}

// An arc that curves down has d2z/dr2 = kappa / cos^3 >= kappa, so it stays above its chord by at least
// kappa / 2 x (dr - x) after the way x: kappa / 2.
double bow_of(double curvature, const ArcStep& step) {
  return curvature > 0 && step.dr > 0 ? curvature / 2 : 0;
}

// Where the ray's circle meets the facet's line y = d + b x, x and y from the ray along r and down. With
// kappa the curvature, kappa (x^2 + y^2) / 2 = cos y - sin x, so A x^2 + B x + C = 0:
//   A = kappa (1 + b^2) / 2,  B = kappa d b + sin - b cos,  C = kappa d^2 / 2 - d cos.
bool solve_facet(double curvature, const Facet& facet, const ArcPoint& s, bool on_it, double until,
                 double& dr) {
  const double st = s.sine, ct = s.xi * s.c, b = facet.slope;
  double d = facet.z0 + b * (s.r - facet.r0) - s.z;  // how far the line is below the ray
  double x;
  if (on_it) {
    const double a2 = curvature * (1 + b * b) / 2, b2 = st - ct * b;
    x = b2 < 0 && a2 > 0 ? -b2 / a2 : -1;
  } else {
    if (std::abs(d) < kTouching) d = std::max(d, 0.0);
    const double a2 = curvature * (1 + b * b) / 2, b2 = curvature * d * b + st - ct * b;
    const double c2 = curvature * d * d / 2 - ct * d, disc = b2 * b2 - 4 * a2 * c2;
    const double root = disc >= 0 ? std::sqrt(disc) : -1, bottom = b2 + root;
    // The root at which the ray goes down through the line. Below the line drawn on beyond its facet (before
    // a crest), a ray that bends down passes it upwards first.
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
  // The deepest that the arc can be after `way`; a line or curving down, so deepest at an end of any
  // interval.
  const auto deepest = [&](double way) { return s.z + way * (slope - bow * (step.dr - way)) + kMargin; };
  const auto below = [&](double shallowest, double r0, double r1) {  // the arc cannot reach down there
    return std::max(deepest(std::max(r0 - s.r, 0.0)), deepest(std::min(r1, end) - s.r)) < shallowest;
  };
  const auto misses = [&](const Facet& facet) {  // its line, above which the arc stays at both its ends
    const double first = std::max(facet.r0, s.r), last = std::min(facet.r1, end);
    return deepest(first - s.r) < facet.z0 + facet.slope * (first - facet.r0) &&
           deepest(last - s.r) < facet.z0 + facet.slope * (last - facet.r0);
  };
  std::size_t i = s.facet;
  if (slope > 0) {  // before it is as deep as the shallowest bottom on its way there is nothing to meet
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

FacetBounce bounce_off(const Facet& facet, const ArcPoint& s) {
  const double ct = s.xi * s.c, st = s.sine;
  double sine = facet.sine, cosine = facet.cosine, bend = facet.bend_per_m;  // of the slope that reflects
  const double grazing_facet = st * cosine - ct * sine;                      // sin(angle - slope)
  if (facet.bent()) {
    const double share = (s.r - facet.r0) / (facet.r1 - facet.r0);
    const double turn = facet.turn0 + share * (facet.turn1 - facet.turn0), ts = sine_of_bend(turn),
                 tc = std::sqrt(1 - ts * ts);
    const double bent_sine = sine * tc + cosine * ts, bent_cosine = cosine * tc - sine * ts;
    // Where the bent slope would throw the ray into the facet, or did not meet it at all, the facet's own
    // reflects.
    const double grazing = st * bent_cosine - ct * bent_sine;
    const double leaving =
        grazing * tc - (ct * bent_cosine + st * bent_sine) * ts;  // sin(angle - 2 bent + own)
    if (grazing > kMinSine && leaving > kMinSine) {
      sine = bent_sine;
      cosine = bent_cosine;
    } else {
      bend = 0;
    }
  }
  // G = angle - slope; mirrored, the ray leaves at the angle slope - G.
  const double sin_g = std::max(st * cosine - ct * sine, kMinSine), cos_g = ct * cosine + st * sine;
  return {sin_g,
          cos_g,
          sine * cos_g - cosine * sin_g,
          cosine * cos_g + sine * sin_g,
          std::max(grazing_facet, kMinSine),
          bend};
}

}  // namespace halocline::acoustics
