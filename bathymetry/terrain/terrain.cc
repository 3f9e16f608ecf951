#include "bathymetry/terrain/terrain.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bathymetry/terrain/nesting.h"
#include "bathymetry/terrain/terrain_version.h"
#include "core/check.h"

namespace halocline::bathymetry {
namespace {

RayHit ended(RayStatus status, double range_m = kUnknown) { return {status, range_m, Vec3::Zero()}; }

// The ray with a direction of length 1; a length of 0 when the ray is impossible.
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

}  // namespace

Vec3 DepthSample::normal_ned() const { return upward_normal(slope_north, slope_east); }

Terrain::Terrain(HeightGrid base, std::vector<NestedGrid> nested) {
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

int Terrain::grid_index_at(double x_m, double y_m) const {
  if (!patches_.front().grid.locate(x_m, y_m)) return -1;
  return static_cast<int>(&finest_patch(patches_.front(), x_m, y_m) - patches_.data());
}

DepthSample Terrain::sample(const Patch& patch, double x_m, double y_m) const {
  const auto at = patch.grid.locate(x_m, y_m);
  if (!at) return {};
  const BilinearCell cell = patch.grid.cell(at->i, at->j);
  const double z = cell.depth(at->u, at->v);
  if (is_no_data(cell)) return {.status = DepthStatus::kNoData};
  const double spacing = patch.grid.geometry().spacing_m;
  return {DepthStatus::kOk, z, cell.slope_u(at->v) / spacing, cell.slope_v(at->u) / spacing};
}

DepthSample Terrain::depth_at(double x_m, double y_m) const {
  if (!std::isfinite(x_m) || !std::isfinite(y_m)) return {.status = DepthStatus::kBadInput};
  const Patch& base = patches_.front();
  return sample(base.inside.empty() ? base : finest_patch(base, x_m, y_m), x_m, y_m);
}

// The interval above nested grids belongs to them, the rest to this patch; pieces are taken in the ray's
// order. Where a piece begins and ends is given by the crossings of the patch around, so that its walk stops
// and resumes exactly at the border and never looks into a cell that the nested grid covers.
TraceResult Terrain::trace(const Patch& patch, const Ray& unit_ray, Interval interval,
                           const Patch** owner) const {
  struct Piece {
    Interval interval;
    const Patch* patch;
  };
  std::vector<Piece> pieces;
  const GridRay ray = to_grid_ray(patch.grid.geometry(), unit_ray.origin_ned_m, unit_ray.direction);
  for (const std::size_t child : patch.inside) {
    const Interval above = clip_to_cells(patches_[child].covers, ray, interval);
    if (!above.empty()) pieces.push_back({above, &patches_[child]});
  }
  std::sort(pieces.begin(), pieces.end(),
            [](const Piece& p, const Piece& q) { return p.interval.begin_m < q.interval.begin_m; });
  *owner = &patch;
  for (const Piece& piece : pieces) {
    const Interval before =
        clip_to_cells(all_cells(patch.grid.geometry()), ray, {interval.begin_m, piece.interval.begin_m});
    if (!before.empty()) {
      const TraceResult own = trace_grid(patch.grid, patch.pyramid, ray, before);
      if (own.end != TraceEnd::kPassed) return own;
    }
    const TraceResult inner = trace(*piece.patch, unit_ray, piece.interval, owner);
    if (inner.end != TraceEnd::kPassed) return inner;
    interval.begin_m = std::max(interval.begin_m, piece.interval.end_m);
    *owner = &patch;
  }
  const Interval rest = clip_to_cells(all_cells(patch.grid.geometry()), ray, interval);
  return rest.empty() ? TraceResult{} : trace_grid(patch.grid, patch.pyramid, ray, rest);
}

RayHit Terrain::finish(const Ray& unit_ray, const TraceResult& result, const Patch* owner,
                       Interval inside) const {
  if (result.end == TraceEnd::kNoData) return ended(RayStatus::kNoData, result.range_m);
  if (result.end == TraceEnd::kPassed) {
    const bool whole = inside.end_m >= unit_ray.max_range_m;
    return ended(whole ? RayStatus::kMiss : RayStatus::kOutside, inside.end_m);
  }
  const BilinearCell cell = owner->grid.cell(result.at.i, result.at.j);
  const double spacing = owner->grid.geometry().spacing_m;
  return {RayStatus::kHit, result.range_m,
          upward_normal(cell.slope_u(result.at.v) / spacing, cell.slope_v(result.at.u) / spacing)};
}

// A bound spares most rays the two cache misses of looking up the bottom where they start.
bool Terrain::is_surely_in_water(const Vec3& point_ned_m) const {
  const Patch& base = patches_.front();
  const auto at = base.grid.locate(point_ned_m.x(), point_ned_m.y());
  if (!at || !base.inside.empty()) return false;
  const int level = std::min(kStartLevel, base.pyramid.top_level());
  return point_ned_m.z() < base.pyramid.shallowest(level, at->i >> level, at->j >> level);
}

RayHit Terrain::closest_hit(const Ray& ray) const {
  const Ray unit = normalised(ray);
  if (unit.direction.isZero(0)) return ended(RayStatus::kBadInput);
  if (!is_surely_in_water(unit.origin_ned_m)) {
    const DepthSample start = depth_at(unit.origin_ned_m.x(), unit.origin_ned_m.y());
    if (start.status == DepthStatus::kOutside) return ended(RayStatus::kOutside, 0);
    if (start.status == DepthStatus::kNoData) return ended(RayStatus::kNoData, 0);
    if (unit.origin_ned_m.z() > start.z_m) return ended(RayStatus::kStartedBelowBottom);
    if (unit.origin_ned_m.z() == start.z_m) return {RayStatus::kHit, 0, start.normal_ned()};
  }
  const Patch& base = patches_.front();
  const GridRay base_ray = to_grid_ray(base.grid.geometry(), unit.origin_ned_m, unit.direction);
  const Interval inside = clip_to_cells(all_cells(base.grid.geometry()), base_ray, {0, unit.max_range_m});
  if (inside.empty()) {
    return unit.max_range_m == 0 ? ended(RayStatus::kMiss, 0) : ended(RayStatus::kOutside, 0);
  }
  const Patch* owner = &base;
  const TraceResult result = base.inside.empty() ? trace_grid(base.grid, base.pyramid, base_ray, inside)
                                                 : trace(base, unit, inside, &owner);
  return finish(unit, result, owner, inside);
}

RayHit Terrain::occluded(const Vec3& from_ned_m, const Vec3& to_ned_m, double skin_m) const {
  const Vec3 along = to_ned_m - from_ned_m;
  const double length = along.norm();
  if (!std::isfinite(length) || !(skin_m >= 0)) return ended(RayStatus::kBadInput);
  if (length <= 2 * skin_m || length == 0) return ended(RayStatus::kMiss, length);
  RayHit hit = closest_hit({from_ned_m + along * (skin_m / length), along, length - 2 * skin_m});
  hit.range_m = hit.status == RayStatus::kMiss ? length : hit.range_m + skin_m;
  return hit;
}

}  // namespace halocline::bathymetry
