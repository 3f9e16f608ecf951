// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/coverage/coverage.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

#include "acoustics/sea/bottom_profile.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/seabed_profile.h"
#include "core/check.h"
#include "core/elementary.h"
#include "simulation/coverage/coverage_links.h"
#include "simulation/link_surveyor.h"

namespace halocline::clients {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kNotLooked = std::numeric_limits<double>::infinity();
constexpr double kDeliveryTolerance = 0.002, kLevelToleranceDb = 0.03, kDelayToleranceS = 3e-7;

// Returns the tolerance of each quantity. Delivery is always verified, level and delay only when they are
// asked for.
Sample tolerances(const std::vector<CoverageQuantity>& wanted) {
  const auto asks = [&](CoverageQuantity quantity) {
    return std::find(wanted.begin(), wanted.end(), quantity) != wanted.end();
  };
  const bool level = asks(CoverageQuantity::kLevel) || asks(CoverageQuantity::kSnr);
  return {kDeliveryTolerance,
          level ? kLevelToleranceDb : kNotLooked,
          asks(CoverageQuantity::kDelay) ? kDelayToleranceS : kNotLooked,
          asks(CoverageQuantity::kSnr) ? kLevelToleranceDb : kNotLooked,
          asks(CoverageQuantity::kDeliveryLow) ? kDeliveryTolerance : kNotLooked,
          asks(CoverageQuantity::kDeliveryHigh) ? kDeliveryTolerance : kNotLooked};
}

class Mapping {
 public:
  Mapping(const ScenarioConfig& config, const std::shared_ptr<const bathymetry::Terrain>& terrain,
          const LinkSurveyEnd& from, const CoverageArea& area, const std::vector<CoverageQuantity>& wanted,
          int threads, RaySharing sharing)
      : links_({config, terrain, from}),
        terrain_(*terrain),
        from_ned_m_(from.position_ned_m),
        level_z_m_(level_z_m(config.terrain, *terrain)),
        surface_z_m_(config.scenario.surface_z_m(0)),
        area_(area),
        tolerance_(tolerances(wanted)),
        threads_(threads),
        sharing_(sharing) {
    const std::size_t cells = area.side * area.side;
    for (auto* values : {&map_.delivery, &map_.level_db, &map_.delay_s, &map_.snr_db, &map_.delivery_low,
                         &map_.delivery_high})
      values->assign(area.depths_m.size(), std::vector<double>(cells, kNothing));
    map_.area = area;
  }

  Coverage run() {
    seabed_z_m_.resize(area_.side * area_.side, kNothing);
    for (std::size_t cell = 0; cell < seabed_z_m_.size(); ++cell) {
      const Vec3 at = place(cell, 0);
      const auto held = terrain_.held_depth_at(at.x(), at.y());
      const bool is_beyond = held && held->is_held;
      map_.cells_beyond_terrain += is_beyond ? 1 : 0;
      seabed_z_m_[cell] = held && (!is_beyond || links_.holds_terrain()) ? held->z_m : kNothing;
    }
    if (level_z_m_ && !links_.is_in_a_field() && !links_.is_among_noise()) {
      by_range(*level_z_m_);
    } else {
      over_terrain();
    }
    map_.noise_level_db = links_.noise_level_db();
    return std::move(map_);
  }

 private:
  Vec3 place(std::size_t cell, double depth_m) const {
    return {area_.north_m(cell / area_.side), area_.east_m(cell % area_.side), depth_m + surface_z_m_};
  }
  double range_m(std::size_t cell) const {
    const Vec3 way = place(cell, 0) - from_ned_m_;
    return elementary::hypot(way.x(), way.y());
  }
  bool is_water(std::size_t cell, std::size_t depth) const {
    return area_.depths_m[depth] + surface_z_m_ <= seabed_z_m_[cell];
  }
  void set(std::size_t cell, std::size_t depth, const Sample& sample) {
    map_.delivery[depth][cell] = sample[0];
    map_.level_db[depth][cell] = sample[1];
    map_.delay_s[depth][cell] = sample[2];
    map_.snr_db[depth][cell] = sample[3];
    map_.delivery_low[depth][cell] = sample[4];
    map_.delivery_high[depth][cell] = sample[5];
  }

