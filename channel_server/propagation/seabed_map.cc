// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/seabed_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "core/check.h"
#include "core/elementary.h"
#include "core/hash.h"

namespace halocline::channel_server {
namespace {

constexpr std::int64_t kSide = TileSurvey::kPoints;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// Returns the floor of the quotient: the tile of a point, or the block of a tile.
std::int64_t tile_of(std::int64_t point) { return point >= 0 ? point / kSide : (point - kSide + 1) / kSide; }

constexpr int kReachBefore = 2, kReach = kSplineReach;
constexpr int kHere = kReachBefore, kNext = kReachBefore + 1;  // indices of points 0 and 1 among these

}  // namespace

std::vector<Vec3> TileSurvey::points_ned_m() const {
  std::vector<Vec3> points;
  for (std::int64_t i = 0; i < kSide * kSide; ++i) {
    points.emplace_back(static_cast<double>(kSide * tile_.north + i / kSide) * spacing_m_,
                        static_cast<double>(kSide * tile_.east + i % kSide) * spacing_m_, 0);
  }
  return points;
}

void TileSurvey::take(std::span<const RayAnswer> answers) {
  require(answers.size() == static_cast<std::size_t>(kSide * kSide), "one answer a depth");
  for (const RayAnswer& answer : answers) {
    const bool is_held = answer.kind == RayAnswer::Kind::kOutside || answer.kind == RayAnswer::Kind::kNoData;
    if (is_held) held_ |= std::uint64_t{1} << z_m_.size();
    z_m_.push_back(is_held || answer.kind == RayAnswer::Kind::kHit ? answer.result_m : kUnknown);
  }
}

// Reader of the lattice along a line; it keeps four neighbouring tiles, in which the next points most often
// lie.
class SeabedMap::Reader {
 public:
  explicit Reader(const SeabedMap& map) : map_(map) {}

  // Returns a tile; null when it was not answered. A tile whose query failed is returned.
  const Tile* find_tile(const TileIndex& index) {
    Lookup& last = last_[static_cast<std::size_t>((index.north & 1) * 2 + (index.east & 1))];
    if (last.known && index == last.index) return last.tile;
    const auto found = map_.tiles_.find(index);
    last = {true, index, found == map_.tiles_.end() ? nullptr : &found->second};
    return last.tile;
  }
  double seabed(const Line& line, int sample) {
    const double way = sample * line.spacing_m;
    const double north = (line.north_m + way * line.along_north) / map_.rule_.spacing_m,
                 east = (line.east_m + way * line.along_east) / map_.rule_.spacing_m;
    const double i = std::floor(north), j = std::floor(east);
    return seabed_in_cell(static_cast<std::int64_t>(i), static_cast<std::int64_t>(j), north - i, east - j);
  }
  // True when the cell of the last sample has a corner whose depth continues that of another place.
  bool is_held() const { return cell_held_; }
  // Adds the slopes along the line between the points of the last sample's cell.
  void add_slopes(const Line& line, SlopeSums& slopes) const {
    for (std::size_t i = 0; i + 1 < kReach; ++i) {
      for (std::size_t j = 0; j + 1 < kReach; ++j) {
        const double slope = ((cell_[j][i + 1] - cell_[j][i]) * line.along_north +
                              (cell_[j + 1][i] - cell_[j][i]) * line.along_east) /
                             map_.rule_.spacing_m;
        if (std::isnan(slope)) continue;
        ++slopes.count;
        slopes.sum += slope;
        slopes.squares += slope * slope;
      }
    }
  }

