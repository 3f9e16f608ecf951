// SPDX-License-Identifier: BSD-3-Clause
// Levels of detail: what a channel server leaves out of weak sound and of link tables to save time.
//
// For N vehicles, a link of range r with paths of levels L_p, and the noise level NL over the sender's band
// less the receiver's directivity index, all in dB:
//
//   L_p < NL - diffuse_below_noise                a path comes as energy alone
//   (RayModel::diffuse_below_noise) 10 log10 sum 10^(L_p / 10) < NL - diffuse_below_noise -
//   weak_below_diffuse, r > 10 depths
//                                                 a link is its energy flux (RayModel::weak_below_diffuse)
//   L < NL - reach_below_noise                    sound disturbs nobody (propagation/reach.h)
//   P_acquisition < 1 / acquired_once_in          nobody notices a preamble (propagation/reach.h)
//   r > table_range_m > 0                         a pair has no row in link tables (propagation/reach.h)
//   moved <= row_reuse_distance_m                 a row of a link table is reused (links/link_row_cache.h)
//   searches_per_vehicle N > 0                    most searches for link tables at a tick, the most audible
//                                                 and most changed links first
//                                                 (propagation/search_scheduler.h)
#pragma once

#include "core/units.h"

namespace halocline::channel_server {

enum class Detail { kExact, kFast };

struct DetailLevel {
  Decibels diffuse_below_noise, weak_below_diffuse, reach_below_noise;
  double acquired_once_in;      // packets
  double table_range_m;         // 0: no limit
  double row_reuse_distance_m;  // 0: every row is computed
  double searches_per_vehicle;  // 0: no limit
  bool reuse_for_packets;       // packets share the searches of link tables
};

inline constexpr DetailLevel kExactLevel{.diffuse_below_noise = Decibels{5},
                                         .weak_below_diffuse = Decibels{6},
                                         .reach_below_noise = Decibels{30},
                                         .acquired_once_in = 1e5,
                                         .table_range_m = 0,
                                         .row_reuse_distance_m = 0,
                                         .searches_per_vehicle = 0,
                                         .reuse_for_packets = false};
// Values chosen for the fleets of docs/performance.md, whose modems carry 2 km.
inline constexpr DetailLevel kFastLevel{.diffuse_below_noise = Decibels{0},
                                        .weak_below_diffuse = Decibels{0},
                                        .reach_below_noise = Decibels{20},
                                        .acquired_once_in = 1000,
                                        .table_range_m = 4000,
                                        .row_reuse_distance_m = 25,
                                        .searches_per_vehicle = 0.5,
                                        .reuse_for_packets = true};

inline const DetailLevel& level_of(Detail detail) {
  return detail == Detail::kFast ? kFastLevel : kExactLevel;
}

}  // namespace halocline::channel_server