  void by_range(double bottom_z_m) {
    std::vector<double> ranges;
    std::vector<double> of_cells;
    for (std::size_t cell = 0; cell < seabed_z_m_.size(); ++cell) {
      of_cells.push_back(std::round(range_m(cell) / kSameRangeM) * kSameRangeM);
      if (!std::isnan(seabed_z_m_[cell])) ranges.push_back(of_cells.back());
    }
    std::sort(ranges.begin(), ranges.end());
    ranges.erase(std::unique(ranges.begin(), ranges.end()), ranges.end());
    if (ranges.empty()) return;
    const auto seabed = std::make_shared<const channel_server::SeabedProfile>(
        channel_server::SeabedProfile::flat(bottom_z_m));
    links_.share(threads_, area_.depths_m.size(), [&](LinkSurveyor& surveyor, std::size_t depth) {
      const double z_m = area_.depths_m[depth] + surface_z_m_;
      if (z_m > bottom_z_m) return;
      const auto samples = sampled(ranges, area_.cell_m, tolerance_, [&](double range_m) {
        return links_.link(surveyor, {from_ned_m_.x() + range_m, from_ned_m_.y(), z_m}, seabed);
      });
      for (std::size_t cell = 0; cell < of_cells.size(); ++cell) {
        if (!is_water(cell, depth)) continue;
        const auto at = std::lower_bound(ranges.begin(), ranges.end(), of_cells[cell]) - ranges.begin();
        set(cell, depth, samples[static_cast<std::size_t>(at)]);
      }
    });
  }

  // Bottom profile and the cells whose links use it, farthest first; the profile ends at `end_ned_m`.
  struct Line {
    std::vector<std::size_t> cells;
    Vec3 end_ned_m;
  };

  std::vector<Line> lines_of_cells() const {
    std::vector<Line> lines;
    for (std::size_t cell = 0; cell < seabed_z_m_.size(); ++cell) {
      if (!std::isnan(seabed_z_m_[cell])) lines.push_back({{cell}, place(cell, 0)});
    }
    return lines;
  }

  // Groups cells by bearing. Neighbouring bearings are one cell apart at the farthest cell.
  std::vector<Line> bearings(const std::vector<Line>& cells) const {
    double furthest_m = 0;
    for (const Line& line : cells) furthest_m = std::max(furthest_m, range_m(line.cells.front()));
    const double turn = 2 * std::numbers::pi, count = std::ceil(turn * furthest_m / area_.cell_m);
    std::vector<Line> lines(static_cast<std::size_t>(count));
    for (const Line& line : cells) {
      const Vec3 way = line.end_ned_m - from_ned_m_;
      const double share = elementary::atan2(way.y(), way.x()) / turn;
      const auto bearing = static_cast<std::int64_t>(std::round((share + 1) * count));
      lines[static_cast<std::size_t>(bearing) % lines.size()].cells.push_back(line.cells.front());
    }
    for (std::size_t i = 0; i < lines.size(); ++i) {
      std::vector<std::size_t>& on_it = lines[i].cells;
      std::stable_sort(on_it.begin(), on_it.end(),
                       [&](std::size_t a, std::size_t b) { return range_m(a) > range_m(b); });
      if (on_it.empty()) continue;
      const double angle = turn * static_cast<double>(i) / count, end_m = range_m(on_it.front());
      const auto [sine, cosine] = elementary::sin_cos(angle);
      lines[i].end_ned_m = from_ned_m_ + end_m * Vec3(cosine, sine, 0);
    }
    std::erase_if(lines, [](const Line& line) { return line.cells.empty(); });
    return lines;
  }

  void over_terrain() {
    channel_server::SeabedMap seabed = links_.seabed_map();
    std::vector<Line> lines = lines_of_cells();
    // A bearing may leave the terrain beside its cells, which matters where the last depth is not held.
    const bool shares_ranges = sharing_ == RaySharing::kRanges && links_.holds_terrain();
    if (shares_ranges && !links_.is_in_a_field()) lines = bearings(lines);
    // The seabed must be known along a whole bearing; otherwise each of its cells gets its own profile.
    std::vector<Line> known;
    for (const Line& line : lines) {
      links_.survey(line.end_ned_m, seabed);
      if (line.cells.size() == 1 || links_.bottom(line.end_ned_m, seabed)) {
        known.push_back(line);
        continue;
      }
      for (const std::size_t cell : line.cells) {
        known.push_back({{cell}, place(cell, 0)});
        links_.survey(known.back().end_ned_m, seabed);
      }
    }
    links_.share(threads_, known.size(), [&](LinkSurveyor& surveyor, std::size_t i) {
      const LinkSurveyor::Seabed profile = links_.bottom(known[i].end_ned_m, seabed);
      if (known[i].cells.size() > 1) return along_bearing(surveyor, known[i], profile);
      const std::size_t cell = known[i].cells.front();
      set_all(cell, links_.links_to_one_place(surveyor, place(cell, 0), water_z_m(cell), profile, sharing_));
    });
  }

