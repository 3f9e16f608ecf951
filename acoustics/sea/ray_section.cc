#include "acoustics/sea/ray_section.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/check.h"

namespace halocline::acoustics {

using Half = SectionCell::Half;

RaySection::RaySection(std::vector<double> ranges_m, std::vector<RayWater> columns)
    : ranges_(std::move(ranges_m)), columns_(std::move(columns)) {
  require(!columns_.empty() && ranges_.size() == columns_.size() && ranges_.front() == 0,
          "a section needs a range for each of its columns, the first of them 0");
  layers_ = columns_.front().layers();
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    require(i == 0 || ranges_[i] > ranges_[i - 1], "the ranges of a section do not rise");
    require(columns_[i].depths_m() == depths_m(), "the columns of a section have different knots");
    const RayWater &left = columns_[i], &right = columns_[std::min(i + 1, columns_.size() - 1)];
    is_even_.push_back(left.speeds_mps() == right.speeds_mps());
    for (std::size_t j = 0; j < layers_; ++j) {
      const auto along = [&](std::size_t knot) {
        return is_even_.back()
                   ? 0
                   : (right.speeds_mps()[knot] - left.speeds_mps()[knot]) / (ranges_[i + 1] - ranges_[i]);
      };
      // The half with the edge at the strip's end has the gradient of that column, the other that of the one before.
      const bool falls = diagonal_falls({i, j});
      const double upper = (falls ? right : left).gradients_per_s()[j],
                   lower = (falls ? left : right).gradients_per_s()[j];
      gradients_.push_back({along(j), upper});
      gradients_.push_back({along(j + 1), lower});
    }
  }
}

SectionCell RaySection::enter_layer(std::size_t strip, std::size_t layer) const {
  if (is_even_[strip]) return {strip, layer, Half::kWhole};
  return {strip, layer, diagonal_falls({strip, layer}) ? Half::kLower : Half::kUpper};
}

SectionCell RaySection::enter(std::size_t strip, double depth_m, bool rises) const {
  std::size_t layer = columns_.front().layer_at(depth_m);
  if (rises && layer > 0 && depth_m == depths_m()[layer]) --layer;
  return enter_layer(strip, layer);
}

double RaySection::end_of(std::size_t strip) const {
  return strip + 1 < ranges_.size() ? ranges_[strip + 1] : std::numeric_limits<double>::infinity();
}

const SpeedGradient& RaySection::gradient(const SectionCell& cell) const { return gradients_[index(cell)]; }

double RaySection::speed_in(const SectionCell& cell, double range_m, double depth_m) const {
  // The upper half lies on the plane through the left end of the edge above, the lower one on that of the edge below.
  const std::size_t knot = cell.half == Half::kLower ? cell.layer + 1 : cell.layer;
  const SpeedGradient& g = gradient(cell);
  return columns_[cell.strip].speeds_mps()[knot] + g.along * (range_m - ranges_[cell.strip]) +
         g.down * (depth_m - depths_m()[knot]);
}

double RaySection::absorption_db_per_m(const SectionCell& cell, double range_m, double depth_m) const {
  const double top = depths_m()[cell.layer], u = (depth_m - top) / (depths_m()[cell.layer + 1] - top);
  const auto of_column = [&](std::size_t column) {
    const LayerAbsorption& layer = columns_[column].absorption()[cell.layer];
    return layer.a0 + u * (layer.a1 + u * layer.a2);
  };
  const double here = of_column(cell.strip);
  if (cell.strip + 1 == columns_.size()) return here;
  const double share = (range_m - ranges_[cell.strip]) / (ranges_[cell.strip + 1] - ranges_[cell.strip]);
  return here + share * (of_column(cell.strip + 1) - here);
}

double RaySection::speed_at(double range_m, double depth_m) const {
  const double range = std::max(range_m, 0.0);
  const auto after = std::upper_bound(ranges_.begin() + 1, ranges_.end(), range);
  const auto strip = static_cast<std::size_t>(after - ranges_.begin() - 1);
  SectionCell cell = enter(strip, depth_m, false);
  if (cell.half == Half::kWhole) return speed_in(cell, range, depth_m);
  const double across = (range - ranges_[strip]) / (ranges_[strip + 1] - ranges_[strip]);
  const double top = depths_m()[cell.layer], down = (depth_m - top) / (depths_m()[cell.layer + 1] - top);
  cell.half = down < (diagonal_falls(cell) ? across : 1 - across) ? Half::kUpper : Half::kLower;
  return speed_in(cell, range, depth_m);
}

}  // namespace halocline::acoustics
