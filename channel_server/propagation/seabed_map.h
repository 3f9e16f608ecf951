// SPDX-License-Identifier: BSD-3-Clause
// What is known of the seabed: its depth at the points of a world-wide horizontal lattice, from which the
// bottom under any link follows.
//
// Rule. Lattice points lie `spacing_m` apart, one in the world's origin. The seabed between them is the
// tensor product of cubic B-splines (de Boor 1978, A Practical Guide to Splines, ch. XII) with the
// coefficients c_i = (8 f_i - f_(i-1) - f_(i+1)) / 6: slope and curvature are continuous, and polynomials up
// to cubics exact. Where one of the 36 points in reach is unknown it is bilinear between the known ones of
// the nearest four. The bottom under a link is sampled from its first end on, samples_per_point times in
// `spacing_m` (512 times between the ends where that makes more: beyond 6.4 km by default), from kBeyond
// samples before the first end to as many beyond the other. So it is a function of the two ends and the
// terrain, whatever was queried before, and continuous in both ends: it changes where an end moves, by as
// much as the seabed differs there. Beyond the edge of the terrain, and where it has no data, the last known
// depth is held (Terrain::held_depth_at), and what rests on that says so. Where the service did not answer, a
// place is unknown when the four points around it are.
//
// The depths are queried tile by tile, 8 x 8 points together, and kept. Vehicles that stay in one area need
// no query after the first, wherever they move. A tile whose query failed counts as answered without a depth
// until forget_failures().
//
// Error. Against a smooth seabed: of fourth order in the spacing. Relief shorter than two spacings is lost.
// Not thread-safe.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "channel_server/propagation/seabed_profile.h"
#include "channel_server/propagation/terrain_rays.h"
#include "core/frames.h"

namespace halocline::channel_server {

struct SeabedRule {
  double spacing_m = 25;      // of the lattice, 1..1000
  int samples_per_point = 2;  // of a profile in a spacing, 1..16
  int max_samples = 512;      // of it between the ends, 16..4096
};

// 8 x 8 points of the lattice; tile (0, 0) begins in the world's origin and goes north and east.
struct TileIndex {
  std::int64_t north = 0, east = 0;
  auto operator<=>(const TileIndex&) const = default;
};

// Queries the depths of one tile.
class TileSurvey {
 public:
  static constexpr int kPoints = kTileSide;

  TileSurvey() = default;
  TileSurvey(TileIndex tile, double spacing_m) : tile_(tile), spacing_m_(spacing_m) {}

  // As EchoSurvey's: there is one query.
  std::optional<RayKind> next_query() const {
    return z_m_.empty() ? std::optional(RayKind::kTiles) : std::nullopt;
  }
  std::vector<TerrainRay> rays() const;  // one
  // Where the depths are, eastwards row by row; z is 0.
  std::vector<Vec3> points_ned_m() const;
  double spacing_m() const { return spacing_m_; }
  void take(std::span<const RayAnswer> answers);

  const TileIndex& tile() const { return tile_; }
  // z of the seabed at the points, m. Empty until answered.
  const std::vector<double>& z_m() const { return z_m_; }
  // Which of them have a depth that is held from elsewhere, a bit each.
  std::uint64_t held() const { return held_; }

 private:
  TileIndex tile_;
  double spacing_m_ = 0;
  std::vector<double> z_m_;
  std::uint64_t held_ = 0;
};

class SeabedMap {
 public:
  static constexpr int kBeyond = 3;  // samples outside of each end
  // When more are kept, those that no link needed since the last tick but one make room: 33 MB.
  static constexpr std::size_t kMaxTiles = 65'536;

  // Throws InvalidArgument when the rule is out of range.
  explicit SeabedMap(const SeabedRule& rule);

  // From one end to the other; null where it is unknown.
  std::shared_ptr<const SeabedProfile> between(const Vec3& from_ned_m, const Vec3& to_ned_m) const;
  // At even places between the ends, in the middle of as many equal parts; slopes between the points of the
  // lattice that weigh there. Empty where a place is unknown.
  std::optional<SeabedPlaces> places_between(const Vec3& from_ned_m, const Vec3& to_ned_m) const;
  // z of the seabed at a place; empty where it is unknown.
  std::optional<double> seabed_z_m(const Vec3& place_ned_m) const;
  // Whether every tile that between() needs is answered. Those that are not are requested. What was found so
  // for the same two ends since the last tick but one is not looked up again while few tiles are kept.
  bool is_surveyed(const Vec3& from_ned_m, const Vec3& to_ned_m);

  // The tiles requested since the last call, by index.
  std::vector<TileSurvey> take_requests();
  void store(const TileSurvey& answered);
  void note_failed(const TileSurvey& survey);
  // Tiles that failed are requested again when they are needed.
  void forget_failures();
  void forget_unused();
  // Another run, or another terrain: forgets everything.
  void clear();

  // Another number after each clear().
  std::int64_t version() const { return version_; }
  std::size_t tiles_kept() const { return tiles_.size(); }
  const SeabedRule& rule() const { return rule_; }

 private:
  static constexpr std::size_t kTilePoints = TileSurvey::kPoints * TileSurvey::kPoints;
  struct Tile {
    bool answered = false;   // else it failed
    std::uint64_t held = 0;  // as TileSurvey::held
    std::array<double, kTilePoints> z_m;
  };
  // 8 x 8 tiles; a bit each, eastwards row by row.
  struct Block {
    std::uint64_t kept = 0;                       // in tiles_
    std::uint64_t used = 0, used_a_tick_ago = 0;  // by links since the last tick, between the last two
  };
  struct Place {
    TileIndex block;
    std::uint64_t bit;
  };
  using Ends = std::array<double, 4>;  // of a line, north and east, m
  struct EndsHash {
    std::size_t operator()(const Ends& ends) const;
  };
  struct TileHash {
    std::size_t operator()(const TileIndex& tile) const {
      return static_cast<std::size_t>(tile.north) * 0x9E3779B97F4A7C15u ^ static_cast<std::size_t>(tile.east);
    }
  };
  // Where the samples of a link lie.
  struct Line {
    double north_m, east_m;          // its first end
    double along_north, along_east;  // to the other, length 1; north for a vertical link
    double spacing_m;
    int last = 0;  // the first sample at the other end or beyond
  };
  Line line_between(const Vec3& from_ned_m, const Vec3& to_ned_m) const;
  // Notes that they are in use, and requests what is missing.
  bool look_up_tiles(const Line& line);
  static Place place_of(const TileIndex& tile);
  Tile& keep(const TileIndex& tile);
  template <class Predicate>
  void forget_if(const Predicate& is_forgotten);  // of a tile, its block and its bit there
  class Reader;

  SeabedRule rule_;
  std::unordered_map<TileIndex, Tile, TileHash> tiles_;    // looked up, never walked where it matters
  std::unordered_map<TileIndex, Block, TileHash> blocks_;  // likewise
  std::set<TileIndex> requested_, queried_;
  std::unordered_set<Ends, EndsHash> surveyed_,
      surveyed_a_tick_ago_;  // since the last tick, between the last two
  std::int64_t version_ = 0;
};

}  // namespace halocline::channel_server
