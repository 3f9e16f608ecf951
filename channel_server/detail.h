// SPDX-License-Identifier: BSD-3-Clause
// Levels of detail: what a channel server leaves out of weak sound and of link tables to save time.
#pragma once

#include "core/units.h"

namespace halocline::channel_server {

enum class Detail { kExact, kFast };

// Constants of one level. NL is the noise level over the sender's band less the receiver's directivity index.
struct DetailLevel {
  // Over a rough bottom a path comes as energy alone where it lies this below the energy flux of all rays, dB
  // (acoustics/rays/eigenray.h); 0: no limit. It is the same at every source level.
  double diffuse_below_flux_db;
  // A path of level L comes as energy alone where L < NL - diffuse_below_noise, dB (RayModel). 100: nowhere,
  // so that no sum of paths depends on the source level.
  Decibels diffuse_below_noise;
  // A link of 10 depths and more whose paths have the levels L_i is its energy flux alone (RayModel) where
  //   10 log10 sum 10^(L_i / 10) < NL - diffuse_below_noise - weak_below_diffuse
  Decibels weak_below_diffuse;
  // Sound of level L disturbs nobody where L < NL - reach_below_noise (propagation/reach.h).
  Decibels reach_below_noise;
  // Nobody notices a preamble that is acquired with P < 1 / acquired_once_in (propagation/reach.h).
  double acquired_once_in;
  // Pairs further apart have no row in link tables, m (propagation/reach.h); 0: no limit.
  double table_range_m;
  // Link tables of N vehicles search for ceil(searches_per_vehicle N) links at a tick, the most audible and
  // most changed first (propagation/search_scheduler.h); 0: for all.
  double searches_per_vehicle;
  // Packets share the searches of link tables (propagation/link_searches.h).
  bool reuse_for_packets;
};

inline constexpr DetailLevel kExactLevel{.diffuse_below_flux_db = 25,
                                         .diffuse_below_noise = Decibels{100},
                                         .weak_below_diffuse = Decibels{100},
                                         .reach_below_noise = Decibels{30},
                                         .acquired_once_in = 1e5,
                                         .table_range_m = 0,
                                         .searches_per_vehicle = 0,
                                         .reuse_for_packets = false};
// Values chosen for the fleets of docs/performance.md, whose modems carry 2 km.
inline constexpr DetailLevel kFastLevel{.diffuse_below_flux_db = 0,
                                        .diffuse_below_noise = Decibels{0},
                                        .weak_below_diffuse = Decibels{0},
                                        .reach_below_noise = Decibels{20},
                                        .acquired_once_in = 1000,
                                        .table_range_m = 4000,
                                        .searches_per_vehicle = 0.5,
                                        .reuse_for_packets = true};

inline const DetailLevel& level_of(Detail detail) {
  return detail == Detail::kFast ? kFastLevel : kExactLevel;
}

}  // namespace halocline::channel_server
