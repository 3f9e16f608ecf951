// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/terrain/terrain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "bathymetry/terrain/nesting.h"
#include "bathymetry/terrain/terrain_version.h"
#include "core/check.h"

namespace halocline::bathymetry {
namespace {

constexpr double kFarthestCells = 32'768;  // limit for a ray beyond the base grid: a side of the largest grid

RayHit ended(RayStatus status, double range_m = kUnknown) { return {status, range_m, Vec3::Zero()}; }

// Returns the ray with a direction of length 1; of length 0 when the ray is invalid.
Ray normalised(const Ray& ray) {
  const double length = ray.direction.norm();
  const bool possible = ray.origin_ned_m.allFinite() && ray.direction.allFinite() && length > 0 &&
                        std::isfinite(length) && ray.max_range_m >= 0 && std::isfinite(ray.max_range_m);
  Ray unit = ray;
  unit.direction = possible ? Vec3(ray.direction / length) : Vec3(Vec3::Zero());
  return unit;
}

Vec3 upward_normal(double slope_north, double slope_east) {
  return Vec3(slope_north, slope_east, -1).normalized();
}

// Spreads the lowest 6 bits of n to the even bits.
std::uint32_t spread(std::uint32_t n) {
  n = (n | n << 4) & 0x030f;
  n = (n | n << 2) & 0x0333;
  return (n | n << 1) & 0x0555;
}

// Returns the indices of the rays, ordered along a Morton curve over 64 x 64 tiles of the grid by their
// origins, because neighbours read the same posts. Rays outside, or not finite, belong to a tile at the edge.
std::vector<std::uint32_t> in_morton_order(const GridGeometry& grid, std::span<const Ray> rays) {
  constexpr std::size_t kTiles = 64;
  const auto tile = [](double from_m, double length_m) {
    const double n = from_m / length_m * kTiles;
    return n > 0 ? static_cast<std::uint32_t>(std::min(n, kTiles - 1.0)) : 0;
  };
  std::vector<std::uint32_t> tiles(rays.size()), order(rays.size());
  std::array<std::uint32_t, kTiles * kTiles + 1> begins{};
  const double length_x_m = grid.last_x_m() - grid.first_x_m, length_y_m = grid.last_y_m() - grid.first_y_m;
  for (std::size_t n = 0; n < rays.size(); ++n) {
    tiles[n] = spread(tile(rays[n].origin_ned_m.x() - grid.first_x_m, length_x_m)) << 1 |
               spread(tile(rays[n].origin_ned_m.y() - grid.first_y_m, length_y_m));
    ++begins[tiles[n] + 1];
  }
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  for (std::size_t n = 0; n < rays.size(); ++n) order[begins[tiles[n]]++] = static_cast<std::uint32_t>(n);
  return order;
}

}  // namespace

Vec3 DepthSample::normal_ned() const { return upward_normal(slope_north, slope_east); }

Terrain::Terrain(HeightGrid base, std::vector<NestedGrid> nested, const BottomFormula& beyond) {
  if (beyond) beyond_.emplace(base.geometry(), beyond);
  const auto is_gap = [](float z_m) { return std::isnan(z_m); };
  if (std::any_of(base.posts().begin(), base.posts().end(), is_gap)) filled_.emplace(base);
  patches_.reserve(nested.size() + 1);
  ShallowestPyramid pyramid(base);
  patches_.push_back({.grid = std::move(base), .pyramid = std::move(pyramid)});
  for (std::size_t n = 0; n < nested.size(); ++n) nest(std::move(nested[n]), n);
  for (const Patch& patch : patches_) version_ = extend_version(version_, patch.grid);
}

std::size_t Terrain::patch_around(const GridGeometry& geometry, std::size_t number) const {
  std::size_t around = 0;
  require_nested(geometry, patches_[0].grid.geometry(), number);
  for (bool deeper = true; deeper;) {
    deeper = false;
    for (const std::size_t child : patches_[around].inside) {
      if (!overlap(patches_[child].grid.geometry(), geometry)) continue;
      require_nested(geometry, patches_[child].grid.geometry(), number);
      around = child;
      deeper = true;
      break;
    }
  }
  return around;
}

void Terrain::nest(NestedGrid nested, std::size_t number) {
  require_in_range(nested.blend_width_m, 0, 1e6, "blend_width_m of a nested grid", "m");
  const std::size_t around = patch_around(nested.grid.geometry(), number);
  blend_into(patches_[around].grid, nested.blend_width_m, nested.holes == Holes::kFillFromAround,
             nested.grid);
  patches_[around].inside.push_back(patches_.size());
  const CellBlock covers = cells_covered(nested.grid.geometry(), patches_[around].grid.geometry());
  ShallowestPyramid pyramid(nested.grid);
  patches_.push_back({.grid = std::move(nested.grid), .pyramid = std::move(pyramid), .covers = covers});
}

const Terrain::Patch& Terrain::finest_patch(const Patch& from, double x_m, double y_m) const {
  for (const std::size_t child : from.inside) {
    if (patches_[child].grid.locate(x_m, y_m)) return finest_patch(patches_[child], x_m, y_m);
  }
  return from;
}

DepthSample Terrain::sample(const Patch& patch, double x_m, double y_m) const {
  const double spacing = patch.grid.geometry().spacing_m;
  const auto sampled = [&](const BilinearCell& cell, const CellPosition& at) -> DepthSample {
    if (is_no_data(cell)) return {.status = DepthStatus::kNoData};
    return {DepthStatus::kOk, cell.depth(at.u, at.v), cell.slope_u(at.v) / spacing,
            cell.slope_v(at.u) / spacing};
  };
  if (const auto at = patch.grid.locate(x_m, y_m)) return sampled(patch.grid.cell(at->i, at->j), *at);
  const auto beyond = cell_beyond(x_m, y_m);
  return beyond ? sampled(beyond->first, beyond->second) : DepthSample{};
}

std::optional<std::pair<BilinearCell, CellPosition>> Terrain::cell_beyond(double x_m, double y_m) const {
  const auto at = beyond_ ? beyond_->locate(x_m, y_m) : std::nullopt;
  return at ? std::optional(std::pair(beyond_->cell(at->i, at->j), *at)) : std::nullopt;
}

std::optional<HeldDepth> Terrain::held_depth_at(double x_m, double y_m) const {
  const DepthSample here = depth_at(x_m, y_m);
  if (here.status == DepthStatus::kBadInput) return std::nullopt;
  if (here.status == DepthStatus::kOk) return HeldDepth{here.z_m, false};
  const GridGeometry& base = extent();
  const double x_inside_m = std::clamp(x_m, base.first_x_m, base.last_x_m()),
               y_inside_m = std::clamp(y_m, base.first_y_m, base.last_y_m());
  const DepthSample edge = depth_at(x_inside_m, y_inside_m);
  if (edge.status == DepthStatus::kOk) return HeldDepth{edge.z_m, true};
  const DepthSample below_nested = sample(patches_.front(), x_inside_m, y_inside_m);
  if (below_nested.status == DepthStatus::kOk) return HeldDepth{below_nested.z_m, true};
  return HeldDepth{filled_->at(x_inside_m, y_inside_m), true};
}

DepthSample Terrain::depth_at(double x_m, double y_m) const {
  if (!std::isfinite(x_m) || !std::isfinite(y_m)) return {.status = DepthStatus::kBadInput};
  const Patch& base = patches_.front();
  return sample(base.inside.empty() ? base : finest_patch(base, x_m, y_m), x_m, y_m);
}

// Appends the segments of a ray. The interval over nested grids belongs to them, the rest to this patch;
// pieces are processed in the ray's order. The crossings of the patch around define the ends of a piece, so
// that its walk stops and resumes exactly at the border and never reads a cell that the nested grid covers.
void Terrain::append_segments(const Patch& patch, const Ray& unit_ray, Interval interval,
                              std::vector<Segment>& out) const {
  struct Piece {
    Interval interval;
    const Patch* patch;
  };
  std::vector<Piece> pieces;
  const GridRay ray = to_grid_ray(patch.grid.geometry(), unit_ray.origin_ned_m, unit_ray.direction);
  const auto append_own = [&](Interval own) {
    const Interval clipped = clip_to_cells(all_cells(patch.grid.geometry()), ray, own);
    if (!clipped.empty()) out.push_back({&patch, {ray, clipped}});
  };
  for (const std::size_t child : patch.inside) {
    const Interval above = clip_to_cells(patches_[child].covers, ray, interval);
    if (!above.empty()) pieces.push_back({above, &patches_[child]});
  }
  std::sort(pieces.begin(), pieces.end(),
            [](const Piece& p, const Piece& q) { return p.interval.begin_m < q.interval.begin_m; });
  for (const Piece& piece : pieces) {
    append_own({interval.begin_m, piece.interval.begin_m});
    append_segments(*piece.patch, unit_ray, piece.interval, out);
    interval.begin_m = std::max(interval.begin_m, piece.interval.end_m);
  }
  append_own(interval);
}

RayHit Terrain::finish(const Departure& departure, const TraceResult& result, const Patch& owner) const {
  if (result.end == TraceEnd::kNoData) return ended(RayStatus::kNoData, result.range_m);
  if (result.end == TraceEnd::kPassed) {
    const bool whole = departure.inside.end_m >= departure.ray.max_range_m;
    return ended(whole ? RayStatus::kMiss : RayStatus::kOutside, departure.inside.end_m);
  }
  const BilinearCell cell = owner.grid.cell(result.at.i, result.at.j);
  const double spacing = owner.grid.geometry().spacing_m;
  return {RayStatus::kHit, result.range_m,
          upward_normal(cell.slope_u(result.at.v) / spacing, cell.slope_v(result.at.u) / spacing)};
}

// Returns the bound on the bottom's depth around a point; it saves most rays the two cache misses of a depth
// at their origin. Null outside and with nested grids.
const float* Terrain::shallowest_around(const Vec3& point_ned_m) const {
  const Patch& base = patches_.front();
  const auto at = base.grid.locate(point_ned_m.x(), point_ned_m.y());
  if (!at || !base.inside.empty()) return nullptr;
  const int level = std::min(kStartLevel, base.pyramid.top_level());
  return base.pyramid.first(level) +
         static_cast<std::size_t>(at->i >> level) * base.pyramid.row_length(level) +
         static_cast<std::size_t>(at->j >> level);
}

Terrain::Departure Terrain::depart(const Ray& ray) const {
  Departure out{normalised(ray)};
  const Ray& unit = out.ray;
  const auto decided = [&](const RayHit& answer) {
    out.answer = answer;
    return out;
  };
  if (unit.direction.isZero(0)) return decided(ended(RayStatus::kBadInput));
  const float* shallowest = shallowest_around(unit.origin_ned_m);
  const bool surely_in_water = shallowest != nullptr && unit.origin_ned_m.z() < *shallowest;
  if (!surely_in_water) {
    const DepthSample start = depth_at(unit.origin_ned_m.x(), unit.origin_ned_m.y());
    if (start.status == DepthStatus::kOutside) return decided(ended(RayStatus::kOutside, 0));
    if (start.status == DepthStatus::kNoData) return decided(ended(RayStatus::kNoData, 0));
    if (unit.origin_ned_m.z() > start.z_m) return decided(ended(RayStatus::kStartedBelowBottom));
    if (unit.origin_ned_m.z() == start.z_m) return decided({RayStatus::kHit, 0, start.normal_ned()});
  }
  const GridGeometry& base = extent();
  out.base_ray = to_grid_ray(base, unit.origin_ned_m, unit.direction);
  out.inside = clip_to_cells(all_cells(base), out.base_ray, {0, unit.max_range_m});
  const bool leaves = out.inside.empty() || out.inside.begin_m > 0 || out.inside.end_m < unit.max_range_m;
  if (beyond_ && leaves && unit.max_range_m > 0) return decided(follow_beyond(out));
  if (out.inside.empty())
    return decided(ended(unit.max_range_m == 0 ? RayStatus::kMiss : RayStatus::kOutside, 0));
  return out;
}

RayHit Terrain::closest_hit(const Ray& ray) const {
  const Departure departure = depart(ray);
  return departure.answer ? *departure.answer : follow_inside(departure);
}

// Follows a ray that comes from beyond the base grid or goes there: before, over and after the grid.
RayHit Terrain::follow_beyond(const Departure& departure) const {
  const GridRay& ray = departure.base_ray;
  const double max_range_m = departure.ray.max_range_m, spacing_m = extent().spacing_m;
  const bool meets_grid = !departure.inside.empty();
  const Interval before{0, meets_grid ? departure.inside.begin_m : max_range_m};
  const Interval after{meets_grid ? departure.inside.end_m : max_range_m, max_range_m};
  const auto follow = [&](const Interval& part) -> std::optional<RayHit> {
    const double reach_m = part.begin_m + kFarthestCells * spacing_m;
    const TraceResult result = beyond_->trace(ray, {part.begin_m, std::min(part.end_m, reach_m)});
    if (result.end == TraceEnd::kHit) {
      const BilinearCell cell = beyond_->cell(result.at.i, result.at.j);
      return RayHit{
          RayStatus::kHit, result.range_m,
          upward_normal(cell.slope_u(result.at.v) / spacing_m, cell.slope_v(result.at.u) / spacing_m)};
    }
    return part.end_m > reach_m ? std::optional(ended(RayStatus::kOutside, reach_m)) : std::nullopt;
  };
  if (const auto hit = follow(before)) return *hit;
  if (meets_grid) {
    const RayHit hit = follow_inside(departure);
    if (hit.status != RayStatus::kMiss && hit.status != RayStatus::kOutside) return hit;
  }
  return follow(after).value_or(ended(RayStatus::kMiss, max_range_m));
}

RayHit Terrain::follow_inside(const Departure& departure) const {
  const Patch& base = patches_.front();
  if (base.inside.empty()) {
    return finish(departure, trace_grid(base.grid, base.pyramid, departure.base_ray, departure.inside), base);
  }
  std::vector<Segment> segments;
  append_segments(base, departure.ray, departure.inside, segments);
  for (const auto& [patch, trace] : segments) {
    const TraceResult result = trace_grid(patch->grid, patch->pyramid, trace.ray, trace.interval);
    if (result.end != TraceEnd::kPassed) return finish(departure, result, *patch);
  }
  return finish(departure, {}, base);
}

// Follows the rays with the given numbers: all first segments, then the second segments of those that passed,
// and so on.
void Terrain::trace_some(std::span<const Ray> rays, std::span<const std::uint32_t> numbers, VectorUnit unit,
                         std::vector<RayHit>& hits) const {
  struct Flight {
    Departure departure;
    std::size_t segment, last;
    std::uint32_t number;
  };
  const Patch& base = patches_.front();
  std::vector<Flight> flights;
  std::vector<Segment> segments;
  for (const std::uint32_t number : numbers) {
    if (const float* post = shallowest_around(rays[number].origin_ned_m)) __builtin_prefetch(post);
  }
  for (const std::uint32_t number : numbers) {
    Departure departure = depart(rays[number]);
    if (departure.answer) {
      hits[number] = *departure.answer;
      continue;
    }
    const std::size_t first = segments.size();
    if (base.inside.empty()) {
      segments.push_back({&base, {departure.base_ray, departure.inside}});
    } else {
      append_segments(base, departure.ray, departure.inside, segments);
    }
    flights.push_back({std::move(departure), first, segments.size(), number});
  }
  const auto has_passed_all = [&](const Flight& flight) { return flight.segment == flight.last; };
  const auto has_ended = [&](const Flight& flight) {
    return has_passed_all(flight) || segments[flight.segment].trace.result.end != TraceEnd::kPassed;
  };
  std::vector<GridTrace*> traces;
  while (!flights.empty()) {
    for (const Patch& patch : patches_) {
      traces.clear();
      for (const Flight& flight : flights) {
        if (!has_passed_all(flight) && segments[flight.segment].patch == &patch)
          traces.push_back(&segments[flight.segment].trace);
      }
      trace_grid(patch.grid, patch.pyramid, traces, unit);
    }
    for (Flight& flight : flights) {
      if (!has_ended(flight)) ++flight.segment;
      if (!has_ended(flight)) continue;
      const bool passed = has_passed_all(flight);
      hits[flight.number] =
          finish(flight.departure, passed ? TraceResult{} : segments[flight.segment].trace.result,
                 passed ? base : *segments[flight.segment].patch);
    }
    std::erase_if(flights, has_ended);
  }
}

std::vector<RayHit> Terrain::closest_hits(std::span<const Ray> rays, VectorUnit unit) const {
  constexpr std::size_t kAtOnce = 1024;  // rays whose data fits into the cache
  std::vector<RayHit> hits(rays.size());
  const std::vector<std::uint32_t> order = in_morton_order(extent(), rays);
  for (std::size_t first = 0; first < rays.size(); first += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, rays.size() - first);
    trace_some(rays, std::span(order).subspan(first, count), unit, hits);
  }
  return hits;
}

}  // namespace halocline::bathymetry
