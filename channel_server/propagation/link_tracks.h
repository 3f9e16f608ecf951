// SPDX-License-Identifier: BSD-3-Clause
// Full description of one link for charts: its paths with their polylines and the terms of their budgets, and
// the seabed under it.
//
// For each path, in dB:
//
//   received level = source level - spreading - absorption - loss at the surface - loss at the bottom
//                    - loss of both beams
//
// The losses at the boundaries include reflection and the energy scattered out of the path. Ranges are
// horizontal, from the transmitter, m; depths are below the surface, m.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "acoustics/fading/sound_path.h"
#include "acoustics/modem/modem.h"
#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/traced_ray.h"

namespace halocline::channel_server {

struct PathTrack {
  acoustics::SoundPath path;
  double guard_weight = 0;  // share of its power counted as signal by the guard window, 0..1
  int caustics = 0;
  double length_m = 0;
  double spreading_db = 0, absorption_db = 0, surface_db = 0, bottom_db = 0, beam_db = 0;
  std::vector<acoustics::RayPoint> points =
      {};  // from transmitter to receiver; none for a measured channel or diffuse sound
};

struct LinkTracks {
  static constexpr std::size_t kMaxPaths = 64;   // the strongest paths
  static constexpr std::size_t kMaxPoints = 64;  // a path
  static constexpr std::size_t kMaxPointsOfAll = 3400;
  static constexpr std::size_t kMaxSeabed = 256;

  acoustics::RayLink link;
  std::vector<PathTrack> paths = {};  // sorted by delay
  std::size_t paths_left_out = 0;
  std::vector<acoustics::RayPoint> seabed = {};  // from end to end; empty where it is unknown or unused
};

// Keeps the strongest LinkTracks::kMaxPaths of `found`, by rising delay, and returns how many it leaves out.
// Items have a SoundPath `path`.
template <class Item>
std::size_t keep_strongest(std::vector<Item>& found) {
  const std::size_t all = found.size();
  if (all <= LinkTracks::kMaxPaths) return 0;
  std::stable_sort(found.begin(), found.end(),
                   [](const Item& a, const Item& b) { return a.path.level > b.path.level; });
  found.resize(LinkTracks::kMaxPaths);
  std::stable_sort(found.begin(), found.end(),
                   [](const Item& a, const Item& b) { return a.path.delay_s < b.path.delay_s; });
  return all - found.size();
}

// Sets the guard weights of the tracks. `paths` are all arriving paths by rising delay: those of the tracks
// in their order, those left out, and reverberation.
void weigh(const std::vector<acoustics::SoundPath>& paths, const acoustics::Modem& receiver,
           LinkTracks& tracks);

}  // namespace halocline::channel_server
