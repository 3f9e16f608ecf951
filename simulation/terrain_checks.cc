// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "bathymetry/rasters/raster_loader.h"
#include "bathymetry/rasters/terrain_recipe.h"
#include "bathymetry/terrain/terrain.h"
#include "bus/config/config.h"
#include "clients/onboard/autopilot/autopilot_config.h"
#include "clients/onboard/autopilot/plan.h"
#include "core/csv_table.h"
#include "core/elementary.h"
#include "core/frames.h"
#include "simulation/composition.h"
#include "simulation/scenario_checks.h"
#include "vehicle_sim/start_checks.h"
#include "vehicle_sim/world/terrain_seabed.h"

namespace halocline::clients {
namespace {

using bathymetry::DepthSample;
using bathymetry::DepthStatus;
using bathymetry::RasterReport;

// Height above the surface up to which a position is taken as a wish to surface, not as a mistake.
constexpr double kToSurface_m = 1;
constexpr double kPointSpacing_m = 20;  // distance between points that are examined along a track or a circle

std::string rounded(double value) { return format_number(std::round(10 * value) / 10); }

// Counts of the examined points of a mission by where they are.
struct PointCounts {
  int in_water = 0, below_seabed = 0, in_air = 0, unknown = 0;
  double shallowest_seabed_m = HUGE_VAL;

  int all() const { return in_water + below_seabed + in_air + unknown; }
};

class MissionChecks {
 public:
  MissionChecks(const ScenarioConfig& config, const bathymetry::Terrain& terrain, bus::ConfigFile& file)
      : surface_z_m_(config.scenario.sea_surface_z_m), terrain_(terrain), file_(file) {}

  void check(const std::string& mission_key, const PilotConfig& pilot) {
    if (pilot.behaviours.empty())
      return check_waypoints(mission_key + ".waypoints", pilot.mission.waypoints, /*by_altitude=*/false);
    for (std::size_t k = 0; k < pilot.behaviours.size(); ++k)
      check(mission_key + ".behaviour." + std::to_string(k), pilot.behaviours[k]);
  }

 private:
  void check(const std::string& key, const Behaviour& b) {
    const bool by_altitude = b.altitude_m > 0;
    switch (b.kind) {
      case BehaviourKind::kWaypoints:
      case BehaviourKind::kSeekLink:  // the channel server checks its depths: some may be below the seabed
        return check_waypoints(key + ".waypoints", b.waypoints, by_altitude);
      case BehaviourKind::kSurvey:
        return check_track(key, "survey", b, along(survey_points(b)));
      case BehaviourKind::kLoiter:
        return check_track(key, "circle", b, circle(b));
      case BehaviourKind::kHeading:
      case BehaviourKind::kFollow:
      case BehaviourKind::kWait:
        return;
    }
  }

  void count(const Vec3& point, bool by_altitude, PointCounts& counts) const {
    const DepthSample seabed = terrain_.depth_at(point.x(), point.y());
    if (seabed.status != DepthStatus::kOk) {
      ++counts.unknown;
      return;
    }
    counts.shallowest_seabed_m = std::min(counts.shallowest_seabed_m, seabed.z_m);
    const bool in_air = !by_altitude && point.z() < surface_z_m_ - kToSurface_m;
    const bool below_seabed = by_altitude ? seabed.z_m < surface_z_m_ : point.z() > seabed.z_m;
    ++(in_air ? counts.in_air : below_seabed ? counts.below_seabed : counts.in_water);
  }

  void check_waypoints(const std::string& key, const std::vector<Vec3>& waypoints, bool by_altitude) {
    for (std::size_t i = 0; i < waypoints.size(); ++i) {
      PointCounts counts;
      count(waypoints[i], by_altitude, counts);
      const std::string point_key = key + "." + std::to_string(i);
      if (counts.in_air > 0)
        file_.refuse(point_key, "",
                     "that is above the sea surface; allowed is a z, positive down, of " +
                         format_number(surface_z_m_) + " m and more");
      if (counts.below_seabed > 0)
        file_.refuse(point_key, "",
                     "that is below the seabed, whose z there is " + rounded(counts.shallowest_seabed_m) +
                         " m; allowed is a lesser z, or altitude_m of a behaviour");
      if (counts.unknown > 0)
        file_.warn(point_key, "", "the terrain is not known there: it lies " + extent_text(terrain_));
    }
  }

