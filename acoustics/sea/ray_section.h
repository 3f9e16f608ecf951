// Water whose sound speed changes along a link as well as with depth, as rays see it: linear within triangles.
//
// Model: columns of water (acoustics/sea/ray_water.h) at rising ranges, all with the same knots, make rectangles; each is cut in
// two by a diagonal, which falls and rises in turn like the fields of a chessboard, so that the errors of neighbours have
// opposite signs. Within a triangle c = c0 + a (r - r0) + b (z - z0), so a ray is an arc of a circle; c is continuous, its
// gradient jumps at the edges. Where two columns are alike, and beyond the last one, there are no diagonals: water of depth
// alone. Absorption is that of the two columns beside, mixed by range.
//
// Error of the triangles against a function with derivatives: |c_rz| dr dz / 4 and a quarter of that in the mean of its
// square, beside those of the columns. Jumps of the gradient make the tubes of rays that run along an edge uneven, as those of
// knots do (acoustics/sea/ray_water.h).
//
// Immutable: calls may overlap between threads. Ranges are from the source, m; what lies before 0 is the first column's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

// A triangle: a half of the rectangle between columns `strip` and strip + 1 in the layer below knot `layer`, or all of it.
struct SectionCell {
  enum class Half : std::uint8_t { kUpper, kLower, kWhole };  // kUpper has the edge above, kLower that below
  std::size_t strip = 0, layer = 0;
  Half half = Half::kWhole;
};

struct SpeedGradient {
  double along = 0, down = 0;  // 1/s
};

class RaySection {
 public:
  // At least one column, the first at range 0. Throws InvalidArgument when ranges do not rise or knots differ.
  RaySection(std::vector<double> ranges_m, std::vector<RayWater> columns);

  const std::vector<double>& ranges_m() const { return ranges_; }
  const std::vector<RayWater>& columns() const { return columns_; }
  const std::vector<double>& depths_m() const { return columns_.front().depths_m(); }

  // Where a ray that goes forward enters a strip; at a knot `rises` decides between the layers.
  SectionCell enter(std::size_t strip, double depth_m, bool rises) const;
  // The same in a layer that is known.
  SectionCell enter_layer(std::size_t strip, std::size_t layer) const;
  // The strip behind the last column has no end.
  double end_of(std::size_t strip) const;
  bool diagonal_falls(const SectionCell& cell) const { return (cell.strip + cell.layer) % 2 == 0; }
  // Whether the triangle has the edge at the strip's end.
  bool reaches_end(const SectionCell& cell) const {
    return cell.half == SectionCell::Half::kWhole ||
           (cell.half == SectionCell::Half::kUpper) == diagonal_falls(cell);
  }

  const SpeedGradient& gradient(const SectionCell& cell) const;
  // By the plane of a triangle, at a place in it.
  double speed_in(const SectionCell& cell, double range_m, double depth_m) const;
  double absorption_db_per_m(const SectionCell& cell, double range_m, double depth_m) const;
  // At any place.
  double speed_at(double range_m, double depth_m) const;

 private:
  std::size_t index(const SectionCell& cell) const {
    return 2 * (cell.strip * layers_ + cell.layer) + (cell.half == SectionCell::Half::kLower ? 1 : 0);
  }

  std::vector<double> ranges_;
  std::vector<RayWater> columns_;
  std::size_t layers_;
  std::vector<bool> is_even_;             // of each strip: columns alike on both sides
  std::vector<SpeedGradient> gradients_;  // of both halves of each rectangle
};

}  // namespace halocline::acoustics
