// SPDX-License-Identifier: BSD-3-Clause
// The sound of rays that a search over a rough bottom does not seek one by one: windows of launch angles and
// their energy.
//
// Model. A window of launch angles dtheta holds rays of bounce factor f that a rough bottom has mixed: at the
// receiver's range they lie at depth z with the density of one that goes up and down the water column,
//   p(z) = cot(angle at z) / (half a cycle), 0 beyond its turning depths,
// so the mean over small changes of place of the sum of A^2 = f^2 xi_s / (xi_r r |d zeta / d theta|) is
//   f^2 xi_s / (xi_r r) p(z) dtheta,
// xi = cos(angle) / c at source and receiver (energy flux: Weston 1971, J. Sound Vib. 18:271; Jensen and
// others 2011, section 3.3 for A). Between two rays of one history the slope between them takes the place of
// p dtheta.
//
// Windows between two rays of the search's first fan make one arrival, with the power of all of them and the
// delay, angles and bounces of a ray among them. Error: that of a mean over as many rays as it holds.
//
// One for each search, not shared between threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/arrivals.h"
#include "acoustics/rays/column_rays.h"
#include "acoustics/rays/fan_tracer.h"

namespace halocline::acoustics {

class DiffuseWindows {
 public:
  // Refers to the tracer, which has to outlive this.
  explicit DiffuseWindows(const ArcTracer& tracer);

  // What is added from now on lies in the cell of the fan of this number, from 0 on.
  void begin_cell(std::size_t cell);
  // A path as strong as this, re 1 m without absorption, is not weak.
  void set_reference(double power) { strongest_ = power; }
  // A path that was found: others are weak relative to the strongest.
  void note(const Arrival& path);
  // Whether RayOptions::diffuse_below_pressure, not the strongest path, says what is weak.
  bool is_by_pressure() const { return least_ > weak_ * strongest_; }

  // Whether all paths between two rays of one history are weak: more than RayOptions::diffuse_below_db below
  // the strongest, or below its pressure.
  bool is_weak_branch(const FanRay& a, const FanRay& b) const;
  // Whether those beside either ray are so by a margin.
  bool is_weak_beside(const FanRay& a, const FanRay& b) const;
  // Whether all paths between two, which are many, are weak even if they were one.
  bool is_weak_together(const FanRay& a, const FanRay& b) const;

  // The energy between two rays of one history between which zeta passes `images` of the receiver.
  void add_branch(const FanRay& a, const FanRay& b, int images);
  // Between any two.
  void add_mixed(const FanRay& a, const FanRay& b);
  // As add_mixed would add, re 1 m.
  double mixed_power(const FanRay& a, const FanRay& b) const;

  // One for each cell of the fan that has energy, in the order of delays. `cache` may be null.
  std::vector<Arrival> arrivals(ColumnCache* cache) const;

 private:
  struct Cell {
    double branch = 0;           // f^2 xi_s / (xi_r r) / |slope|, sum
    double mixed = 0;            // f^2 xi_s / (xi_r r) dtheta, m, sum; times p
    double theta = 0, most = 0;  // launch angle of the ray with the greatest share so far, and that
  };
  // f^2 xi_s / (xi_r r) of a ray: times 1 / |slope| its power. 0 where no path of its kind is kept.
  double strength(const FanRay& ray) const;
  double density(double xi) const;
  void weigh(Cell& cell, const FanRay& ray, double power) const;

  // Paths of less, re 1 m without absorption, are weak.
  double weak_power() const { return std::max(weak_ * strongest_, least_); }

  const ArcTracer& tracer_;
  double receiver_speed_, max_loss_db_, weak_, least_;
  double strongest_ = 0;
  std::size_t cell_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace halocline::acoustics
