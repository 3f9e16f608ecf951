// SPDX-License-Identifier: BSD-3-Clause
// Known bathymetry: the depth of the seabed at the points of a world-wide horizontal lattice, from which the
// bottom under any link follows.
//
// Rule. Lattice points lie `spacing_m` apart; one is the world's origin. Between them the seabed is the
// tensor product of cubic B-splines (de Boor 1978, A Practical Guide to Splines, ch. XII) with the
// coefficients
//
//   c_i = (8 f_i - f_(i-1) - f_(i+1)) / 6
//
// Slope and curvature are continuous, and polynomials up to cubics are exact. Where one of the 36 points that
// contribute is unknown, the interpolation is bilinear between the known ones of the nearest four.
//
// The bottom under a link is sampled from its first end on, samples_per_point times in `spacing_m`
// (max_samples times between the ends of a long link: beyond 6.4 km by default), from kBeyond samples before
// the first end to as many beyond the other end. So it is a function of the two ends and the terrain,
// whatever was queried before. It is continuous in both ends: when an end moves, the bottom changes by as
// much as the seabed differs there.
//
// Beyond the edge of the terrain, and where the terrain has no data, the last known depth continues
// (Terrain::held_depth_at), and results that rest on it are marked. Where the service did not answer, a place
// is unknown when the four points around it are.
//
// The depths are queried by tiles of 8 x 8 points and kept. Vehicles that stay in one area need no query
// after the first ones, wherever they move in it. A tile whose query failed counts as answered without depths
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
#include "core/frames.h"

namespace halocline::channel_server {

struct SeabedRule {
  double spacing_m = 25;      // between lattice points, 1..1000
  int samples_per_point = 2;  // samples of a profile in one spacing, 1..16
  int max_samples = 512;      // samples of a profile between the ends, 16..4096
};

// Index of a tile of 8 x 8 lattice points; tile (0, 0) begins at the world's origin and extends north and
// east.
struct TileIndex {
  std::int64_t north = 0, east = 0;
  auto operator<=>(const TileIndex&) const = default;
};

// The terrain service's answer for one point of a tile.
struct RayAnswer {
  enum class Kind { kHit, kMiss, kOutside, kNoData, kBelowBottom, kBadInput };
  Kind kind = Kind::kMiss;
  // z of the seabed for kHit, m; with kOutside or kNoData the last known depth.
  double result_m = 0;
};

// Queries the depths of one tile.
class TileSurvey {
 public:
  static constexpr int kPoints = 8;  // along each side

  TileSurvey() = default;
  TileSurvey(TileIndex tile, double spacing_m) : tile_(tile), spacing_m_(spacing_m) {}

  // Returns the positions of the depths, row by row, each from west to east; z is 0.
  std::vector<Vec3> points_ned_m() const;
  double spacing_m() const { return spacing_m_; }
  // Takes one answer for each point; throws if the count differs.
  void take(std::span<const RayAnswer> answers);

  const TileIndex& tile() const { return tile_; }
  // z of the seabed at the points, m; empty until answered.
  const std::vector<double>& z_m() const { return z_m_; }
  // One bit for each point: set when its depth continues that of another place.
  std::uint64_t held() const { return held_; }

 private:
  TileIndex tile_;
  double spacing_m_ = 0;
  std::vector<double> z_m_;
  std::uint64_t held_ = 0;
};

class SeabedMap {
 public:
  static constexpr int kBeyond = 3;  // samples beyond each end of a link
  // Limit of kept tiles, 33 MB: beyond it, those that no link needed since the last tick but one are dropped.
  static constexpr std::size_t kMaxTiles = 65'536;

  // Throws InvalidArgument when the rule is out of range.
  explicit SeabedMap(const SeabedRule& rule);

