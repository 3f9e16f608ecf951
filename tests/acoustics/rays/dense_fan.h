// SPDX-License-Identifier: BSD-3-Clause
// All rays between two points of layered water over a flat bottom, found the slow and plain way: an
// independent reference for tests.
//
// Each ray of a dense fan is followed layer by layer, in long double, with none of the formulas of the
// solvers: angles by Snell's law, arcs of circles by differences of sines and cosines. Wherever it passes the
// receiver's depth its range and history are noted. Two neighbours of the fan whose passages of one history
// lie on both sides of the receiver hold an eigenray between them, which bisection finds. The fan is denser
// towards the angles that graze a knot. Pairs of rays nearer than neighbours of the fan are missed: the fan
// may lack a faint pair, it never invents one.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/sound_speed_profile.h"

namespace halocline::acoustics {

struct FanEigenray {
  double delay_s, launch_angle_rad;
  int surface_bounces, bottom_bounces;
};

class DenseFan {
 public:
  DenseFan(std::vector<SpeedRow> knots, double bottom_m, RayLink link)
      : bottom_(bottom_m),
        source_(link.source_depth_m),
        receiver_(link.receiver_depth_m),
        range_(link.range_m) {
    if (knots.front().depth_m > 0) knots.insert(knots.begin(), {0, knots.front().sound_speed_mps});
    if (knots.back().depth_m < bottom_m) knots.push_back({bottom_m, knots.back().sound_speed_mps});
    for (const SpeedRow& row : knots) {
      if (row.depth_m < bottom_m) levels_.push_back({row.depth_m, row.sound_speed_mps});
    }
    const auto below =
        std::find_if(knots.begin(), knots.end(), [&](const SpeedRow& r) { return r.depth_m >= bottom_m; });
    const SpeedRow &a = *(below - 1), &b = *below;
    levels_.push_back(
        {bottom_m, a.sound_speed_mps + static_cast<Real>(b.sound_speed_mps - a.sound_speed_mps) *
                                           (bottom_m - a.depth_m) / (b.depth_m - a.depth_m)});
    add_level(source_);
    add_level(receiver_);
  }

  // Rays launched within `steepest_rad` with at most `max_bottom_bounces`, from a fan of `count` even steps.
  std::vector<FanEigenray> search(double steepest_rad, int max_bottom_bounces, int count) {
    max_bottom_ = max_bottom_bounces;
    std::vector<FanEigenray> found;
    std::vector<Passage> before, next;
    const std::vector<Real> angles = fan(steepest_rad, count);
    follow(angles.front(), before);
    for (std::size_t i = 1; i < angles.size(); ++i) {
      follow(angles[i], next);
      compare(angles[i - 1], angles[i], before, next, found);
      std::swap(before, next);
    }
    return found;
  }

 private:
  using Real = long double;
  struct Level {
    Real z, c;
  };
  // One passage of the receiver's depth.
  struct Passage {
    Real r, time;
    int surface, bottom, turns;
  };

  Real speed(Real z) const {
    std::size_t i = 0;
    while (i + 2 < levels_.size() && levels_[i + 1].z < z) ++i;
    return levels_[i].c +
           (levels_[i + 1].c - levels_[i].c) * (z - levels_[i].z) / (levels_[i + 1].z - levels_[i].z);
  }

  void add_level(Real z) {
    const Real c = speed(z);
    const auto at =
        std::lower_bound(levels_.begin(), levels_.end(), z, [](const Level& l, Real d) { return l.z < d; });
    if (at == levels_.end() || at->z != z) levels_.insert(at, {z, c});
  }

  std::vector<Real> fan(double steepest, int count) const {
    std::vector<Real> angles;
    for (int i = 0; i <= count; ++i)
      angles.push_back(-steepest + 2 * static_cast<Real>(steepest) * i / count);
    const Real here = speed(source_);
    for (const Level& level : levels_) {
      if (level.c < here) continue;
      const Real critical = std::acos(here / level.c);
      for (Real off = 3e-2L; off > 1e-9L; off *= 0.7L) {
        for (const Real side : {-1.0L, 1.0L}) {
          angles.push_back(critical + side * off);
          angles.push_back(-critical - side * off);
        }
      }
    }
    std::erase_if(angles, [steepest](Real a) { return std::abs(a) > static_cast<Real>(steepest); });
    std::sort(angles.begin(), angles.end());
    return angles;
  }

  void follow(Real theta, std::vector<Passage>& passages) const {
    passages.clear();
    const Real xi = std::cos(theta) / speed(source_);
    auto at = static_cast<std::size_t>(
        std::find_if(levels_.begin(), levels_.end(), [&](const Level& l) { return l.z == source_; }) -
        levels_.begin());
    bool down = theta > 0;
    Real r = 0, time = 0;
    int surface = 0, bottom = 0, turns = 0;
    // A ray that hardly leaves the axis of a duct turns without end.
    for (int step = 0; step < 4000 && r < 1.5L * range_ + 1000 && bottom <= max_bottom_; ++step) {
      if (down && at + 1 == levels_.size()) {
        ++bottom;
        down = false;
      } else if (!down && at == 0) {
        ++surface;
        down = true;
      }
      const Level& from = levels_[at];
      const Level& to = levels_[down ? at + 1 : at - 1];
      const Real k1 = xi * from.c, k2 = xi * to.c, s1 = std::sqrt(std::max(1 - k1 * k1, Real{0}));
      const Real g = (to.c - from.c) / std::abs(to.z - from.z);
      if (k2 >= 1) {  // an arc back to the same depth
        r += 2 * s1 / (xi * g);
        time += 2 * std::log((1 + s1) / k1) / g;
        ++turns;
        down = !down;
      } else {
        const Real s2 = std::sqrt(1 - k2 * k2), h = std::abs(to.z - from.z);
        r += std::abs(g) < 1e-12L ? h * k1 / s1 : (s1 - s2) / (xi * g);
        time += std::abs(g) < 1e-12L ? h / (from.c * s1) : std::log(k2 * (1 + s1) / (k1 * (1 + s2))) / g;
        at = down ? at + 1 : at - 1;
      }
      if (levels_[at].z == receiver_) passages.push_back({r, time, surface, bottom, turns});
    }
  }

  void compare(Real low, Real high, const std::vector<Passage>& a, const std::vector<Passage>& b,
               std::vector<FanEigenray>& found) const {
    for (std::size_t m = 0; m < std::min(a.size(), b.size()); ++m) {
      if (!alike(a[m], b[m]) || (a[m].r < range_) == (b[m].r < range_)) continue;
      const bool rising = b[m].r > a[m].r;
      Real from = low, to = high;
      std::vector<Passage> middle;
      for (int i = 0; i < 70; ++i) {
        const Real theta = (from + to) / 2;
        follow(theta, middle);
        if (middle.size() <= m || !alike(middle[m], a[m])) break;
        ((middle[m].r > range_) == rising ? to : from) = theta;
      }
      if (middle.size() <= m || std::abs(middle[m].r - range_) > 1e-4L) continue;
      found.push_back({static_cast<double>(middle[m].time), static_cast<double>((from + to) / 2),
                       middle[m].surface, middle[m].bottom});
    }
  }

  static bool alike(const Passage& a, const Passage& b) {
    return a.surface == b.surface && a.bottom == b.bottom && a.turns == b.turns;
  }

  Real bottom_, source_, receiver_, range_;
  int max_bottom_ = 0;
  std::vector<Level> levels_;
};

}  // namespace halocline::acoustics
