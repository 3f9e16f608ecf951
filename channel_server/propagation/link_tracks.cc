// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/link_tracks.h"

#include "acoustics/reception/guard_window.h"

namespace halocline::channel_server {

// The two lists are sorted by delay, so one pass finds all tracks.
void weigh(const std::vector<acoustics::SoundPath>& paths, const acoustics::Modem& receiver,
           LinkTracks& tracks) {
  if (paths.empty()) return;
  const acoustics::GuardWindow window = best_window(paths, receiver);
  std::size_t at = 0;
  for (PathTrack& track : tracks.paths) {
    const auto is_this = [&](const acoustics::SoundPath& path) {
      return path.delay_s == track.path.delay_s && path.identity == track.path.identity;
    };
    while (at < paths.size() && !is_this(paths[at])) ++at;
    if (at == paths.size()) continue;
    const double weight = window.shares[at].weight;
    track.guard_weight = weight * weight;
  }
}

}  // namespace halocline::channel_server
