// SPDX-License-Identifier: BSD-3-Clause
// The quality of straight links, millions a second: what acoustics/link/link_budget.h states, for the
// simulator.
//
// Method. Means of slowness and absorption along the leg come from polynomials in depth
// (acoustics/math/depth_means.h) instead of from the formulas of the water; the capacity from as few
// frequencies as the band needs, in vectors (acoustics/link/band_capacity.h). Frequencies are chosen once:
// Gauss-Legendre rules of 8, 16, 24 and 32 nodes over the band, the first of which agrees with that of twice
// as many to 2e-12 of the capacity, for links from 1 m on to where less than a bit a second passes, at the
// surface and at every depth of the profile's rows; else panels (frequency_band.h). Against LinkModel: delay
// 1e-12 of it, level 1e-11 dB, capacity 1e-11 of it or of 1 bit/s, whichever is more; less exact where a cell
// of the profile crosses 20 degrees in Francois and Garrison's formula, which steps there. The same bits on
// every processor, and both ways along a link.
//
//   const LinkKernel kernel(environment, transmitter, receiver);  // once for a pair of modems
//   const LinkBudget link = kernel.budget(from_ned_m, to_ned_m, Capacity::kComputed);
//
// Owns copies of what it needs; immutable, so calls may overlap between threads. Making one takes a
// millisecond. Positions are in the NED world frame, m, depths as those of LinkModel.
#pragma once

#include "acoustics/link/band_capacity.h"
#include "acoustics/link/link_budget.h"
#include "acoustics/math/depth_means.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "core/frames.h"
#include "core/units.h"

namespace halocline::acoustics {

// Loss along a straight path at one frequency.
struct PathLoss {
  double absorption_db_per_km;  // mean along the path
  Decibels total;               // dB; 0 below 1 m
};

// Two thirds of a budget's time go into the capacity: where nobody reads it, it is left out and stays 0.
enum class Capacity { kComputed, kLeftOut };

class LinkKernel {
 public:
  // Throws InvalidArgument when one of them is out of range. `instructions` is among vector_instructions().
  LinkKernel(const Environment& environment, const Modem& transmitter, const Modem& receiver,
             VectorInstructions instructions = vector_instructions().back());

  // Where the noise over the band lies `above_ambient` over that of the environment, its spectrum is taken to
  // have the same shape.
  LinkBudget budget(const Vec3& from_ned_m, const Vec3& to_ned_m, Capacity capacity,
                    Decibels above_ambient = {}) const;
  // As LinkModel::budget_of_path; the capacity as exactly for losses down to 20 dB below that of the straight
  // line.
  LinkBudget budget_of_path(const Vec3& from_ned_m, const Vec3& to_ned_m, Decibels loss, double path_length_m,
                            Capacity capacity, Decibels above_ambient = {}) const;

  // One-way travel time alone, s.
  double delay_s(const Vec3& from_ned_m, const Vec3& to_ned_m) const;
  // Loss at the transmitter's centre frequency over `path_length_m` between two depths: for legs of echoes as
  // well.
  PathLoss path_loss(double from_depth_m, double to_depth_m, double path_length_m) const;

  const Environment& environment() const { return terms_.environment(); }
  const Modem& transmitter() const { return terms_.transmitter(); }
  const Modem& receiver() const { return terms_.receiver(); }
  Decibels noise_level() const { return terms_.noise_level(); }  // over the transmitter's band
  std::size_t frequencies() const { return nodes_.weight_hz.size(); }

 private:
  // By depth below the surface, within the water.
  struct Leg {
    DepthMeans::Place upper, lower;
  };
  Leg leg_between(double from_depth_m, double to_depth_m) const;
  Leg leg_between(const Vec3& from_ned_m, const Vec3& to_ned_m) const;
  double slowness_s_per_m(const Leg& leg) const { return centre_.mean(0, leg.upper, leg.lower); }
  double absorption_db_per_km(const Leg& leg) const { return centre_.mean(1, leg.upper, leg.lower); }
  // All but levels and capacity.
  LinkBudget budget_of_leg(const Leg& leg, const Vec3& from_ned_m, const Vec3& to_ned_m) const;
  double capacity_bps(const Leg& leg, double loss_db, double path_length_m) const;

  LinkTerms terms_;
  BandNodes nodes_;
  DepthMeans centre_;  // slowness in s/m; absorption at the centre frequency in dB/km
  DepthMeans band_;    // absorption at the nodes, dB/km
  BandCapacity band_capacity_;
};

// One link, when only one is wanted.
LinkBudget link_budget(const Environment& environment, const Modem& transmitter, const Modem& receiver,
                       const Vec3& from_ned_m, const Vec3& to_ned_m);

}  // namespace halocline::acoustics
