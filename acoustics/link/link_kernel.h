// SPDX-License-Identifier: BSD-3-Clause
// Link budgets of straight links at millions a second: the model of acoustics/link/link_budget.h in the form
// that the simulator uses.
//
// Method. Means of slowness and absorption along the leg come from polynomials in depth
// (acoustics/math/depth_means.h) instead of the formulas of the water. The capacity uses as few frequencies
// as the band needs, in vectors (acoustics/link/band_capacity.h). They are chosen once: of the Gauss-Legendre
// rules of 8, 16, 24 and 32 nodes over the band, the first that agrees with that of twice as many to 2e-12 of
// the capacity, for links from 1 m until less than 1 bit/s passes, at the depths of three rows of the
// profile; otherwise panels (frequency_band.h).
//
// Errors relative to LinkModel: delay 1e-12; level 1e-11 dB; capacity 1e-11 of it or of 1 bit/s, whichever is
// more. They are greater where a cell of the profile crosses 20 degrees in the formula of Francois and
// Garrison, which has a step there. Every processor, and both directions of a link, give the same bits.
//
//   const LinkKernel kernel(environment, transmitter, receiver);  // once for a pair of modems
//   const LinkBudget link = kernel.budget(from_ned_m, to_ned_m, Capacity::kComputed);
//
// Owns copies of its arguments; immutable, so calls may overlap between threads. Construction takes a
// millisecond. Positions are in the NED world frame, m; depths are determined as in LinkModel.
#pragma once

#include "acoustics/link/band_capacity.h"
#include "acoustics/link/link_budget.h"
#include "acoustics/math/depth_means.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "core/frames.h"
#include "core/units.h"

namespace halocline::acoustics {

// The capacity takes two thirds of a budget's time; kLeftOut skips it and leaves it 0.
enum class Capacity { kComputed, kLeftOut };

// Fast link budgets of one pair of modems.
class LinkKernel {
 public:
  // Throws InvalidArgument when an argument is out of range. `instructions` must be among
  // vector_instructions().
  LinkKernel(const Environment& environment, const Modem& transmitter, const Modem& receiver,
             VectorInstructions instructions = vector_instructions().back());

  // Budget between two positions. The noise is `above_ambient` above that of the environment; its spectrum
  // keeps its shape.
  LinkBudget budget(const Vec3& from_ned_m, const Vec3& to_ned_m, Capacity capacity,
                    Decibels above_ambient = {}) const;
  // Budget for a given loss, as LinkModel::budget_of_path; the capacity is as exact for losses down to 20 dB
  // below that of the straight line.
  LinkBudget budget_of_path(const Vec3& from_ned_m, const Vec3& to_ned_m, Decibels loss, double path_length_m,
                            Capacity capacity, Decibels above_ambient = {}) const;

  // Mean absorption at the transmitter's centre frequency along a straight line between two depths, dB/km.
  double absorption_db_per_km(double from_depth_m, double to_depth_m) const;

  const Environment& environment() const { return terms_.environment(); }
  const Modem& transmitter() const { return terms_.transmitter(); }
  const Modem& receiver() const { return terms_.receiver(); }
  Decibels noise_level() const { return terms_.noise_level(); }  // over the transmitter's band
  std::size_t frequencies() const { return nodes_.weight_hz.size(); }

 private:
  // The two depths of a leg below the surface, within the water.
  struct Leg {
    DepthMeans::Place upper, lower;
  };
  Leg leg_between(double from_depth_m, double to_depth_m) const;
  Leg leg_between(const Vec3& from_ned_m, const Vec3& to_ned_m) const;
  double slowness_s_per_m(const Leg& leg) const { return centre_.mean(0, leg.upper, leg.lower); }
  double absorption_db_per_km(const Leg& leg) const { return centre_.mean(1, leg.upper, leg.lower); }
  // Budget without levels and capacity.
  LinkBudget budget_of_leg(const Leg& leg, const Vec3& from_ned_m, const Vec3& to_ned_m) const;
  double capacity_bps(const Leg& leg, double loss_db, double path_length_m) const;

  LinkTerms terms_;
  BandNodes nodes_;
  DepthMeans centre_;  // slowness in s/m; absorption at the centre frequency in dB/km
  DepthMeans band_;    // absorption at the nodes, dB/km
  BandCapacity band_capacity_;
};

// Budget of one link, when only one is needed.
LinkBudget link_budget(const Environment& environment, const Modem& transmitter, const Modem& receiver,
                       const Vec3& from_ned_m, const Vec3& to_ned_m);

}  // namespace halocline::acoustics
