// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/report/run_chart.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/csv_table.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "runs/plot/plot.h"
#include "runs/timeline/delivery.h"
#include "runs/timeline/plan_texts.h"
#include "runs/timeline/vehicle_record.h"
#include "viewer/report/chart_texts.h"
#include "viewer/report/loss_marks.h"
#include "viewer/report/picture.h"
#include "viewer/report/seabed_raster.h"
#include "viewer/report/svg.h"
#include "viewer/report/vehicle_style.h"

namespace halocline::clients {
namespace {

constexpr std::size_t kTrackPoints = 400, kAllTrackPoints = 30'000, kVehiclesDrawn = 300,
                      kVehiclesWithDetails = 12, kVehiclesWithLinks = 6, kVehiclesNamed = 40;
constexpr std::size_t kRaster_px = 360, kContourStep = 4;
constexpr double kMinSpan_m = 200, kMargin = 0.13;

// Returns a square that contains every track and plan; empty when no vehicle has a position.
std::optional<MapExtent> extent_of(const RunTimeline& timeline) {
  Vec3 least = Vec3::Constant(1e300), greatest = -least;
  for (const VehicleRecord& vehicle : timeline.vehicles()) {
    const auto take = [&](const Vec3& place) {
      least = least.cwiseMin(place);
      greatest = greatest.cwiseMax(place);
    };
    for (const auto& entry : vehicle.track.all()) take(entry.value.position_ned_m);
    if (vehicle.track.empty() || vehicle.plans.empty()) continue;
    const vehicle_plan_t& plan = vehicle.plans.back().value;
    for (std::int32_t behaviour = 0; behaviour < plan.num_behaviours; ++behaviour) {
      for (const Vec3& waypoint : waypoints_of(plan, behaviour)) take(waypoint);
    }
  }
  if (least.x() > greatest.x()) return std::nullopt;
  const double span =
      std::max({greatest.x() - least.x(), greatest.y() - least.y(), kMinSpan_m}) * (1 + 2 * kMargin);
  const Vec3 middle = (least + greatest) / 2;
  return MapExtent{middle.x() - span / 2, middle.y() - span / 2, middle.x() + span / 2,
                   middle.y() + span / 2};
}

class RunChart {
 public:
  RunChart(const RunTimeline& timeline, const PacketLinks& links, const MapExtent& extent)
      : timeline_(timeline), links_(links), extent_(extent) {
    picture_.width_px = 640;
    picture_.height_px = 616;
    picture_.left_px = 58;
    picture_.right_px = 62;
    picture_.top_px = 40;
    picture_.bottom_px = 56;
    picture_.x = {extent.west_m, extent.east_m, "east, m"};
    picture_.y = {extent.south_m, extent.north_m, "north, m"};
    picture_.label = "Chart of the run: seabed, tracks and lost packets";
    picture_.has_grid = false;
  }

  std::string svg() {
    draw_seabed();
    overlay("<g class=\"" + std::string(raster_ ? "on-map" : "on-paper") + "\">");
    draw_links();
    for (const VehicleRecord& vehicle : timeline_.vehicles()) {
      if (vehicle.track.empty() || drawn_++ >= kVehiclesDrawn) continue;
      if (has_details(timeline_) && !vehicle.plans.empty()) draw_plan(vehicle);
      draw_track(vehicle);
    }
    overlay(loss_marks(timeline_, links_, picture_));
    draw_names();
    draw_scale();
    overlay("</g>");
    return drawn(picture_);
  }

 private:
  std::size_t points_each() const {
    return std::min(kTrackPoints, kAllTrackPoints / std::min(timeline_.vehicles().size(), kVehiclesDrawn));
  }
  void overlay(const std::string& svg) { picture_.overlay += svg + "\n"; }
  double x(double east_m) const { return picture_.x_px(east_m); }
  double y(double north_m) const { return picture_.y_px(north_m); }
  double x(const Vec3& place) const { return x(place.y()); }
  double y(const Vec3& place) const { return y(place.x()); }

