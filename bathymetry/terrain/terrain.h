// SPDX-License-Identifier: BSD-3-Clause
// The seabed for its users: the depth of the bottom, where rays meet it, and what lies along a line.
//
// Model. One base grid, and finer grids nested in it and in each other. Terrain from a formula continues
// beyond the base grid without end (endless_bottom.h); beyond other terrain the status is `outside`. The
// surface is bilinear in each cell (height_grid.h). A nested grid covers whole cells of the grid around it,
// its spacing divides that grid's, and inside its border, over `blend_width_m`, its posts are blended
// linearly into the surface around. So the surface has no step where grids meet, except the rounding of float
// posts, 0.25 mm at 4000 m, which rays meet as a wall of that height, never as a gap.
//
// No data: a point over a no-data cell has no depth, and a ray that comes over such a cell before a hit ends
// there as `no_data`, at whatever depth it passes, because an unknown bottom must not be taken for deep
// water. There is no sea surface here: an upward ray continues to its greatest range or the edge of the
// terrain. Answers are never invented: what is unknown has a status, and NaN in place of the number.
//
//   const Terrain terrain(make_grid(geometry, FlatShape{.depth_m = 100}));
//   const RayHit hit =
//       terrain.closest_hit({.origin_ned_m = {0, 0, 20}, .direction = {0, 0, 1}, .max_range_m = 500});
//
// Immutable: const calls may overlap between threads. All coordinates are local NED, m, z down from the
// datum.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "bathymetry/terrain/endless_bottom.h"
#include "bathymetry/terrain/grid_trace.h"
#include "bathymetry/terrain/height_grid.h"
#include "bathymetry/terrain/nearest_depths.h"
#include "bathymetry/terrain/shallowest_pyramid.h"
#include "bathymetry/terrain/wide_trace.h"
#include "core/frames.h"

namespace halocline::bathymetry {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

enum class DepthStatus : std::uint8_t { kOk, kOutside, kNoData, kBadInput };

// Bottom below (or above) one point of the plane.
struct DepthSample {
  DepthStatus status = DepthStatus::kOutside;
  double z_m = kUnknown;    // z of the bottom; NaN unless ok
  double slope_north = 0;   // dz/dx: above 0 where the bottom descends towards north; 0 unless ok
  double slope_east = 0;    // dz/dy
  Vec3 normal_ned() const;  // unit vector into the water; straight up unless ok
};

// Depth for acoustics, which continues beyond the data.
struct HeldDepth {
  double z_m = 0;
  bool is_held = false;  // taken from the nearest place of the terrain with data
};

enum class RayStatus : std::uint8_t {
  kHit,   // met the bottom at range_m
  kMiss,  // water over known bottom all the way to max_range_m
  // Left the terrain at range_m without a hit (0: started outside); on endless terrain, was followed no
  // further.
  kOutside,
  kNoData,              // came over a no-data cell at range_m before any hit
  kStartedBelowBottom,  // the origin lies below the bottom
  kBadInput,            // not finite, no direction, or a range below 0
};

struct Ray {
  Vec3 origin_ned_m = Vec3::Zero();
  Vec3 direction = Vec3::UnitZ();  // any length but 0
  double max_range_m = 0;          // finite, 0 or more
};

struct RayHit {
  RayStatus status = RayStatus::kBadInput;
  double range_m = kUnknown;       // see RayStatus; max_range_m for a miss; NaN below the bottom, bad input
  Vec3 normal_ned = Vec3::Zero();  // at a hit, unit vector into the water; zero otherwise
};

// Treatment of the posts without data in a nested grid.
enum class Holes : std::uint8_t {
  kKeep,           // no data stays no data
  kFillFromAround  // the surface of the grid around is taken at that post
};

struct NestedGrid {
  HeightGrid grid;
  double blend_width_m = 0;  // from the border inwards; 0 or more; posts on the border always join
  Holes holes = Holes::kKeep;
};

class Terrain {
 public:
  // `nested` lists coarse grids before fine ones; each lies in the base or in an earlier grid, without
  // overlap with others in it. Throws InvalidArgument, naming the grid, when one is not aligned as stated
  // above. `beyond`, for terrain from a formula, gives z at every post of the base grid and of its
  // continuation; empty: the terrain ends at its edge.
  explicit Terrain(HeightGrid base, std::vector<NestedGrid> nested = {}, const BottomFormula& beyond = {});