  // Computes the cells of a bearing with one fan of rays. Receivers that would be below the bottom profile of
  // the bearing are placed 0.2 m above it.
  void along_bearing(LinkSurveyor& surveyor, const Line& bearing, const LinkSurveyor::Seabed& profile) {
    const acoustics::BottomProfile bottom = links_.bottom_profile(bearing.end_ned_m, *profile);
    std::vector<double> ranges;
    for (const std::size_t cell : bearing.cells) ranges.push_back(range_m(cell));
    std::reverse(ranges.begin(), ranges.end());
    channel_server::SharedLine line = channel_server::SharedLine::of_ranges(std::move(ranges));
    for (const std::size_t cell : bearing.cells) {
      const double deepest_z_m = surface_z_m_ + bottom.depth_at(range_m(cell)) - kAboveBottomM;
      std::vector<double> z_m = water_z_m(cell);
      for (double& z : z_m) z = std::min(z, deepest_z_m);
      set_all(cell, links_.links(surveyor, place(cell, 0), z_m, profile, &line));
    }
  }

  // Returns z of the cell's depths that are in the water, m.
  std::vector<double> water_z_m(std::size_t cell) const {
    std::vector<double> z_m;
    for (std::size_t depth = 0; depth < area_.depths_m.size() && is_water(cell, depth); ++depth)
      z_m.push_back(area_.depths_m[depth] + surface_z_m_);
    return z_m;
  }
  void set_all(std::size_t cell, const std::vector<Sample>& samples) {
    for (std::size_t depth = 0; depth < samples.size(); ++depth) set(cell, depth, samples[depth]);
  }

  static constexpr double kAboveBottomM = 0.2;
  static constexpr double kSameRangeM = 1e-6;

  CoverageLinks links_;
  const bathymetry::Terrain& terrain_;
  Vec3 from_ned_m_;
  std::optional<double> level_z_m_;
  double surface_z_m_;
  const CoverageArea& area_;
  Sample tolerance_;
  int threads_;
  RaySharing sharing_;
  std::vector<double> seabed_z_m_;  // below each cell; NaN where unknown
  Coverage map_;
};

}  // namespace

std::optional<double> level_z_m(const bathymetry::TerrainRecipe& recipe, const bathymetry::Terrain& terrain) {
  // A shape may lie beyond a base grid without end; a raster goes on as at its edge.
  const bool is_flat = recipe.kind == bathymetry::TerrainKind::kFlat && recipe.relief.rms_m == 0;
  if (terrain.is_endless() && !is_flat) return std::nullopt;
  const double z_m = terrain.grid(0).post(0, 0);
  for (std::size_t i = 0; i < terrain.grid_count(); ++i) {
    const auto& posts = terrain.grid(i).posts();
    if (!std::all_of(posts.begin(), posts.end(), [z_m](float post_m) { return post_m == z_m; }))
      return std::nullopt;
  }
  return z_m;
}

Coverage compute_coverage(const ScenarioConfig& config,
                          const std::shared_ptr<const bathymetry::Terrain>& terrain,
                          const LinkSurveyEnd& from, const CoverageArea& area,
                          const std::vector<CoverageQuantity>& wanted, int threads, RaySharing sharing) {
  require_above_seabed(*terrain, from);
  return Mapping(config, terrain, from, area, wanted, threads, sharing).run();
}

std::vector<double> Coverage::values(CoverageQuantity quantity, std::size_t depth) const {
  switch (quantity) {
    case CoverageQuantity::kDelivery:
      return delivery.at(depth);
    case CoverageQuantity::kDelay:
      return delay_s.at(depth);
    case CoverageQuantity::kLevel:
      return level_db.at(depth);
    case CoverageQuantity::kDeliveryLow:
      return delivery_low.at(depth);
    case CoverageQuantity::kDeliveryHigh:
      return delivery_high.at(depth);
    case CoverageQuantity::kSnr:
      break;
  }
  if (!snr_db.empty()) return snr_db.at(depth);
  std::vector<double> over_ambient_db = level_db.at(depth);
  for (double& value : over_ambient_db) value -= noise_level_db;
  return over_ambient_db;
}

std::optional<double> Coverage::mean_delivery(std::size_t depth) const {
  double sum = 0;
  std::size_t count = 0;
  for (const double value : delivery.at(depth)) {
    if (std::isnan(value)) continue;
    sum += value;
    ++count;
  }
  return count > 0 ? std::optional(sum / static_cast<double>(count)) : std::nullopt;
}

std::optional<std::size_t> Coverage::best_depth() const {
  std::optional<std::size_t> best;
  for (std::size_t depth = 0; depth < delivery.size(); ++depth) {
    const auto mean = mean_delivery(depth);
    if (mean && (!best || *mean > *mean_delivery(*best))) best = depth;
  }
  return best;
}

}  // namespace halocline::clients