  void draw_seabed() {
    if (!timeline_.terrain()) return draw_empty_map();
    SeabedRaster raster = seabed_raster(*timeline_.terrain(), extent_, kRaster_px, kRaster_px);
    if (raster.least_m > raster.greatest_m) return draw_empty_map();
    raster_ = std::move(raster);
    const double pixel_m = (extent_.east_m - extent_.west_m) / static_cast<double>(kRaster_px);
    const double step_m = round_step(std::max<double>(raster_->greatest_m - raster_->least_m, 1) / 9);
    std::string& commands = picture_.commands;
    commands += "$depths << EOD\n" + contour_grid(pixel_m) + "EOD\n";
    // gnuplot computes the contours first, into a table, and draws them on the same axes as the picture of
    // the seabed.
    commands += "set contour base\nunset surface\nset cntrparam levels incremental " +
                format_number(std::ceil(raster_->least_m / step_m) * step_m) + "," + format_number(step_m) +
                "," + format_number(raster_->greatest_m) +
                "\nset table $contours\nsplot $depths using 1:2:3\nunset table\nunset contour\nset surface\n";
    commands += fmt::format(
        "plot '-' binary array=({0},{0}) format='%uchar' origin=({1},{2}) dx={3} dy={3} with rgbalpha, "
        "$contours using 1:2 with lines lw 0.8 lc rgb '#70102030', "
        "$contours using ((int($0) % 70 == 35) ? $1 : NaN):2:(sprintf('%g', $3)) with labels tc rgb "
        "'#01fe06'\n",
        kRaster_px, format_number(extent_.west_m + pixel_m / 2), format_number(extent_.south_m + pixel_m / 2),
        format_number(pixel_m));
    commands.append(raster_->rgba.begin(), raster_->rgba.end());
    draw_depth_bar();
  }

  void draw_empty_map() {
    picture_.commands += "plot NaN notitle\n";
    overlay(fmt::format(R"(<rect x="{}" y="{}" width="{}" height="{}" class="empty-map"/>)",
                        px(picture_.left_px), px(picture_.top_px),
                        px(picture_.width_px - picture_.left_px - picture_.right_px),
                        px(picture_.height_px - picture_.top_px - picture_.bottom_px)));
  }

  std::string contour_grid(double pixel_m) const {
    std::string grid;
    for (std::size_t v = kContourStep / 2; v < kRaster_px; v += kContourStep) {
      for (std::size_t u = kContourStep / 2; u < kRaster_px; u += kContourStep) {
        grid += fmt::format(
            "{:.1f} {:.1f} {:.2f}\n", extent_.west_m + (static_cast<double>(u) + 0.5) * pixel_m,
            extent_.south_m + (static_cast<double>(v) + 0.5) * pixel_m, raster_->depth_m[v * kRaster_px + u]);
      }
      grid += "\n";
    }
    return grid;
  }

  void draw_depth_bar() {
    constexpr int kSteps = 24;
    const double left = picture_.width_px - picture_.right_px + 14, top = picture_.top_px, height = 150;
    for (int i = 0; i < kSteps; ++i) {
      const auto c = deep_colour(0.12 + 0.7 * (i + 0.5) / kSteps);
      overlay(fmt::format(R"(<rect x="{}" y="{}" width="10" height="{}" fill="#{:02x}{:02x}{:02x}"/>)",
                          px(left), px(top + i * height / kSteps), px(height / kSteps + 0.5), c[0], c[1],
                          c[2]));
    }
    for (const double share : {0.0, 0.5, 1.0}) {
      const double depth_m = std::lerp(raster_->least_m, raster_->greatest_m, share);
      overlay(fmt::format(R"(<text x="{}" y="{}" class="tick">{:.0f}</text>)", px(left + 14),
                          px(top + share * height + 4), depth_m));
    }
    overlay(fmt::format(R"(<text x="{}" y="{}" class="tick">depth, m</text>)", px(left - 12), px(top - 10)));
  }

