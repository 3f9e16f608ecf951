// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/terrain/terrain_version.h"

#include <array>
#include <bit>
#include <cstddef>

namespace halocline::bathymetry {
namespace {

// Odd constants without a pattern: fractional digits of the golden ratio and of the square root of 2.
constexpr std::uint64_t kMultiplier = 0x9E3779B97F4A7C15u, kOffset = 0x6A09E667F3BCC909u;
constexpr std::size_t kLanes = 4;

std::uint64_t mix(std::uint64_t state, std::uint64_t word) {
  return std::rotl((state ^ word) * kMultiplier, 29) + kOffset;
}

std::uint64_t bits_of(float post) {
  constexpr std::uint32_t kNoData = 0x7FC00000u;
  return post != post ? kNoData : std::bit_cast<std::uint32_t>(post);
}

}  // namespace

std::uint64_t extend_version(std::uint64_t version, const HeightGrid& grid) {
  const GridGeometry& g = grid.geometry();
  std::uint64_t state = mix(version, std::bit_cast<std::uint64_t>(g.first_x_m));
  state = mix(state, std::bit_cast<std::uint64_t>(g.first_y_m));
  state = mix(state, std::bit_cast<std::uint64_t>(g.spacing_m));
  state = mix(state, std::uint64_t{static_cast<std::uint32_t>(g.posts_x)} << 32 |
                         static_cast<std::uint32_t>(g.posts_y));
  std::array<std::uint64_t, kLanes> lanes{state, state + 1, state + 2, state + 3};
  const auto& posts = grid.posts();
  std::size_t n = 0;
  for (; n + kLanes <= posts.size(); n += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      lanes[lane] = mix(lanes[lane], bits_of(posts[n + lane]));
  }
  for (; n < posts.size(); ++n) lanes[0] = mix(lanes[0], bits_of(posts[n]));
  for (const std::uint64_t lane : lanes) state = mix(state, lane);
  return state ^ state >> 31;
}

}  // namespace halocline::bathymetry
