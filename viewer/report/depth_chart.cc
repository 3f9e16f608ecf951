// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/report/depth_chart.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/csv_table.h"
#include "core/elementary.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "runs/timeline/plan_texts.h"
#include "runs/timeline/timed_series.h"
#include "runs/timeline/vehicle_record.h"
#include "viewer/report/chart_texts.h"
#include "viewer/report/picture.h"
#include "viewer/report/svg.h"
#include "viewer/report/vehicle_style.h"

namespace halocline::clients {
namespace {

constexpr std::size_t kMaxPoints = 600;
constexpr double kChartWidth_px = 1120, kStrip_px = 92;

double depth_m(const TrackPoint& point) { return point.position_ned_m.z(); }

struct DepthRange {
  double least_m = 0, greatest_m = 1;  // limits of the depth axis
  bool is_seabed_cut = false;          // the seabed is far below every vehicle
};

bool has_moved(const VehicleRecord& vehicle) { return vehicle.track.size() > 1 && !vehicle.is_at_rest(); }

// Returns the vehicles that are drawn: those that moved farthest, in the order of the run.
std::vector<const VehicleRecord*> shown_vehicles(const RunTimeline& timeline) {
  std::vector<std::pair<double, const VehicleRecord*>> by_way;
  for (const VehicleRecord& vehicle : timeline.vehicles()) {
    if (has_moved(vehicle)) by_way.emplace_back(-vehicle.distance_m(), &vehicle);
  }
  std::stable_sort(by_way.begin(), by_way.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  by_way.resize(std::min(by_way.size(), kDepthStrips));
  std::vector<const VehicleRecord*> shown;
  for (const auto& [way, vehicle] : by_way) shown.push_back(vehicle);
  std::sort(shown.begin(), shown.end(), [](auto* a, auto* b) { return a->index < b->index; });
  return shown;
}

DepthRange depth_range(const RunTimeline& timeline, const std::vector<const VehicleRecord*>& vehicles) {
  double deepest_m = 1, seabed_m = 0, highest_m = 0;
  for (const VehicleRecord* vehicle : vehicles) {
    for (const auto& entry :
         decimated_track(vehicle->track, SimTime::at_once(), SimTime::never(), kMaxPoints)) {
      const Vec3& place = entry.value.position_ned_m;
      deepest_m = std::max(deepest_m, place.z());
      highest_m = std::min(highest_m, place.z());
      const double bottom_m = timeline.seabed_m(place.x(), place.y());
      if (!std::isnan(bottom_m)) seabed_m = std::max(seabed_m, bottom_m);
    }
  }
  const bool is_far = seabed_m > 5 * deepest_m;
  return {highest_m, (is_far ? 1.25 * deepest_m : std::max(deepest_m, seabed_m) * 1.06), is_far};
}

class DepthStrip {
 public:
  DepthStrip(const RunTimeline& timeline, const VehicleRecord& vehicle, const DepthRange& range,
             const TimeAxis& axis, bool is_last)
      : timeline_(timeline), vehicle_(vehicle), range_(range), axis_(axis) {
    picture_.width_px = kChartWidth_px;
    picture_.height_px = kStrip_px + (is_last ? 54 : 10);
    picture_.left_px = 190;
    picture_.right_px = 26;
    picture_.top_px = 8;
    picture_.bottom_px = is_last ? 56 : 2;
    picture_.x = {axis.begin_s / axis.unit_s, axis.end_s / axis.unit_s,
                  is_last ? std::string("time, ") + axis.unit : "", format_number(axis.step_s / axis.unit_s)};
    if (!is_last) picture_.x.tics += " format ''";
    picture_.y = {range.greatest_m, range.least_m, "", tics()};
    picture_.label = "Depth of " + vehicle.name + " over time";
  }

  std::string svg() {
    const auto points = decimated_track(vehicle_.track, SimTime::at_once(), SimTime::never(), kMaxPoints);
    std::string track = "$track << EOD\n", seabed;
    for (const auto& point : points) {
      const Vec3& place = point.value.position_ned_m;
      const double bottom_m = timeline_.seabed_m(place.x(), place.y());
      track += row(point.at, place.z());
      if (std::isnan(bottom_m)) continue;
      seabed += row(point.at, std::min(bottom_m, range_.greatest_m));
      least_seabed_m_ = std::min(least_seabed_m_, bottom_m);
      greatest_seabed_m_ = std::max(greatest_seabed_m_, bottom_m);
    }
    track += "EOD\n";
    const std::string commanded = commanded_rows();
    std::string plots;
    if (!seabed.empty() && !range_.is_seabed_cut) {
      track += "$seabed << EOD\n" + seabed + "EOD\n";
      plots += "$seabed using 1:2 with filledcurves y1=" + format_number(range_.greatest_m) + ink("seabed") +
               " notitle, $seabed using 1:2 with lines lw 1.2" + ink("seabed-edge") + " notitle, ";
    }
    plots += "$track using 1:2 with lines lw 3" + ink(colour_of(vehicle_)) + " notitle";
    if (!commanded.empty()) {
      track += "$commanded << EOD\n" + commanded + "EOD\n";
      plots += ", $commanded using 1:2 with lines lw 1.2 dt (5,4)" + ink("ink") + " notitle";
    }
    picture_.commands = track + "plot " + plots + "\n";
    draw_label(points);
    draw_faults();
    draw_points(points);
    return drawn(picture_);
  }

 private:
  static double shallowest(const std::vector<Timed<TrackPoint>>& points) {
    return depth_m(std::min_element(points.begin(), points.end(), [](const auto& a, const auto& b) {
                     return depth_m(a.value) < depth_m(b.value);
                   })->value);
  }
  static double deepest(const std::vector<Timed<TrackPoint>>& points) {
    return depth_m(std::max_element(points.begin(), points.end(), [](const auto& a, const auto& b) {
                     return depth_m(a.value) < depth_m(b.value);
                   })->value);
  }
  std::string tics() const { return format_number(nice_step()); }
  double nice_step() const {
    const double least = (range_.greatest_m - range_.least_m) / 3;
    const double power = elementary::exp10(std::floor(elementary::log10(least)));
    return least <= 2 * power ? 2 * power : least <= 5 * power ? 5 * power : 10 * power;
  }
  std::string row(SimTime at, double depth) const {
    return fmt::format("{:.4f} {:.2f}\n", at.seconds() / axis_.unit_s, depth);
  }

  // Returns the commanded depth over time. Empty lines interrupt the curve where nothing is commanded.
  std::string commanded_rows() const {
    const auto chosen = decimated(vehicle_.activity.all(), kMaxPoints,
                                  [](const autopilot_status_t& status) { return status.commanded_z_m; });
    std::string rows;
    for (const auto& [at, status] : chosen)
      rows += status.is_propelled != 0
                  ? row(at, std::clamp(status.commanded_z_m, range_.least_m, range_.greatest_m))
                  : "\n";
    return rows.find_first_not_of('\n') == std::string::npos ? "" : rows;
  }

  void draw_label(const std::vector<Timed<TrackPoint>>& points) {
    picture_.overlay +=
        swatch(&vehicle_, 11, 17) +
        fmt::format(R"(<text x="28" y="22" class="lane">{}</text>)", escaped_xml(vehicle_.name)) +
        fmt::format(R"(<text x="0" y="40" class="tick">{:.0f} to {:.0f} m deep</text>)",
                    whole_number(shallowest(points)), whole_number(deepest(points)));
    if (least_seabed_m_ <= greatest_seabed_m_)
      picture_.overlay += fmt::format(R"(<text x="0" y="57" class="tick">seabed {:.0f} to {:.0f} m</text>)",
                                      least_seabed_m_, greatest_seabed_m_);
  }

  void draw_faults() {
    for (const auto& [at, fault] : vehicle_.faults) {
      picture_.overlay += fmt::format(
          R"(<g class="fault"><path d="M{0} {1}V{2}"/><text x="{3}" y="{4}">{5}</text></g>)",
          px(picture_.x_px(at.seconds() / axis_.unit_s)), px(picture_.top_px),
          px(picture_.height_px - picture_.bottom_px), px(picture_.x_px(at.seconds() / axis_.unit_s) + 4),
          px(picture_.top_px + 12), fault.fault_fixed ? "fault fixed" : "fault");
    }
  }

  // Draws invisible points that show details when the pointer rests on them.
  void draw_points(const std::vector<Timed<TrackPoint>>& points) {
    const std::size_t step = std::max<std::size_t>(points.size() / 100, 1);
    for (std::size_t i = 0; i < points.size(); i += step) {
      const Vec3& place = points[i].value.position_ned_m;
      const double bottom_m = timeline_.seabed_m(place.x(), place.y());
      const std::string below = std::isnan(bottom_m) ? "" : fmt::format(", seabed at {:.0f} m", bottom_m);
      picture_.overlay += fmt::format(
          R"(<circle cx="{}" cy="{}" r="5" class="point">{}</circle>)",
          px(picture_.x_px(points[i].at.seconds() / axis_.unit_s)), px(picture_.y_px(place.z())),
          hover(fmt::format("{} at {}: {:.1f} m deep, {:.1f} m/s{}", vehicle_.name,
                            time_text(points[i].at.seconds()), place.z(), points[i].value.speed_mps, below)));
    }
  }

  const RunTimeline& timeline_;
  const VehicleRecord& vehicle_;
  DepthRange range_;
  TimeAxis axis_;
  Picture picture_;
  double least_seabed_m_ = HUGE_VAL, greatest_seabed_m_ = -HUGE_VAL;  // below the vehicle
};

}  // namespace

std::string depth_chart(const RunTimeline& timeline) {
  const auto vehicles = shown_vehicles(timeline);
  if (vehicles.empty()) return "";
  const DepthRange range = depth_range(timeline, vehicles);
  const TimeAxis axis = time_axis(std::max(timeline.begin(), SimTime()), timeline.end(), 12);
  std::string strips;
  for (const VehicleRecord* vehicle : vehicles)
    strips += DepthStrip(timeline, *vehicle, range, axis, vehicle == vehicles.back()).svg();
  return strips;
}

bool is_seabed_drawn(const RunTimeline& timeline) {
  return timeline.terrain() && !depth_range(timeline, shown_vehicles(timeline)).is_seabed_cut;
}

std::string left_out_strips(const RunTimeline& timeline) {
  const auto moved = std::count_if(timeline.vehicles().begin(), timeline.vehicles().end(), has_moved);
  const auto left_out = moved - static_cast<std::ptrdiff_t>(kDepthStrips);
  return left_out > 0 ? fmt::format("{} vehicles with shorter ways are left out. ", left_out) : "";
}

std::string resting_vehicles(const RunTimeline& timeline) {
  constexpr std::size_t kNamed = 12;
  std::string names;
  std::size_t count = 0;
  for (const VehicleRecord& vehicle : timeline.vehicles()) {
    if (vehicle.track.empty() || !vehicle.is_at_rest() || ++count > kNamed) continue;
    names += fmt::format("{}{} ({:.0f} m)", names.empty() ? "" : ", ", vehicle.name,
                         depth_m(vehicle.track.front().value));
  }
  if (names.empty()) return "";
  if (count > kNamed) names += fmt::format(" and {} more", count - kNamed);
  return names + " stayed at rest.";
}

}  // namespace halocline::clients