  // Draws the quality of links: a line between the last positions of two vehicles, with a width that grows
  // with the share received.
  void draw_links() {
    const auto with_places = std::count_if(timeline_.vehicles().begin(), timeline_.vehicles().end(),
                                           [](const VehicleRecord& v) { return !v.track.empty(); });
    if (with_places > static_cast<std::ptrdiff_t>(kVehiclesWithLinks)) return;
    std::map<std::pair<std::int32_t, std::int32_t>, PairDelivery> both_ways;
    for (const PairDelivery& pair : delivery_by_pair(timeline_)) {
      PairDelivery& sum = both_ways[std::minmax(pair.from_id, pair.to_id)];
      sum.packets += pair.packets;
      sum.received += pair.received;
    }
    for (const auto& [ids, pair] : both_ways) {
      const VehicleRecord* a = timeline_.find(ids.first);
      const VehicleRecord* b = timeline_.find(ids.second);
      if (a == nullptr || b == nullptr || a->track.empty() || b->track.empty() || pair.received == 0)
        continue;
      const Vec3 from = a->track.back().value.position_ned_m, to = b->track.back().value.position_ned_m;
      overlay(fmt::format(
          R"(<g><line x1="{}" y1="{}" x2="{}" y2="{}" class="link" style="stroke-width:{}px"/>{}</g>)",
          px(x(from)), px(y(from)), px(x(to)), px(y(to)), px(1 + 4 * pair.share()),
          hover(fmt::format("{} and {}: {} of {} packets received ({:.0f} %)", a->name, b->name,
                            pair.received, pair.packets, 100 * pair.share()))));
    }
  }

  void draw_plan(const VehicleRecord& vehicle) {
    const vehicle_plan_t& plan = vehicle.plans.back().value;
    for (std::int32_t behaviour = 0; behaviour < plan.num_behaviours; ++behaviour) {
      std::string path, points;
      const std::vector<Vec3> waypoints = waypoints_of(plan, behaviour);
      for (std::size_t i = 0; i < waypoints.size(); ++i) {
        path += fmt::format("{}{} {}", path.empty() ? "M" : "L", px(x(waypoints[i])), px(y(waypoints[i])));
        points += fmt::format(
            R"(<rect x="{}" y="{}" width="6" height="6" class="waypoint">{}</rect>)", px(x(waypoints[i]) - 3),
            px(y(waypoints[i]) - 3),
            hover(fmt::format("Waypoint {} of {}: {}", i + 1, vehicle.name, place_text(waypoints[i]))));
      }
      const bool is_closed =
          plan.at_end == vehicle_plan_t::LOOP && plan.num_behaviours == 1 && waypoints.size() > 2;
      if (!path.empty())
        overlay("<g class=\"" + colour_of(vehicle) + "\"><path d=\"" + path + (is_closed ? "Z" : "") +
                "\" class=\"plan\"/>" + points + "</g>");
    }
  }

  void draw_track(const VehicleRecord& vehicle) {
    const auto points = decimated_track(vehicle.track, SimTime::at_once(), SimTime::never(), points_each());
    std::string path;
    for (const auto& point : points)
      path += fmt::format("{}{} {}", path.empty() ? "M" : "L", px(x(point.value.position_ned_m)),
                          px(y(point.value.position_ned_m)));
    if (!vehicle.is_at_rest()) {
      overlay("<path d=\"" + path + "\" class=\"casing\"/><path d=\"" + path + "\" class=\"track " +
              classes_of(&vehicle) + "\"/>");
      const Vec3 start = points.front().value.position_ned_m;
      overlay(fmt::format(R"(<circle cx="{}" cy="{}" r="4" class="start {}">{}</circle>)", px(x(start)),
                          px(y(start)), colour_of(vehicle),
                          hover(vehicle.name + " started here: " + place_text(start))));
    }
    if (has_details(timeline_) && !vehicle.is_at_rest()) draw_times(vehicle);
  }

  // Draws a dot at every round instant, with details for the pointer.
  void draw_times(const VehicleRecord& vehicle) {
    const double begin_s = vehicle.track.front().at.seconds(), end_s = vehicle.track.back().at.seconds();
    const double step_s = time_dots_s(timeline_);
    for (double t = std::ceil(begin_s / step_s) * step_s; t < end_s; t += step_s) {
      const auto state = state_at(vehicle.track, SimTime::from_seconds(t));
      if (!state) continue;
      const Vec3& place = state->point.position_ned_m;
      overlay(fmt::format(R"(<circle cx="{}" cy="{}" r="2.6" class="time {}">{}</circle>)", px(x(place)),
                          px(y(place)), colour_of(vehicle),
                          hover(fmt::format("{} at {}: {}, {:.1f} m/s", vehicle.name, time_text(t),
                                            place_text(place), state->point.speed_mps))));
    }
  }

