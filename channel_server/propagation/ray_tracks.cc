// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/ray_tracks.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "acoustics/modem/beam_pattern.h"
#include "acoustics/rays/profile_path.h"
#include "acoustics/sea/bottom_profile.h"
#include "core/elementary.h"

namespace halocline::channel_server {
namespace {

using acoustics::RayPoint;

std::size_t points_for(std::size_t paths) {
  return std::min(LinkTracks::kMaxPoints, LinkTracks::kMaxPointsOfAll / std::max<std::size_t>(paths, 1));
}

std::vector<RayPoint> seabed_between(const acoustics::BottomProfile& bottom, double range_m) {
  std::vector<RayPoint> points{{0, bottom.depth_at(0)}};
  for (const acoustics::ProfiledDepth& point : bottom.points()) {
    if (point.range_m > 0 && point.range_m < range_m) points.push_back({point.range_m, point.depth_m});
  }
  if (range_m > 0) points.push_back({range_m, bottom.depth_at(range_m)});
  return acoustics::simplified(points, LinkTracks::kMaxSeabed);
}

// Returns the points as seen from the other end.
std::vector<RayPoint> mirrored(std::vector<RayPoint> points, double range_m) {
  std::reverse(points.begin(), points.end());
  for (RayPoint& point : points) point.range_m = range_m - point.range_m;
  return points;
}

// Splits the loss of a path into its terms, dB:
//
//   spreading = -20 log10(amplitude) - reflection loss at the surface - reflection loss at the bottom
//   bottom    = source level - received level - spreading - absorption - surface - beams
//
// The amplitude includes reflection losses. The bottom's term is the remainder: reflected and scattered loss.
PathTrack track_of(const FoundPath& found, const acoustics::Modem& transmitter,
                   const acoustics::Modem& receiver) {
  const auto& [arrival, path, kept_at_surface] = found;
  PathTrack track{.path = path, .caustics = arrival.caustics, .length_m = arrival.path_length_m};
  track.absorption_db = arrival.absorption_db;
  track.surface_db = arrival.surface_loss_db - kept_at_surface.value;
  track.beam_db =
      (transmitter.beam.loss(path.launch_angle_rad) + receiver.beam.loss(-path.arrival_angle_rad)).value;
  track.spreading_db =
      -20 * elementary::log10(arrival.amplitude) - arrival.surface_loss_db - arrival.bottom_loss_db;
  track.bottom_db = (transmitter.source_level - path.level).value - track.spreading_db - track.absorption_db -
                    track.surface_db - track.beam_db;
  return track;
}

}  // namespace

LinkTracks tracks_of(const acoustics::ProfiledSea& sea, const acoustics::RayLink& searched, bool reversed,
                     std::vector<FoundPath> found, const acoustics::Modem& transmitter,
                     const acoustics::Modem& receiver) {
  LinkTracks tracks{.link = searched};
  if (reversed) std::swap(tracks.link.source_depth_m, tracks.link.receiver_depth_m);
  const auto from_transmitter = [&](std::vector<RayPoint> points) {
    return reversed ? mirrored(std::move(points), searched.range_m) : points;
  };
  tracks.paths_left_out = keep_strongest(found);
  for (const FoundPath& one : found) {
    tracks.paths.push_back(track_of(one, transmitter, receiver));
    if (one.arrival.diffuse) continue;  // has no single polyline
    tracks.paths.back().points =
        from_transmitter(polyline(sea, searched, one.arrival, points_for(found.size())));
  }
  tracks.seabed = from_transmitter(seabed_between(sea.profile, searched.range_m));
  return tracks;
}

}  // namespace halocline::channel_server