 private:
  // Reads the depths that contribute in a cell; two consecutive samples most often share one.
  void read_cell(std::int64_t n, std::int64_t e) {
    if (read_ && n == cell_north_ && e == cell_east_) return;
    read_ = true;
    cell_north_ = n;
    cell_east_ = e;
    cell_held_ = false;
    // The points lie in two tiles at most in each direction.
    static_assert(kReach <= kSide);
    const std::int64_t north = n - kReachBefore, east = e - kReachBefore;
    const int i_next = std::min(static_cast<int>(kSide * (tile_of(north) + 1) - north), kReach),
              j_next = std::min(static_cast<int>(kSide * (tile_of(east) + 1) - east), kReach);
    read_part(north, east, 0, i_next, 0, j_next);
    read_part(north, east, 0, i_next, j_next, kReach);
    read_part(north, east, i_next, kReach, 0, j_next);
    read_part(north, east, i_next, kReach, j_next, kReach);
  }
  // Reads the points of one tile: rows first_i..end_i-1 and columns first_j..end_j-1 of the cell whose first
  // point is (n, e).
  void read_part(std::int64_t n, std::int64_t e, int first_i, int end_i, int first_j, int end_j) {
    if (first_i == end_i || first_j == end_j) return;
    const TileIndex index{tile_of(n + first_i), tile_of(e + first_j)};
    const Tile* tile = find_tile(index);
    const bool known = tile != nullptr && tile->answered;
    const std::int64_t origin = (n - kSide * index.north) * kSide + e - kSide * index.east;
    for (int i = first_i; i < end_i; ++i) {
      for (int j = first_j; j < end_j; ++j)
        cell_[j][i] = known ? tile->z_m[static_cast<std::size_t>(origin + i * kSide + j)] : kUnknown;
    }
    if (known && tile->held != 0) note_held(*tile, origin, first_i, end_i, first_j, end_j);
  }
  void note_held(const Tile& tile, std::int64_t origin, int first_i, int end_i, int first_j, int end_j) {
    for (const auto& [i, j] : {std::pair(kHere, kHere), {kNext, kHere}, {kHere, kNext}, {kNext, kNext}}) {
      const bool is_here = i >= first_i && i < end_i && j >= first_j && j < end_j;
      if (is_here && (tile.held >> (origin + i * kSide + j) & 1) != 0) cell_held_ = true;
    }
  }
  // Returns z of the seabed at the fractions `u` north and `v` east of point (n, e).
  double seabed_in_cell(std::int64_t n, std::int64_t e, double u, double v) {
    read_cell(n, e);
    const auto wn = spline_weights(u), we = spline_weights(v);
    const double z0 = cell_[kHere][kHere];
    // Weights are applied to differences, so a level seabed stays level to the last bit.
    std::array<double, kReach> rows{};
    for (int j = 0; j < kReach; ++j) {
      for (int i = 0; i < kReach; ++i) rows[i] += we[j] * (cell_[j][i] - z0);
    }
    double z = z0;
    for (int i = 0; i < kReach; ++i) z += wn[i] * rows[i];
    if (!std::isnan(z)) return z;
    return mean_of_known({z0, cell_[kHere][kNext], cell_[kNext][kHere], cell_[kNext][kNext]},
                         {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v});
  }

  struct Lookup {
    bool known = false;
    TileIndex index;
    const Tile* tile = nullptr;
  };

