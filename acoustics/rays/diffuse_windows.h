// SPDX-License-Identifier: BSD-3-Clause
// Energy of the rays that a search over a rough bottom does not resolve one by one, summed over windows of
// launch angles.
//
// Model (energy flux: Weston 1971, J. Sound Vib. 18:271; Jensen and others 2011, section 3.3 for A). A window
// of launch angles dtheta contains rays of bounce factor f that a rough bottom has mixed. At the receiver's
// range they are distributed over depth z with the density of one ray that runs up and down the water column,
//   p(z) = cot(angle at z) / (half a cycle),  0 beyond its turning depths.
// The mean, over small displacements, of the sum of A^2 = f^2 xi_s / (xi_r r |d zeta / d theta|) is then
//   f^2 xi_s / (xi_r r) p(z) dtheta,
// with xi = cos(angle) / c at source (s) and receiver (r). Between two rays of one bounce sequence, the slope
// between them replaces p dtheta.
//
// All windows between two rays of the search's first fan make one diffuse path. It has the power of all of
// them, and the delay, angles and bounces of one ray among them. Error: that of a mean over as many rays as
// the path contains.
//
// One object per search, not shared between threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/depth_fan.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/fan_tracer.h"

namespace halocline::acoustics {

class DiffuseWindows {
 public:
  // Refers to the tracer, which has to outlive this object.
  explicit DiffuseWindows(const ArcTracer& tracer);

  // Starts cell number `cell` of the fan, from 0 on: what is added afterwards belongs to it.
  void begin_cell(std::size_t cell);
  // Sets the power, re 1 m and without absorption, that the strongest path is assumed to have; weak paths are
  // judged relative to it.
  void set_reference(double power) { strongest_ = power; }
  // Raises the power, re 1 m and without absorption, below which paths are weak whatever the strongest one
  // has.
  void raise_least(double power) { least_ = std::max(least_, power); }
  // Takes note of a path that was found, which may be the strongest so far.
  void note(const Eigenray& path);
  // True when RayOptions::diffuse_below_pressure or diffuse_below_flux_db, and not the strongest path,
  // decides which paths are weak.
  bool is_by_pressure() const { return least_ > weak_ * strongest_; }

  // True when all paths between two rays of one bounce sequence are weak: more than
  // RayOptions::diffuse_below_db below the strongest path, or below RayOptions::diffuse_below_pressure.
  bool is_weak_branch(const FanRay& a, const FanRay& b) const;
  // True when the paths beside either ray are weak by a margin.
  bool is_weak_beside(const FanRay& a, const FanRay& b) const;
  // True when the paths between two rays are many and would be weak even as a single path.
  bool is_weak_together(const FanRay& a, const FanRay& b) const;

  // Adds the energy between two rays of one bounce sequence, between which zeta passes `images` images of the
  // receiver.
  void add_branch(const FanRay& a, const FanRay& b, int images);
  // Adds the energy between any two rays.
  void add_energy_flux(const FanRay& a, const FanRay& b);
  // The power that add_energy_flux would add, re 1 m.
  double energy_flux(const FanRay& a, const FanRay& b) const;

  // One path for each cell of the fan that has energy, in the order of delays. `cache` may be null.
  std::vector<Eigenray> eigenrays(DepthFanCache* cache) const;

 private:
  struct Cell {
    double branch = 0;           // sum of f^2 xi_s / (xi_r r) / |slope|
    double mixed = 0;            // sum of f^2 xi_s / (xi_r r) dtheta, m; to be multiplied by p
    double theta = 0, most = 0;  // launch angle of the ray with the greatest power so far, and that power
  };
  // f^2 xi_s / (xi_r r) of a ray, which divided by |slope| is its power; 0 when no path of its kind is kept.
  double strength(const FanRay& ray) const;
  // p of the rays of invariant `xi` at the receiver's depth, 1/m.
  double density(double xi) const;
  void weigh(Cell& cell, const FanRay& ray, double power) const;

  // Power, re 1 m and without absorption, below which a path is weak.
  double weak_power() const { return std::max(weak_ * strongest_, least_); }

  const ArcTracer& tracer_;
  double receiver_speed_, max_loss_db_, weak_, least_;
  double strongest_ = 0;
  std::size_t cell_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace halocline::acoustics
