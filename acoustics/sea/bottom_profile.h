// SPDX-License-Identifier: BSD-3-Clause
// The bottom in the vertical plane of a link, in the form that ray tracing needs.
//
// Model: depth is linear between the given points and constant before the first and after the last. Points
// that sample a smooth bottom would create false and missing rays at the corners. Hence, where two facets
// differ by no more than the crease angle, and neither is longer than twice the depth there (longer ones are
// intended slopes, not samples of a curve), the direction of reflection is the mean of both at the common
// point and varies between the points like the unit normal of a curved bottom. Its change along the facet,
// the bend, focuses or spreads the ray tube; it is continuous where it changes little from facet to facet, so
// that a ray tube does not jump there. Both limits are three times as wide
// where the corners on both sides turn the same way by at least half as much, as they do for a coarsely
// sampled curve. At any other corner each facet keeps its own slope. A crease angle of 0 makes all corners
// sharp.
//
// Immutable: calls may overlap between threads. Ranges are from the source, m, ascending; depths below the
// surface, m. Left out: slopes across the link, which turn rays out of its plane.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/units.h"

namespace halocline::acoustics {

// A point of the bottom; m.
struct ProfiledDepth {
  double range_m;
  double depth_m;
  bool operator==(const ProfiledDepth&) const = default;
};

// Default crease angle: facets that turn by more meet in a corner, by less in a bend. 5 degrees separates
// crests from samples of a curve.
inline const double kDefaultCreaseAngle = to_radians(5);

// A straight piece of the bottom, z = z0 + slope (r - r0) for r in r0..r1, m.
struct Facet {
  double r0, r1, z0, slope;
  double shallowest_m;
  double sine, cosine;  // sine and cosine of the facet's angle atan(slope), positive down
  double turn0, turn1;  // reflecting angle at both ends minus the facet's angle, rad
  double bend_per_m;    // mean change of the reflecting angle along the facet, rad / m
  // By how much the change at each end exceeds the mean one, rad a facet's length.
  double excess0, excess1;
  std::uint16_t smooth_group;  // facets between two corners share a number (modulo 65536)
  bool bent() const { return turn0 != 0 || turn1 != 0; }
  // The reflecting angle minus the facet's angle, rad, and its change along the facet, rad / m, at the share
  // u of the facet's length: the cubic through the turns and the changes at both ends.
  double turn_at(double u) const {
    return turn0 + u * (turn1 - turn0) + u * (1 - u) * ((1 - u) * excess0 - u * excess1);
  }
  double bend_at(double u) const {
    const double excess = (1 - u) * (1 - 3 * u) * excess0 - u * (2 - 3 * u) * excess1;
    return bend_per_m + excess * cosine / (r1 - r0);
  }
};

// A bottom of straight or bent facets.
class BottomProfile {
 public:
  // Makes the profile of one or more points; strictly ascending ranges, depths 0.1..12 000 m, crease 0..pi.
  // Throws InvalidArgument.
  explicit BottomProfile(std::vector<ProfiledDepth> points, double crease_angle_rad = kDefaultCreaseAngle);
  static BottomProfile flat(double depth_m) { return BottomProfile({{0, depth_m}}); }

  double depth_at(double range_m) const;
  // True when the bottom is level from 0 to `range_m`.
  bool is_flat_until(double range_m) const;
  // Returns the bottom seen from its other end: the range r becomes range_m - r.
  BottomProfile reversed(double range_m) const;

  const std::vector<ProfiledDepth>& points() const { return points_; }
  const std::vector<Facet>& facets() const { return facets_; }
  // Index of the facet at a range.
  std::size_t facet_at(double range_m) const;
  // Index of the facet at a range that is not before facet `from`; where two facets meet, the first.
  std::size_t facet_from(std::size_t from, double range_m) const {
    while (from + kBlock < facets_.size() && facets_[from + kBlock].r0 < range_m) from += kBlock;
    while (facets_[from].r1 < range_m) ++from;
    return from;
  }
  // True when all blocks from that of facet `from` up to `until_m` are deeper than `depth_m`.
  bool is_deeper_than(double depth_m, std::size_t from, double until_m) const {
    std::size_t block = from / kBlock;
    while (block_shallowest_[block] > depth_m) {
      ++block;
      if (block == block_shallowest_.size() || facets_[block * kBlock].r0 > until_m) return true;
    }
    return false;
  }
  double shallowest_m() const { return shallowest_; }
  double deepest_m() const { return deepest_; }
  // Least depth, m, of the facets of each block [kBlock block, kBlock (block + 1)).
  static constexpr std::size_t kBlock = 8;
  const std::vector<double>& block_shallowest_m() const { return block_shallowest_; }

 private:
  void build_facets();
  void bend_facets();
  bool is_bend(std::size_t i) const;

  std::vector<ProfiledDepth> points_;
  double crease_;
  std::vector<Facet> facets_;
  std::vector<double> block_shallowest_;
  double shallowest_ = 0, deepest_ = 0;
};

}  // namespace halocline::acoustics
