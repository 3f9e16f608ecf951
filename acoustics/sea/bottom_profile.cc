// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/bottom_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acoustics/sea/sound_speed_profile.h"
#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kFar = 1e9;  // m, end of the level pieces at both sides
// Greatest length of a facet that samples a curve, in depths of the water there.
constexpr double kLongestInDepths = 2;
// Least ratio of a neighbouring turn to this one where a curve is sampled.
constexpr double kMinShareOfBend = 0.5;
constexpr double kPatienceAmongBends = 3;  // factor on both limits between such neighbours
// The bend becomes continuous where it changes little from facet to facet, and fades back to its step where
// it changes by a sixteenth of itself, as over a rough bottom, of which cubics would make more than it has.
constexpr double kIrregular = 32;

// The straight facet from one point to the next.
Facet facet_between(const ProfiledDepth& a, const ProfiledDepth& b) {
  const double slope = (b.depth_m - a.depth_m) / (b.range_m - a.range_m),
               hypotenuse = elementary::hypot(1.0, slope);
  return {a.range_m,
          b.range_m,
          a.depth_m,
          slope,
          std::min(a.depth_m, b.depth_m),
          slope / hypotenuse,
          1 / hypotenuse,
          0,
          0,
          0,
          0,
          0,
          0};
}

}  // namespace

BottomProfile::BottomProfile(std::vector<ProfiledDepth> points, double crease_angle_rad)
    : points_(std::move(points)), crease_(crease_angle_rad) {
  require(!points_.empty(), "a bottom profile needs at least one point");
  require_in_range(crease_, 0, std::numbers::pi, "crease angle of a bottom profile", "rad");
  for (std::size_t i = 0; i < points_.size(); ++i) {
    require_in_range(points_[i].range_m, -1e7, 1e7, "range of a bottom profile", "m");
    require_in_range(points_[i].depth_m, 0.1, kDeepestWater, "depth of a bottom profile", "m");
    require(i == 0 || points_[i].range_m > points_[i - 1].range_m,
            "the ranges of a bottom profile do not rise");
  }
  build_facets();
  bend_facets();
}

void BottomProfile::build_facets() {
  const auto [low, high] = std::minmax_element(
      points_.begin(), points_.end(), [](const auto& a, const auto& b) { return a.depth_m < b.depth_m; });
  shallowest_ = low->depth_m;
  deepest_ = high->depth_m;
  facets_.push_back(facet_between({-kFar, points_.front().depth_m}, points_.front()));
  for (std::size_t i = 0; i + 1 < points_.size(); ++i)
    facets_.push_back(facet_between(points_[i], points_[i + 1]));
  facets_.push_back(facet_between(points_.back(), {kFar, points_.back().depth_m}));
  for (std::size_t first = 0; first < facets_.size(); first += kBlock) {
    double shallowest = facets_[first].shallowest_m;
    for (std::size_t i = first; i < std::min(first + kBlock, facets_.size()); ++i) {
      shallowest = std::min(shallowest, facets_[i].shallowest_m);
    }
    block_shallowest_.push_back(shallowest);
  }
}

// True when facets i - 1 and i sample a smooth curve at their common point.
bool BottomProfile::is_bend(std::size_t i) const {
  const auto turn_at = [this](std::size_t k) {
    return k > 0 && k < facets_.size()
               ? elementary::atan(facets_[k].slope) - elementary::atan(facets_[k - 1].slope)
               : 0;
  };
  const auto length = [](const Facet& facet) { return facet.r1 - facet.r0; };
  const double turn = turn_at(i);
  const bool among_bends = std::min(turn_at(i - 1) / turn, turn_at(i + 1) / turn) >= kMinShareOfBend;
  const double patience = among_bends ? kPatienceAmongBends : 1;
  return std::abs(turn) <= patience * crease_ &&
         std::max(length(facets_[i - 1]), length(facets_[i])) <= patience * kLongestInDepths * facets_[i].z0;
}

void BottomProfile::bend_facets() {
  for (std::size_t i = 1; i < facets_.size(); ++i) {
    Facet &left = facets_[i - 1], &right = facets_[i];
    const double turn = elementary::atan(right.slope) - elementary::atan(left.slope);
    right.smooth_group = left.smooth_group;
    if (turn == 0) continue;  // a straight continuation: no corner that separates rays
    // The reflecting direction at the common point of a bend is the mean of both facets: half the turn from
    // each.
    if (is_bend(i)) {
      left.turn1 = turn / 2;
      right.turn0 = -turn / 2;
    } else {
      ++right.smooth_group;
    }
  }
  // Change of the turn along the facet, d(turn)/ds = (turn1 - turn0) / length, length = (r1 - r0) / cosine.
  for (Facet& facet : facets_)
    facet.bend_per_m = (facet.turn1 - facet.turn0) * facet.cosine / (facet.r1 - facet.r0);
  for (std::size_t i = 1; i < facets_.size(); ++i) {
    Facet &left = facets_[i - 1], &right = facets_[i];
    if (left.turn1 == 0) continue;
    const double change = right.bend_per_m - left.bend_per_m;
    const double all = std::abs(right.bend_per_m) + std::abs(left.bend_per_m);
    const double half = 0.5 * change * std::max(1 - kIrregular * std::abs(change) / all, 0.0);
    left.excess1 = half * (left.r1 - left.r0) / left.cosine;
    right.excess0 = -half * (right.r1 - right.r0) / right.cosine;
  }
}

std::size_t BottomProfile::facet_at(double range_m) const {
  const auto next = std::upper_bound(facets_.begin() + 1, facets_.end(), range_m,
                                     [](double range, const Facet& facet) { return range < facet.r0; });
  return static_cast<std::size_t>(next - facets_.begin() - 1);
}

double BottomProfile::depth_at(double range_m) const {
  const Facet& facet = facets_[facet_at(range_m)];
  return facet.z0 + facet.slope * (range_m - facet.r0);
}

bool BottomProfile::is_flat_until(double range_m) const {
  for (std::size_t i = facet_at(0); i < facets_.size() && facets_[i].r0 < range_m; ++i) {
    if (facets_[i].slope != 0 || facets_[i].bent()) return false;
  }
  return true;
}

BottomProfile BottomProfile::reversed(double range_m) const {
  std::vector<ProfiledDepth> turned;
  for (const ProfiledDepth& point : points_) turned.push_back({range_m - point.range_m, point.depth_m});
  std::reverse(turned.begin(), turned.end());
  return BottomProfile(std::move(turned), crease_);
}

}  // namespace halocline::acoustics
