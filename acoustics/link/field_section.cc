#include "acoustics/link/field_section.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/pressure.h"
#include "acoustics/sea/sound_speed.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "acoustics/sea/water_columns.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/units.h"
#include "ocean/ocean_field.h"

namespace halocline::acoustics {
namespace {

constexpr double kSameSpeed = 1e-6;     // m/s
constexpr double kLeastStrip = 20;      // m
constexpr double kTallestSkewed = 10;   // m: of layers in which the gradient changes along the line
constexpr double kDeepestProbe = 5000;  // m, as of ray_water()
constexpr double kLeastAxisHeight = 1;  // m: half-height of what takes the place of a kink
constexpr double kRoundedShare = 0.45;  // of the heights beside: less than half, so that two never meet
constexpr int kAxisPieces = 16;
constexpr std::size_t kMostStrips = 512;

// Temperature and salinity of the field at one place: linear between its depths.
class FieldColumn {
 public:
  FieldColumn(const Environment& environment, double range_m, double north_m, double east_m)
      : environment_(&environment),
        range_m_(range_m),
        rows_(environment.field.ocean->column_at(north_m, east_m, environment.field.time_s)) {}

  double range_m() const { return range_m_; }
  double speed_mps(double depth_m) const {
    const auto [depth, temperature, salinity] = at(depth_m);
    return sound_speed_mps(environment_->profile.model(), temperature, salinity, depth,
                           environment_->latitude_rad);
  }
  double absorption_db_per_km(double depth_m, double khz_squared) const {
    const auto [depth, temperature, salinity] = at(depth_m);
    return absorption_spectrum(environment_->absorption_model,
                               {.temperature_degc = temperature,
                                .salinity_psu = salinity,
                                .depth_m = depth,
                                .pressure_atm = pressure_atm_absolute(depth, environment_->latitude_rad),
                                .ph = environment_->ph})
        .db_per_km(khz_squared);
  }

 private:
  ocean::WaterAtDepth at(double depth_m) const {
    const auto below =
        std::upper_bound(rows_.begin(), rows_.end(), depth_m,
                         [](double depth, const ocean::WaterAtDepth& row) { return depth < row.depth_m; });
    if (below == rows_.begin()) return {depth_m, below->temperature_degc, below->salinity_psu};
    const ocean::WaterAtDepth& above = *std::prev(below);
    if (below == rows_.end()) return {depth_m, above.temperature_degc, above.salinity_psu};
    const double share = (depth_m - above.depth_m) / (below->depth_m - above.depth_m);
    return {depth_m, above.temperature_degc + share * (below->temperature_degc - above.temperature_degc),
            above.salinity_psu + share * (below->salinity_psu - above.salinity_psu)};
  }

  const Environment* environment_;
  double range_m_;
  std::vector<ocean::WaterAtDepth> rows_;
};

// The line between the places of one link, and how its water is cut.
class LineWater {
 public:
  LineWater(const Environment& environment, const Vec3& from, const Vec3& to, double deepest_m,
            double tolerance)
      : environment_(environment),
        from_(from.x(), from.y(), 0),
        way_(to.x() - from.x(), to.y() - from.y(), 0),
        length_m_(elementary::hypot(way_.x(), way_.y())),
        deepest_m_(deepest_m),
        tolerance_(tolerance) {
    place_columns();
    set_knots();
  }

  bool is_even() const;
  std::shared_ptr<const RaySection> section(double frequency_hz);

 private:
  using Speeds = std::vector<double>;

  FieldColumn column_at(double range_m) const {
    const Vec3 place = from_ + (length_m_ > 0 ? range_m / length_m_ : 0) * way_;
    return {environment_, range_m, place.x(), place.y()};
  }
  void place_columns();
  void set_knots();
  void cut_skewed_layers();
  Speeds speeds_of(const FieldColumn& column) const;
  // How far the plane of triangles is off in the middle of the layer below a knot, between two columns, at most.
  static double skew(const Speeds& a, const Speeds& b, std::size_t knot) {
    return std::abs(a[knot] + b[knot + 1] - a[knot + 1] - b[knot]) / 4;
  }
  void refine(std::size_t strip_end);
  bool fits(const Speeds& a, const Speeds& middle, const Speeds& b) const;
  void round_channels();

