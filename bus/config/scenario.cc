// SPDX-License-Identifier: BSD-3-Clause
#include "bus/config/scenario.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <set>

#include "bus/config/carried_files.h"
#include "bus/transport/receive_filter.h"
#include "core/limits.h"
#include "core/names.h"

namespace halocline::bus {
namespace {

constexpr double kLongestRunS = 3.2e7;  // a year

void visit_battery(ConfigVisitor& v, VehicleBattery& battery) {
  double capacity_wh = battery.capacity_j / 3600;
  v.number("capacity_wh", capacity_wh, {0, 1e8, "Wh", "energy when full"});
  battery.capacity_j = capacity_wh * 3600;
  v.number("hotel_w", battery.hotel_w, {0, 1e6, "W", "power of everything always on, except the modem"});
  v.advanced([&] {
    v.number("listening_w", battery.listening_w, {0, 1e6, "W", "power of the listening modem, always drawn"});
    v.number("receiving_w", battery.receiving_w, {0, 1e6, "W", "additional power during a reception"});
    v.number("transmit_efficiency", battery.transmit_efficiency,
             {0.001, 1, "", "efficiency of amplifier and transducer: acoustic over electric power"});
    v.number("shaft_efficiency", battery.shaft_efficiency,
             {0.001, 1, "", "efficiency of motor and gear: power of the shafts over electric power"});
  });
}

// True for the shipped models that follow the surface.
bool floats_by_itself(const FilePath& model) {
  return model == "surface-craft" || model == "buoy" || model == "drifter";
}

void visit_vehicle(ConfigVisitor& v, VehicleEntry& vehicle) {
  v.shared_with_others();
  v.text("name", vehicle.name, {}, "name, which ends the vehicle's channels; " + std::string(kNameRule));
  if (!is_valid_name(vehicle.name)) v.problem("name", "allowed is a name of " + std::string(kNameRule));
  integer_as(v, "id", vehicle.id, {1, 2147483647, "", "unique number of the vehicle"});
  if (vehicle.id < 1) v.problem("id", "allowed is a whole number from 1");
  v.file("model", vehicle.model, FileNames::kShipped,
         "torpedo, hover, remus100-pvs, a model file .toml, fixed (does not move) or external (moved by "
         "another process)");
  v.vector3("start_ned_m", vehicle.start_ned_m, {-1e6, 1e6, "m", "position at the start: north, east, down"});
  degrees(v, "heading_deg", vehicle.heading_rad,
          {-360, 360, "deg", "heading at the start, clockwise from north"});
  const bool is_moved = vehicle.model != "fixed" && vehicle.model != "external";
  v.when(is_moved, "a model that moves", [&] {
    v.number("speed_mps", vehicle.speed_mps, {-5, 5, "m/s", "speed at the start, forward through the water"});
  });
  if (!v.writing() && floats_by_itself(vehicle.model)) vehicle.mount = Mount::kFloating;
  choice(v, "mount", vehicle.mount, {"fixed", "floating"},
         "mount of the modem: fixed at its depth, where waves may leave it out of the water, or floating "
         "with the surface and its tide, as surface-craft, buoy and drifter do where nothing is said");
  if (v.writing() ? !vehicle.battery.has_value() : !v.given("battery")) return;
  VehicleBattery battery = vehicle.battery.value_or(VehicleBattery());
  v.section("battery", "Battery; without this section the vehicle has unlimited energy",
            [&](ConfigVisitor& section) { visit_battery(section, battery); });
  vehicle.battery = battery;
}

// The name is used for folders and files.
bool is_valid_scenario_name(std::string_view name) {
  constexpr std::size_t kLongest = 64;
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.' || c == ' ';
  };
  return !name.empty() && name.size() <= kLongest && std::all_of(name.begin(), name.end(), allowed) &&
         name.front() != '.' && name.front() != '-' && name.front() != ' ' && name.back() != ' ';
}

void visit_tide(ConfigVisitor& v, TideConstituent& tide) {
  v.number("amplitude_m", tide.amplitude_m, {0, 20, "m", "amplitude of this constituent of the tide"});
  v.number("period_s", tide.period_s, {600, 1e8, "s", "period of the constituent; M2 has 44714.16 s"});
  degrees(
      v, "phase_deg", tide.phase_rad,
      {-360, 360, "deg", "phase of the constituent at simulation time 0, by which its high water is later"});
}

void visit_ocean(ConfigVisitor& v, OceanEntry& ocean) {
  v.file("file", ocean.file, FileNames::kFiles,
         "CF netCDF file with currents, or temperature and salinity, or both; empty: none");
  if (!ocean.file.empty() && !v.writing()) require_readable(v, "file", ocean.file);
  v.when(!ocean.file.empty(), "file = \"FILE\"", [&] {
    v.text("start_date", ocean.start_date, {},
           "date of simulation time 0, as 2026-05-01T06:00:00Z; empty: the file's first time");
    v.boolean("moves_vehicles", ocean.moves_vehicles,
              "true: the file's currents are added to those of the vehicle simulator");
    v.boolean("carries_sound", ocean.carries_sound,
              "true: sound propagates through the file's temperature and salinity instead of the profile");
  });
}

// Reads the depth of a shape, whose defaults are those of bathymetry/terrain/generated_terrain.h.
void visit_depth_of_shape(ConfigVisitor& terrain, const std::string& kind, Scenario& s) {
  double z_m = kind == "ridge" ? 200 : kind == "seamount" ? 2000 : 100;
  terrain.section(kind, "", [&](ConfigVisitor& shape) {
    shape.shared_with_others();
    shape.number("depth_m", z_m, {-1e9, 1e9, "m", ""});  // the bathymetry service checks its range
  });
  s.water_depth_m = std::max(z_m - s.sea_surface_z_m, 0.0);
}

// The keys belong to the bathymetry service. They are visited here so that a program that records the
// configuration knows the files that they name, and one that knows no terrain the depth of a shape.
void visit_terrain_of(ConfigVisitor& v, Scenario& s) {
  FilePath path;
  const auto visit_raster = [&](ConfigVisitor& raster) {
    raster.shared_with_others();
    raster.file("path", path, FileNames::kRasters, "");
  };
  const auto visit_terrain = [&](ConfigVisitor& terrain) {
    terrain.shared_with_others();
    std::string kind = "flat";
    terrain.text("kind", kind, {}, "");
    if (kind == "flat" || kind == "slope" || kind == "ridge" || kind == "seamount")
      visit_depth_of_shape(terrain, kind, s);
    terrain.when(kind == "raster", "kind = \"raster\"", [&] { terrain.section("raster", "", visit_raster); });
    terrain.list(
        "nested", "", 0, [](std::size_t) {},
        [&](ConfigVisitor& nested, std::size_t) {
          nested.shared_with_others();
          nested.section("raster", "", visit_raster);
        });
  };
  v.section("terrain", "", visit_terrain);
}

// Two vehicles with the same name would publish on the same channel; with the same id, other vehicles could
// not tell them apart.
class VehicleChecks {
 public:
  void check(ConfigVisitor& v, const std::vector<VehicleEntry>& vehicles, std::size_t index) {
    const VehicleEntry& vehicle = vehicles[index];
    if (!names_.insert(vehicle.name).second)
      v.problem("name", "an earlier vehicle has this name; names are unique");
    if (!ids_.insert(vehicle.id).second) v.problem("id", "an earlier vehicle has this id; ids are unique");
    if (index == kMaxVehicles) {
      v.problem("name", "the channel server follows " + std::to_string(kMaxVehicles) +
                            " vehicles, allowed are no more; these are " + std::to_string(vehicles.size()));
    }
  }