  // Returns the profile from one end to the other; null where the seabed is unknown.
  std::shared_ptr<const SeabedProfile> between(const Vec3& from_ned_m, const Vec3& to_ned_m) const;
  // Returns the seabed at the middles of equal parts of the line between the ends. Slopes are those between
  // the lattice points that contribute there. Empty where a place is unknown.
  std::optional<SeabedPlaces> places_between(const Vec3& from_ned_m, const Vec3& to_ned_m) const;
  // Sets z of the seabed at the middles of equal parts of the line between the ends, as many as `z_m` has
  // elements. Returns false where a place is unknown.
  [[nodiscard]] bool read_between(const Vec3& from_ned_m, const Vec3& to_ned_m, std::span<double> z_m) const;
  // Returns z of the seabed at a place; empty where it is unknown.
  std::optional<double> seabed_z_m(const Vec3& place_ned_m) const;
  // True when every tile that between() needs is answered. Missing tiles are requested. A true result for the
  // same two ends since the last tick but one is not looked up again while few tiles are kept.
  bool is_surveyed(const Vec3& from_ned_m, const Vec3& to_ned_m);
  // The same for read_between() at `count` places, which needs few tiles however long the line is.
  bool are_places_surveyed(const Vec3& from_ned_m, const Vec3& to_ned_m, int count);

  // Returns the tiles requested since the last call, by rising index.
  std::vector<TileSurvey> take_requests();
  // True while a requested tile has neither been answered nor failed.
  bool awaits_tiles() const { return !requested_.empty() || !queried_.empty(); }
  void store(const TileSurvey& answered);
  void note_failed(const TileSurvey& survey);
  // Allows the tiles whose queries failed to be requested again when they are needed.
  void forget_failures();
  void forget_unused();
  // Begins another run, or another terrain: forgets everything.
  void clear();

  // Number that differs after each clear().
  std::int64_t version() const { return version_; }
  const SeabedRule& rule() const { return rule_; }

 private:
  static constexpr std::size_t kTilePoints = TileSurvey::kPoints * TileSurvey::kPoints;
  struct Tile {
    bool answered = false;   // false: the query failed
    std::uint64_t held = 0;  // see TileSurvey::held
    std::array<double, kTilePoints> z_m;
  };
  // Block of 8 x 8 tiles with one bit each, row by row, each from west to east.
  struct Block {
    std::uint64_t kept = 0;                       // tiles that are in tiles_
    std::uint64_t used = 0, used_a_tick_ago = 0;  // since the last tick, between the last two
  };
  struct Place {
    TileIndex block;
    std::uint64_t bit;
  };
  using Ends = std::array<double, 4>;  // north and east of each end of a line, m
  struct EndsHash {
    std::size_t operator()(const Ends& ends) const;
  };
  struct TileHash {
    std::size_t operator()(const TileIndex& tile) const {
      return static_cast<std::size_t>(tile.north) * 0x9E3779B97F4A7C15u ^ static_cast<std::size_t>(tile.east);
    }
  };
  // Line along which the samples of a link lie.
  struct Line {
    double north_m, east_m;          // first end
    double along_north, along_east;  // unit vector to the other end; north for a vertical link
    double spacing_m;
    int last = 0;  // the first sample at the other end or beyond it
  };
  // Samples of a line to look up: every `stride`-th from `first` on, before `end`, each with the lattice
  // points as far as `beside` points from its own.
  struct Samples {
    int first, end, stride;
    std::int64_t beside;
  };
  Line line_between(const Vec3& from_ned_m, const Vec3& to_ned_m) const;
  // Returns the line whose odd samples are the middles of `count` equal parts.
  Line line_of_places(const Vec3& from_ned_m, const Vec3& to_ned_m, int count) const;
  bool look_up_line(const Line& line);
  // Marks the tiles of the samples as in use and requests the missing ones; true when none is missing.
  bool look_up_tiles(const Line& line, const Samples& samples);
  static Place place_of(const TileIndex& tile);
  Tile& keep(const TileIndex& tile);
  template <class Predicate>
  void forget_if(const Predicate& is_forgotten);  // called with a tile, its block and its bit in the block
  class Reader;

  SeabedRule rule_;
  std::unordered_map<TileIndex, Tile, TileHash> tiles_;    // the order of iteration affects no result
  std::unordered_map<TileIndex, Block, TileHash> blocks_;  // the order of iteration affects no result
  std::set<TileIndex> requested_, queried_;
  std::unordered_set<Ends, EndsHash> surveyed_,
      surveyed_a_tick_ago_;  // since the last tick, and between the last two
  std::int64_t version_ = 0;
};

}  // namespace halocline::channel_server