  const Environment& environment_;
  Vec3 from_, way_;
  double length_m_, deepest_m_, tolerance_;
  std::vector<FieldColumn> columns_;
  std::vector<double> depths_;
  std::vector<Speeds> speeds_;  // of each column
};

void LineWater::place_columns() {
  std::vector<double> ranges{0};
  const auto add = [&ranges](double range) {
    if (range > ranges.back() + kLeastStrip) ranges.push_back(range);
  };
  for (const double share : environment_.field.ocean->crossings(from_, from_ + way_))
    if (share * length_m_ < length_m_ - kLeastStrip) add(share * length_m_);
  add(length_m_);
  std::vector<double> with_middles;
  for (std::size_t i = 0; i + 1 < ranges.size(); ++i) {
    with_middles.push_back(ranges[i]);
    if (ranges[i + 1] - ranges[i] > 2 * kLeastStrip) with_middles.push_back((ranges[i] + ranges[i + 1]) / 2);
  }
  with_middles.push_back(ranges.back());
  for (const double range : with_middles) columns_.push_back(column_at(range));
}

LineWater::Speeds LineWater::speeds_of(const FieldColumn& column) const {
  Speeds speeds;
  speeds.reserve(depths_.size());
  for (const double depth : depths_) speeds.push_back(column.speed_mps(depth));
  return speeds;
}

void LineWater::set_knots() {
  std::vector<double> corners{0};
  for (const double depth : environment_.field.ocean->grid().depths_m)
    if (depth > 0) corners.push_back(depth);
  if (corners.back() < kDeepestProbe) corners.push_back(kDeepestProbe);
  const auto speed = [&](std::size_t column, double depth) { return columns_[column].speed_mps(depth); };
  depths_ = thinned(sampled(corners, columns_.size(), speed, kSpeedTolerance), tolerance_).depths_m;
  for (const FieldColumn& column : columns_) speeds_.push_back(speeds_of(column));
  cut_skewed_layers();
}

void LineWater::cut_skewed_layers() {
  std::vector<double> depths{depths_.front()};
  for (std::size_t j = 0; j + 1 < depths_.size(); ++j) {
    double most = 0;
    for (std::size_t i = 0; i + 1 < speeds_.size(); ++i)
      most = std::max(most, skew(speeds_[i], speeds_[i + 1], j));
    const double height = depths_[j + 1] - depths_[j];
    const double pieces =
        most > tolerance_ && depths_[j] < deepest_m_ ? std::ceil(height / kTallestSkewed) : 1;
    for (double piece = 1; piece < pieces; ++piece) depths.push_back(depths_[j] + height * piece / pieces);
    depths.push_back(depths_[j + 1]);
  }
  if (depths.size() == depths_.size()) return;
  depths_ = std::move(depths);
  for (std::size_t i = 0; i < columns_.size(); ++i) speeds_[i] = speeds_of(columns_[i]);
}

bool LineWater::is_even() const {
  return std::all_of(speeds_.begin(), speeds_.end(), [&](const Speeds& speeds) {
    for (std::size_t j = 0; j < speeds.size(); ++j) {
      if (std::abs(speeds[j] - speeds_.front()[j]) > kSameSpeed) return false;
    }
    return true;
  });
}

bool LineWater::fits(const Speeds& a, const Speeds& middle, const Speeds& b) const {
  for (std::size_t j = 0; j < depths_.size(); ++j) {
    if (j > 0 && depths_[j - 1] > deepest_m_) break;
    if (std::abs((a[j] + b[j]) / 2 - middle[j]) > tolerance_) return false;
    if (j + 1 < depths_.size() && depths_[j] < deepest_m_ && skew(a, b, j) > tolerance_) return false;
  }
  return true;
}

// The strip that ends at this column.
void LineWater::refine(std::size_t end) {
  const double width = columns_[end].range_m() - columns_[end - 1].range_m();
  if (width < 2 * kLeastStrip || columns_.size() > kMostStrips) return;
  FieldColumn middle = column_at((columns_[end - 1].range_m() + columns_[end].range_m()) / 2);
  Speeds speeds = speeds_of(middle);
  if (fits(speeds_[end - 1], speeds, speeds_[end])) return;
  const auto at = static_cast<std::ptrdiff_t>(end);
  columns_.insert(columns_.begin() + at, std::move(middle));
  speeds_.insert(speeds_.begin() + at, std::move(speeds));
  refine(end + 1);
  refine(end);
}

// With x = z - z_knot, g1 and g2 the gradients above and below, Delta g = g2 - g1, in every column alike
//   c = c_knot + (g1 + g2) x / 2 + Delta g (x^2 / d + d) / 4  within |x| <= d,
// which changes the speed by Delta g d / 4 at most: d is such that this is the tolerance where Delta g is greatest.
void LineWater::round_channels() {
  std::vector<double> depths{depths_.front()};
  std::vector<Speeds> rounded;
  for (const Speeds& speeds : speeds_) rounded.push_back({speeds.front()});
  for (std::size_t j = 1; j < depths_.size(); ++j) {
    const bool is_last = j + 1 == depths_.size();
    const double above = depths_[j] - depths_[j - 1], below = is_last ? 0 : depths_[j + 1] - depths_[j];
    bool is_axis = false;
    double most = 0;
    for (const Speeds& c : speeds_) {
      if (is_last) break;
      is_axis = is_axis || (c[j] < c[j - 1] && c[j] < c[j + 1]);
      most = std::max(most, std::abs((c[j + 1] - c[j]) / below - (c[j] - c[j - 1]) / above));
    }
    const double d =
        is_axis ? std::min({kRoundedShare * above, kRoundedShare * below, 4 * tolerance_ / most}) : 0;
    const int pieces = d > kLeastAxisHeight ? kAxisPieces : 0;
    for (int k = 0; k <= pieces; ++k) {
      const double x = pieces > 0 ? d * (2.0 * k / pieces - 1) : 0;
      depths.push_back(depths_[j] + x);
      for (std::size_t i = 0; i < speeds_.size(); ++i) {
        const Speeds& c = speeds_[i];
        double speed = c[j];
        if (pieces > 0) {
          const double g1 = (c[j] - c[j - 1]) / above, g2 = (c[j + 1] - c[j]) / below;
          speed += (g1 + g2) * x / 2 + (g2 - g1) * (x * x / d + d) / 4;
        }
        rounded[i].push_back(speed);
      }
    }
  }
  depths_ = std::move(depths);
  speeds_ = std::move(rounded);
}

std::shared_ptr<const RaySection> LineWater::section(double frequency_hz) {
  for (std::size_t end = columns_.size() - 1; end > 0; --end) refine(end);
  round_channels();
  const double khz_squared = hz_to_khz(frequency_hz) * hz_to_khz(frequency_hz);
  std::vector<double> ranges;
  std::vector<RayWater> waters;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    std::vector<SpeedRow> knots;
    for (std::size_t j = 0; j < depths_.size(); ++j) knots.push_back({depths_[j], speeds_[i][j]});
    const FieldColumn& column = columns_[i];
    ranges.push_back(column.range_m());
    waters.emplace_back(std::move(knots),
                        [&](double depth_m) { return column.absorption_db_per_km(depth_m, khz_squared); });
  }
  return std::make_shared<const RaySection>(std::move(ranges), std::move(waters));
}

}  // namespace

LinkWater water_between(const Environment& environment, const Vec3& from_ned_m, const Vec3& to_ned_m,
                        double deepest_m, double frequency_hz, double tolerance_mps) {
  ensure(bool(environment.field), "water between places of a sea without a field");
  LineWater line(environment, from_ned_m, to_ned_m, deepest_m,
                 tolerance_mps > 0 ? tolerance_mps : kSpeedTolerance);
  if (line.is_even()) {
    return {
        ray_water(environment_at(environment, from_ned_m.x(), from_ned_m.y()), frequency_hz, tolerance_mps),
        nullptr};
  }
  auto section = line.section(frequency_hz);
  return {section->columns().front(), section};
}

}  // namespace halocline::acoustics