  void draw_names() {
    std::size_t named = 0;
    for (const VehicleRecord& vehicle : timeline_.vehicles()) {
      if (vehicle.track.empty() || named++ >= kVehiclesDrawn) continue;
      const TrackPoint& last = vehicle.track.back().value;
      const double cx = x(last.position_ned_m), cy = y(last.position_ned_m);
      const std::string text =
          hover(fmt::format("{} at {}: {}", vehicle.name, time_text(vehicle.track.back().at.seconds()),
                            place_text(last.position_ned_m)));
      if (vehicle.is_at_rest())
        overlay(fmt::format(R"(<rect x="{}" y="{}" width="9" height="9" class="vehicle {}">{}</rect>)",
                            px(cx - 4.5), px(cy - 4.5), colour_of(vehicle), text));
      else
        overlay(
            fmt::format(R"svg(<path d="M0-8L5.5 6L0 3L-5.5 6Z" transform="translate({} {}) rotate({})" )svg"
                        R"svg(class="vehicle {}">{}</path>)svg",
                        px(cx), px(cy), px(to_degrees(last.attitude.yaw)), colour_of(vehicle), text));
      draw_name(vehicle.name, cx, cy - 6);
    }
  }

  // Draws a name next to (cx, y) unless it would cover another; in a fleet names also keep a distance.
  void draw_name(const std::string& name, double cx, double y) {
    const double width = 8.5 * static_cast<double>(name.size());
    const bool is_right = cx + 10 + width < picture_.width_px - picture_.right_px;
    const double left = is_right ? cx + 10 : cx - 10 - width;
    const double gap = timeline_.vehicles().size() <= kVehiclesNamed ? 0 : 45;
    for (const NameBox& other : names_) {
      if (left < other.left + other.width + gap && other.left < left + width + gap &&
          std::abs(y - other.y) < 14 + gap)
        return;
    }
    names_.push_back({left, width, y});
    overlay(fmt::format(R"(<text x="{}" y="{}" text-anchor="{}" class="name">{}</text>)",
                        px(cx + (is_right ? 10 : -10)), px(y), is_right ? "start" : "end",
                        escaped_xml(name)));
  }

  void draw_scale() {
    const double span_m = extent_.east_m - extent_.west_m, length_m = round_step(span_m / 8);
    const double left = picture_.left_px + 14, bottom = picture_.height_px - picture_.bottom_px - 16;
    const double right = left + x(length_m) - x(0.0);
    overlay(fmt::format(R"(<path d="M{0} {1}v6H{2}v-6" class="scale"/>)"
                        R"(<text x="{3}" y="{4}" text-anchor="middle" class="name">{5}</text>)",
                        px(left), px(bottom - 6), px(right), px((left + right) / 2), px(bottom - 9),
                        distance_text(length_m)));
    const double nx = picture_.left_px + 20, ny = picture_.top_px + 40;
    overlay(fmt::format(R"(<path d="M{0} {1}v-26m-5 8l5-9l5 9" class="scale"/>)"
                        R"(<text x="{0}" y="{2}" text-anchor="middle" class="name">N</text>)",
                        px(nx), px(ny), px(ny + 14)));
  }

  const RunTimeline& timeline_;
  const PacketLinks& links_;
  MapExtent extent_;
  Picture picture_;
  std::optional<SeabedRaster> raster_;
  struct NameBox {
    double left, width, y;
  };
  std::vector<NameBox> names_;
  std::size_t drawn_ = 0;
};

}  // namespace

std::string run_chart(const RunTimeline& timeline, const PacketLinks& links) {
  const auto extent = extent_of(timeline);
  return extent ? RunChart(timeline, links, *extent).svg() : "";
}

double time_dots_s(const RunTimeline& timeline) {
  return round_time_step((timeline.end() - std::max(timeline.begin(), SimTime())).seconds() / 12);
}

std::string left_out_tracks(const RunTimeline& timeline) {
  const auto with_places = std::count_if(timeline.vehicles().begin(), timeline.vehicles().end(),
                                         [](const VehicleRecord& v) { return !v.track.empty(); });
  const auto left_out = with_places - static_cast<std::ptrdiff_t>(kVehiclesDrawn);
  return left_out > 0 ? fmt::format(" {} more vehicles are left out.", left_out) : "";
}

bool has_details(const RunTimeline& timeline) { return timeline.vehicles().size() <= kVehiclesWithDetails; }

}  // namespace halocline::clients