  void check_track(const std::string& key, const std::string& what, const Behaviour& b,
                   const std::vector<Vec3>& points) {
    PointCounts counts;
    const bool by_altitude = b.altitude_m > 0;
    for (const Vec3& point : points) count(point, by_altitude, counts);
    const std::string depth_key = key + (by_altitude ? ".altitude_m" : ".depth_m");
    const std::string depth = format_number(by_altitude ? b.altitude_m : b.depth_m);
    const auto share = [&](int count) { return rounded(100.0 * count / counts.all()) + " % of the " + what; };
    if (counts.in_air > 0)
      file_.refuse(depth_key, depth,
                   "the " + what + " lies above the sea surface; allowed is a z, positive down, of " +
                       format_number(surface_z_m_) + " m and more");
    if (counts.below_seabed > 0 && counts.in_water == 0)
      file_.refuse(depth_key, depth,
                   "the whole " + what + " lies below the seabed, whose least z there is " +
                       rounded(counts.shallowest_seabed_m) + " m; allowed is less, or altitude_m");
    else if (counts.below_seabed > 0)
      file_.warn(depth_key, depth,
                 share(counts.below_seabed) + " lies below the seabed, whose least z there is " +
                     rounded(counts.shallowest_seabed_m) + " m: the vehicle rises over it");
    if (counts.unknown > 0)
      file_.warn(depth_key, depth,
                 share(counts.unknown) + " lies where the terrain is not known: it is known " +
                     extent_text(terrain_));
  }

  static std::vector<Vec3> along(const std::vector<Vec3>& corners) {
    std::vector<Vec3> points;
    for (std::size_t i = 1; i < corners.size(); ++i) {
      const Vec3 way = corners[i] - corners[i - 1];
      const auto steps = std::max(1, static_cast<int>(way.norm() / kPointSpacing_m));
      for (int k = 0; k <= steps; ++k) points.push_back(corners[i - 1] + way * k / steps);
    }
    return points;
  }

  static std::vector<Vec3> circle(const Behaviour& b) {
    const auto steps =
        std::clamp(static_cast<int>(2 * std::numbers::pi * b.radius_m / kPointSpacing_m), 8, 1000);
    std::vector<Vec3> points;
    for (int k = 0; k < steps; ++k) {
      const double angle = 2 * std::numbers::pi * k / steps;
      points.emplace_back(b.center_north_m + b.radius_m * elementary::cos(angle),
                          b.center_east_m + b.radius_m * elementary::sin(angle), b.depth_m);
    }
    return points;
  }

  double surface_z_m_;
  const bathymetry::Terrain& terrain_;
  bus::ConfigFile& file_;
};

// Warns about rasters, the base raster first and then the nested ones, in the order in which they are read.
void check_rasters(const ScenarioConfig& config, const bathymetry::PreparedTerrain& prepared,
                   bus::ConfigFile& file) {
  const bool has_base = config.terrain.kind == bathymetry::TerrainKind::kRaster;
  for (std::size_t i = 0; i < prepared.rasters.size(); ++i) {
    const RasterReport& report = prepared.rasters[i];
    const bool is_base = has_base && i == 0;
    const std::size_t nested = i - (has_base ? 1 : 0);
    const std::string key =
        is_base ? "terrain.raster.path" : "terrain.nested." + std::to_string(nested) + ".raster.path";
    for (const std::string& warning : report.warnings) file.warn(key, report.path, warning);
    const bool is_filled =
        !is_base && config.terrain.nested.at(nested).holes == bathymetry::Holes::kFillFromAround;
    if (report.posts_without_depth == 0 || is_filled) continue;
    file.warn(key, report.path,
              std::to_string(report.posts_without_depth) +
                  " posts of the grid have no depth: the raster is smaller than the grid, or has no data "
                  "there; a grid of another size or centre may fit");
  }
}

}  // namespace

void check_on_terrain(const ScenarioConfig& config, const bathymetry::PreparedTerrain& prepared,
                      bus::ConfigFile& file) {
  const bathymetry::Terrain& terrain = *prepared.terrain;
  vehicle_sim::check_starts(config.scenario, vehicle_sim::TerrainSeabed(prepared.terrain),
                            extent_text(terrain), file);
  check_rasters(config, prepared, file);
  MissionChecks missions(config, terrain, file);
  for (std::size_t i = 0; i < config.autopilot.vehicles.size(); ++i)
    missions.check("vehicle." + std::to_string(i) + ".mission", config.autopilot.vehicles[i]);
}

}  // namespace halocline::clients