  const SeabedMap& map_;
  std::array<Lookup, 4> last_{};
  bool read_ = false, cell_held_ = false;
  std::int64_t cell_north_ = 0, cell_east_ = 0;
  std::array<std::array<double, kReach>, kReach>
      cell_{};  // by columns, whose sums the compiler takes at once
};

SeabedMap::SeabedMap(const SeabedRule& rule) : rule_(rule) {
  require_in_range(rule.spacing_m, 1, 1000, "spacing of the seabed's samples", "m");
}

SeabedMap::Line SeabedMap::line_between(const Vec3& from, const Vec3& to) const {
  const double north = to.x() - from.x(), east = to.y() - from.y(), range = elementary::hypot(north, east);
  Line line{from.x(),
            from.y(),
            1,
            0,
            std::max(rule_.spacing_m / rule_.samples_per_point, range / rule_.max_samples),
            0};
  if (range > 0) {
    line.along_north = north / range;
    line.along_east = east / range;
  }
  line.last = static_cast<int>(std::ceil(range / line.spacing_m));
  return line;
}

SeabedMap::Line SeabedMap::line_of_places(const Vec3& from, const Vec3& to, int count) const {
  Line line = line_between(from, to);
  line.spacing_m = elementary::hypot(to.x() - from.x(), to.y() - from.y()) / (2 * count);
  return line;
}

std::shared_ptr<const SeabedProfile> SeabedMap::between(const Vec3& from, const Vec3& to) const {
  const Line line = line_between(from, to);
  Reader reader(*this);
  SeabedProfile profile{-kBeyond * line.spacing_m, line.spacing_m, {}};
  for (int sample = -kBeyond; sample <= line.last + kBeyond; ++sample) {
    profile.z_m.push_back(reader.seabed(line, sample));
    if (sample >= 0 && sample <= line.last && reader.is_held()) profile.beyond_terrain = true;
  }
  const auto first = profile.z_m.begin() + kBeyond, last = profile.z_m.end() - 1 - kBeyond;
  if (std::any_of(first, std::max(last, first + 1), [](double z) { return std::isnan(z); })) return nullptr;
  for (auto z = first - 1;; --z) {
    if (std::isnan(*z)) *z = *std::next(z);
    if (z == profile.z_m.begin()) break;
  }
  for (auto z = std::max(last, first + 1); z != profile.z_m.end(); ++z) {
    if (std::isnan(*z)) *z = *std::prev(z);
  }
  return std::make_shared<const SeabedProfile>(std::move(profile));
}

std::optional<SeabedPlaces> SeabedMap::places_between(const Vec3& from, const Vec3& to) const {
  SeabedPlaces places;
  const int count = static_cast<int>(places.z_m.size());
  const Line line = line_of_places(from, to, count);
  Reader reader(*this);
  SlopeSums slopes;
  for (int i = 0; i < count; ++i) {
    double& z_m = places.z_m[static_cast<std::size_t>(i)];
    z_m = reader.seabed(line, 2 * i + 1);
    if (std::isnan(z_m)) return std::nullopt;
    places.beyond_terrain = places.beyond_terrain || reader.is_held();
    reader.add_slopes(line, slopes);
  }
  places.mean_square_slope = slopes.variance();
  return places;
}

bool SeabedMap::read_between(const Vec3& from, const Vec3& to, std::span<double> z_m) const {
  const Line line = line_of_places(from, to, static_cast<int>(z_m.size()));
  Reader reader(*this);
  int sample = 1;
  for (double& z : z_m) {
    z = reader.seabed(line, sample);
    if (std::isnan(z)) return false;
    sample += 2;
  }
  return true;
}

std::optional<double> SeabedMap::seabed_z_m(const Vec3& place) const {
  const double z_m = Reader(*this).seabed(line_between(place, place), 0);
  return std::isnan(z_m) ? std::nullopt : std::optional(z_m);
}

std::size_t SeabedMap::EndsHash::operator()(const Ends& ends) const {
  const auto bytes = std::bit_cast<std::array<std::uint8_t, sizeof(Ends)>>(ends);
  return static_cast<std::size_t>(xxh3(bytes));
}

// When many tiles are kept, every line is looked up, to mark its tiles as in use.
bool SeabedMap::is_surveyed(const Vec3& from, const Vec3& to) {
  if (tiles_.size() > kMaxTiles / 2) return look_up_line(line_between(from, to));
  const Ends ends{from.x(), from.y(), to.x(), to.y()};
  if (surveyed_.contains(ends)) return true;
  if (auto earlier = surveyed_a_tick_ago_.extract(ends)) {
    surveyed_.insert(std::move(earlier));
    return true;
  }
  const bool surveyed = look_up_line(line_between(from, to));
  if (surveyed) surveyed_.insert(ends);
  return surveyed;
}

bool SeabedMap::are_places_surveyed(const Vec3& from, const Vec3& to, int count) {
  return look_up_tiles(line_of_places(from, to, count), {1, 2 * count, 2, 0});
}

// Every fourth sample is visited, with as many more lattice points on each side as lie between visited
// samples.
bool SeabedMap::look_up_line(const Line& line) {
  constexpr int kStride = 4;
  const auto beside = static_cast<std::int64_t>(std::ceil(kStride / 2 * line.spacing_m / rule_.spacing_m));
  return look_up_tiles(line, {-kBeyond, line.last + kBeyond + kStride, kStride, beside});
}

bool SeabedMap::look_up_tiles(const Line& line, const Samples& samples) {
  const auto tile_coordinate = [&](double at_m) {
    return static_cast<std::int64_t>(std::floor(at_m / rule_.spacing_m));
  };
  bool surveyed = true;
  TileIndex last_block;
  Block* block = nullptr;
  const auto visit = [&](const TileIndex& index) {
    const Place place = place_of(index);
    if (block == nullptr || place.block != last_block) block = &blocks_[last_block = place.block];
    block->used |= place.bit;
    if ((block->kept & place.bit) != 0) return;
    surveyed = false;
    if (!queried_.contains(index)) requested_.insert(index);
  };
  constexpr TileIndex kNone{std::numeric_limits<std::int64_t>::min(), 0};
  TileIndex last_near = kNone, last_far = kNone;
  for (int sample = samples.first; sample < samples.end; sample += samples.stride) {
    const double way = sample * line.spacing_m;
    const std::int64_t north = tile_coordinate(line.north_m + way * line.along_north),
                       east = tile_coordinate(line.east_m + way * line.along_east);
    const std::int64_t before = kReachBefore + samples.beside,
                       after = kReach - 1 - kReachBefore + samples.beside;
    const TileIndex near{tile_of(north - before), tile_of(east - before)},
        far{tile_of(north + after), tile_of(east + after)};
    if (near == last_near && far == last_far) continue;
    last_near = near;
    last_far = far;
    for (std::int64_t n = near.north; n <= far.north; ++n) {
      for (std::int64_t e = near.east; e <= far.east; ++e) visit({n, e});
    }
  }
  return surveyed;
}

std::vector<TileSurvey> SeabedMap::take_requests() {
  std::vector<TileSurvey> surveys;
  for (const TileIndex& tile : requested_) surveys.emplace_back(tile, rule_.spacing_m);
  queried_.merge(std::exchange(requested_, {}));
  return surveys;
}

SeabedMap::Place SeabedMap::place_of(const TileIndex& tile) {
  const TileIndex block{tile_of(tile.north), tile_of(tile.east)};
  const std::int64_t number = (tile.north - kSide * block.north) * kSide + tile.east - kSide * block.east;
  return {block, std::uint64_t{1} << number};
}

SeabedMap::Tile& SeabedMap::keep(const TileIndex& tile) {
  const Place place = place_of(tile);
  Block& block = blocks_[place.block];
  block.kept |= place.bit;
  block.used |= place.bit;
  return tiles_[tile];
}

template <class Predicate>
void SeabedMap::forget_if(const Predicate& is_forgotten) {
  const auto forgotten = std::erase_if(tiles_, [&](const auto& one) {
    const auto& [index, tile] = one;
    const Place place = place_of(index);
    Block& block = blocks_[place.block];
    if (!is_forgotten(tile, block, place.bit)) return false;
    block.kept &= ~place.bit;
    return true;
  });
  if (forgotten == 0) return;
  surveyed_.clear();
  surveyed_a_tick_ago_.clear();
}

void SeabedMap::store(const TileSurvey& answered) {
  queried_.erase(answered.tile());
  Tile& tile = keep(answered.tile());
  tile.answered = true;
  tile.held = answered.held();
  std::copy(answered.z_m().begin(), answered.z_m().end(), tile.z_m.begin());
}

void SeabedMap::note_failed(const TileSurvey& survey) {
  queried_.erase(survey.tile());
  keep(survey.tile());
}

void SeabedMap::forget_failures() {
  forget_if([](const Tile& tile, const Block&, std::uint64_t) { return !tile.answered; });
}

void SeabedMap::forget_unused() {
  if (tiles_.size() > kMaxTiles) {
    forget_if([](const Tile&, const Block& block, std::uint64_t bit) {
      return ((block.used | block.used_a_tick_ago) & bit) == 0;
    });
  }
  std::erase_if(blocks_, [](const auto& one) {
    return (one.second.kept | one.second.used | one.second.used_a_tick_ago) == 0;
  });
  for (auto& [index, block] : blocks_) block.used_a_tick_ago = std::exchange(block.used, 0);
  surveyed_a_tick_ago_ = std::exchange(surveyed_, {});
}

void SeabedMap::clear() {
  tiles_.clear();
  blocks_.clear();
  requested_.clear();
  queried_.clear();
  surveyed_.clear();
  surveyed_a_tick_ago_.clear();
  ++version_;
}

}  // namespace halocline::channel_server