 private:
  std::set<std::string, std::less<>> names_;
  std::set<std::int32_t> ids_;
};

}  // namespace

const VehicleEntry* Scenario::find(std::string_view vehicle_name) const {
  const auto found = std::find_if(vehicles.begin(), vehicles.end(),
                                  [&](const VehicleEntry& vehicle) { return vehicle.name == vehicle_name; });
  return found == vehicles.end() ? nullptr : &*found;
}

Vec3 Scenario::start_ned_m(const VehicleEntry& vehicle) const {
  const double height_m = vehicle.mount == Mount::kFloating ? tide.height_m(0) : 0;
  return vehicle.start_ned_m - Vec3(0, 0, height_m);
}

void visit(ConfigVisitor& v, Scenario& s) {
  v.section("scenario", "Name, place and duration of the run", [&](ConfigVisitor& section) {
    section.text("name", s.name, {}, "short name, also of the run's folder and files");
    if (!is_valid_scenario_name(s.name))
      section.problem(
          "name",
          "allowed are 1 to 64 letters, digits, '_', '-', '.' and spaces, a letter, digit or '_' first");
    section.text("description", s.description, {}, "one line for a person");
    integer_as(section, "seed", s.seed, {0, 9e15, "", "seed of all random draws"});
    seconds(section, "duration_s", s.duration, {0.001, kLongestRunS, "s", "simulated time of a run"});
    if (!section.writing())
      s.origin_given = section.given("origin_latitude_deg") || section.given("origin_longitude_deg");
    if (!section.writing() || s.origin_given) {
      section.number("origin_latitude_deg", s.origin_latitude_deg,
                     {-90, 90, "deg", "latitude of the world's origin"});
      section.number("origin_longitude_deg", s.origin_longitude_deg,
                     {-180, 360, "deg", "longitude of the world's origin"});
    }
    section.number("sea_surface_z_m", s.sea_surface_z_m,
                   {-100, 100, "m", "z of the sea surface; negative when above the terrain's datum"});
  });
  v.section("time", "Pace of simulation time", [&](ConfigVisitor& section) {
    section.number("rate", s.rate, {1e-3, 1e4, "", "simulated seconds per wall second in real time"});
    section.advanced([&] {
      seconds(section, "clock_period_s", s.clock_period,
              {1e-3, 60, "s", "simulated time between CLOCK messages"});
    });
  });
  v.section("bus", "Hosts that may publish on the bus", [&](ConfigVisitor& section) {
    section.text(
        "accept", s.accept, {},
        "other hosts whose messages are received: any, or addresses and ranges as 10.0.3.7, 10.0.4.0/24; "
        "empty: any if the bus has ttl=1, none with ttl=0");
    report_refusal(section, "accept", [&] { accepted_hosts(s.accept, ""); });
    section.advanced([&] {
      section.number("tile_m", s.tile_m,
                     {0, 1e6, "m",
                      "side of tiles with a multicast group each for messages to the programs aboard the "
                      "vehicles that start there; 0: one group for all"});
    });
  });
  v.section("ocean", "Ocean model: currents, temperature and salinity by place and time",
            [&](ConfigVisitor& section) { visit_ocean(section, s.ocean); });
  std::vector<TideConstituent>& tide = s.tide.constituents;
  v.list(
      "tide", "A constituent of the tide, which moves the sea surface about sea_surface_z_m", tide.size(),
      [&](std::size_t n) { tide.resize(n); },
      [&](ConfigVisitor& item, std::size_t i) { visit_tide(item, tide[i]); });
  if (!v.writing()) {
    visit_terrain_of(v, s);
    // The key belongs to the channel server.
    v.section("channel_server", "", [&](ConfigVisitor& section) {
      section.shared_with_others();
      seconds(section, "state_lag_s", s.state_lag, {0, 10, "s", ""});
    });
  }
  VehicleChecks checks;
  v.list(
      "vehicle", "A vehicle", s.vehicles.size(), [&](std::size_t n) { s.vehicles.resize(n); },
      [&](ConfigVisitor& item, std::size_t i) {
        visit_vehicle(item, s.vehicles[i]);
        checks.check(item, s.vehicles, i);
      });
}

std::string configuration_of(const ConfigFile& file) {
  return file.to_toml({"channel_server.shard", "channel_server.shards", "channel_server.threads",
                       "vehicle_sim.block", "vehicle_sim.blocks", "vehicle_sim.threads"});
}

}  // namespace halocline::bus
