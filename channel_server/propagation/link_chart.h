// SPDX-License-Identifier: BSD-3-Clause
// Chart of one link: its arrivals with their courses and the terms of their budgets, and the seabed under it.
//
// For each arrival, in dB:
//
//   received level = source level - spreading - absorption - loss at the surface - loss at the bottom
//                    - loss of both beams
//
// The losses at the boundaries include reflection and the energy scattered out of the path. Ranges are
// horizontal, from the transmitter, m; depths are below the surface, m.
#pragma once

#include <cstddef>
#include <vector>

#include "acoustics/fading/arrival.h"
#include "acoustics/modem/modem.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/ray_trace.h"

namespace halocline::channel_server {

struct LinkChart {
  static constexpr std::size_t kMaxPaths = 64;   // the strongest paths
  static constexpr std::size_t kMaxPoints = 64;  // a path
  static constexpr std::size_t kMaxPointsOfAll = 3400;
  static constexpr std::size_t kMaxSeabed = 256;

  struct Row {
    acoustics::Arrival arrival;
    double guard_weight = 0;  // share of its power counted as signal by the guard window, 0..1
    double spreading_db = 0, surface_db = 0, bottom_db = 0, beam_db = 0;
    std::vector<acoustics::RayPoint> course =
        {};  // from transmitter to receiver; none for a measured channel or diffuse sound
  };

  acoustics::RayLink link;
  std::vector<Row> rows = {};  // sorted by delay
  std::size_t paths_left_out = 0;
  std::vector<acoustics::RayPoint> seabed = {};  // from end to end; empty where it is unknown or unused

  // Keeps the strongest kMaxPaths rows by rising delay, and counts those left out.
  void keep_strongest();
  // Sets the guard weights. `arrivals` are all arrivals of the link by rising delay: those of the rows in
  // their order, those left out, and reverberation.
  void weigh(const std::vector<acoustics::Arrival>& arrivals, const acoustics::Modem& receiver);
};

}  // namespace halocline::channel_server