  DepthSample depth_at(double x_m, double y_m) const;

  // Returns the depth for acoustics: where the bottom is unknown, that of the nearest known place. Empty for
  // a position that is not finite.
  std::optional<HeldDepth> held_depth_at(double x_m, double y_m) const;

  bool is_endless() const { return beyond_.has_value(); }

  // Returns where the ray first meets the bottom. A ray that starts exactly on the bottom hits at range 0.
  RayHit closest_hit(const Ray& ray) const;

  // Returns closest_hit() of many rays, in their order, equal bit by bit. They are followed in Morton order
  // (Morton 1966) of their origins, several at a time (wide_trace.h): 1.5 to 2 times as fast from some
  // hundred rays on.
  std::vector<RayHit> closest_hits(std::span<const Ray> rays, VectorUnit unit = widest_vector_unit()) const;

  // Geometry of the base grid: the rectangle between its first and last post, which maps show.
  const GridGeometry& extent() const { return patches_.front().grid.geometry(); }
  // Grids after blending, base first.
  std::size_t grid_count() const { return patches_.size(); }
  const HeightGrid& grid(std::size_t index) const { return patches_[index].grid; }

  // Hash of the content (geometry and posts, bit by bit): equal terrains have equal versions in every
  // process.
  std::uint64_t version() const { return version_; }

 private:
  struct Patch {
    HeightGrid grid;
    ShallowestPyramid pyramid;
    CellBlock covers = {};                 // cells of the patch around; unused in the base
    std::vector<std::size_t> inside = {};  // indices of patches nested directly in this one
  };
  // Ray before it is followed: its direction has length 1; `answer` is set when there is nothing to follow.
  struct Departure {
    Ray ray;
    GridRay base_ray = {};
    Interval inside = {};  // over the base grid
    std::optional<RayHit> answer = {};
  };
  // Part of a ray that one patch decides; parts are in the ray's order.
  struct Segment {
    const Patch* patch;
    GridTrace trace;
  };
  void nest(NestedGrid nested, std::size_t number);
  std::size_t patch_around(const GridGeometry& geometry, std::size_t number) const;
  const Patch& finest_patch(const Patch& from, double x_m, double y_m) const;
  const float* shallowest_around(const Vec3& point_ned_m) const;
  // Returns the surface over the cell that contains a point beyond the base grid, and the point's position in
  // it; empty where the terrain ends at its edge.
  std::optional<std::pair<BilinearCell, CellPosition>> cell_beyond(double x_m, double y_m) const;
  DepthSample sample(const Patch& patch, double x_m, double y_m) const;
  Departure depart(const Ray& ray) const;
  void append_segments(const Patch& patch, const Ray& unit_ray, Interval interval,
                       std::vector<Segment>& out) const;
  void trace_some(std::span<const Ray> rays, std::span<const std::uint32_t> numbers, VectorUnit unit,
                  std::vector<RayHit>& hits) const;
  RayHit follow_inside(const Departure& departure) const;
  RayHit follow_beyond(const Departure& departure) const;
  RayHit finish(const Departure& departure, const TraceResult& result, const Patch& owner) const;

  std::vector<Patch> patches_;
  std::optional<EndlessBottom> beyond_;
  std::optional<NearestDepths> filled_;  // of a base grid with gaps
  std::uint64_t version_ = 0;
};

}  // namespace halocline::bathymetry
