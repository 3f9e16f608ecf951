// SPDX-License-Identifier: BSD-3-Clause
// Sound that rough boundaries turn into other angles, laid over the traced paths of a link.
//
// Model (acoustics/scattering/turned_sound.h). A is the power of all that has bounced, the mean of both
// directions of the link.
// - Paths of one bounce keep their scattered share, at their own delay; of paths of several bounces the
//   coherent share E stays. What the search left unresolved (Eigenray::diffuse) is in A.
// - Windows of delay have f A, f = 1 - (power that bounced traced paths keep) / A, within 0 and 1.
//   None comes before the first traced path. Within a range of one depth there are traced paths alone;
//   from there to two depths windows grow to their full power.
// - Where fine structure spreads rays over the whole depth H, by sigma_z = sqrt(mu r^3 / 3) to both sides,
//   and beyond 3 cycles of a path, traced paths and windows have at most twice the transport's total: no
//   focus of a perfect sea survives there. Of its power a path keeps
//     (1 - q) + q min(1, X / S),  q = 1 - exp(-(2 sigma_z / H)^2), or 1 beyond 3 cycles,
//   S the sum of all paths' shares q and X what the windows leave of that limit.
// - Paths below 1e-6 of the whole are left out, 0.1 dB of a sum at most for the 20 000 paths of a link.
//
// Depth. A link is divided into up to 8 stretches of depths alike to 10 %, and the mean depth of each counts,
// to 5 %; over a level bottom to three digits. Geometry and range are scaled from there to the depth itself,
// exactly in even water. Ends are tabulated at fiftieths of the depth and interpolated in power. 48 bins of
// angle, 96 where an end lies within a fifth of the depth of a boundary. The wind counts to 0.1 m/s. Land
// between the ends lets nothing pass.
//
// Transports and ends are cached by the values they depend on, so results do not depend on the order of
// queries. Calls may overlap between threads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <vector>

#include "acoustics/fading/path_fading.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/scattering/angle_transport.h"
#include "acoustics/scattering/delay_windows.h"
#include "acoustics/scattering/transport_end.h"
#include "acoustics/scattering/turned_sound.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/fine_structure.h"
#include "acoustics/sea/ray_water.h"
#include "core/lru_cache.h"

namespace halocline::channel_server {

// A link over which sound turns. Refers to its water, which has to outlive the call.
struct TurnedLink {
  const acoustics::RayWater& water;
  acoustics::FluidBottom bottom;
  acoustics::RaySurface surface;
  const acoustics::FadingModel& fading;
  double frequency_hz = 0;
  acoustics::RayLink link;
  std::array<double, 16> depths_m{};  // at equal distances between the ends, above 0
  double mean_square_slope = 0;       // of relief larger than the grid
  acoustics::FineStructure medium = {};
};

class TurnedSeas {
 public:
  TurnedSeas();

  // Returns the paths of a link with its turned sound: `paths` by rising delay, what they keep, and windows.
  std::vector<acoustics::Eigenray> with_turned_sound(const TurnedLink& link,
                                                     std::vector<acoustics::Eigenray> paths) const;
  // Returns the windows of a link alone, with all of A.
  std::vector<acoustics::Eigenray> windows_alone(const TurnedLink& link) const;

 private:
  // A transport with its ends at fiftieths of the depth, as far as they have been asked for. The slot of an
  // end is twice its fiftieth, plus one with a table.
  struct Sea {
    explicit Sea(const acoustics::TransportSea& sea) : transport(sea) {}
    acoustics::AngleTransport transport;
    std::mutex mutex;
    std::map<int, std::shared_ptr<const acoustics::TransportEnd>> ends;
  };
  // Hash of water and boundaries; depth; number of bins.
  using Key = std::tuple<std::uint64_t, double, std::size_t>;
  struct Turned;

  std::shared_ptr<Sea> sea_of(const TurnedLink& link, std::uint64_t hash, double depth_m,
                              std::size_t bins) const;
  static std::shared_ptr<const acoustics::TransportEnd> node_of(Sea& sea, int slot);
  Turned turned(const TurnedLink& link) const;

  mutable std::mutex mutex_;
  mutable LruCache<Key, std::shared_ptr<Sea>> seas_;
};

}  // namespace halocline::channel_server
