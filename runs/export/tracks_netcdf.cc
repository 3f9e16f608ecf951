// SPDX-License-Identifier: BSD-3-Clause
// Output of tracks as netCDF-4, through netCDF's C library. Part of the module halocline_tracks_netcdf.so,
// which only run_export.cc loads.
#include <cstddef>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "bus/version.h"
#include "core/atomic_file.h"
#include "runs/export/netcdf_output.h"
#include "runs/export/run_export.h"
#include "runs/foxglove/foxglove_messages.h"
#include "runs/timeline/run_timeline.h"
#include "runs/timeline/timed_series.h"
#include "runs/timeline/vehicle_record.h"

namespace halocline::clients {
namespace {

struct TrackVariable {
  const char* name;
  const char* standard_name;  // CF standard name; empty: none
  const char* unit;
  const char* meaning;
  std::function<double(const Timed<TrackPoint>&)> value;
};

std::vector<TrackVariable> quantities(const RunTimeline& timeline) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  const double surface_m = timeline.scenario().sea_surface_z_m;
  std::vector<TrackVariable> all{
      {"time", "time", "seconds since 1970-01-01 00:00:00", "simulation time",
       [](const auto& e) { return e.at.seconds(); }},
      {"depth", "depth", "m", "below the sea surface",
       [surface_m](const auto& e) { return e.value.position_ned_m.z() - surface_m; }},
      {"north", "", "m", "from the scenario's origin",
       [](const auto& e) { return e.value.position_ned_m.x(); }},
      {"east", "", "m", "from the scenario's origin",
       [](const auto& e) { return e.value.position_ned_m.y(); }},
      {"heading", "platform_orientation", "degree", "clockwise from north",
       [](const auto& e) { return e.value.attitude.yaw * kDegrees + (e.value.attitude.yaw < 0 ? 360 : 0); }},
      {"speed", "platform_speed_wrt_ground", "m s-1", "over ground",
       [](const auto& e) { return e.value.speed_mps; }}};
  const auto frame = frame_of(timeline);
  if (!frame) return all;
  const auto place = [frame](const Timed<TrackPoint>& entry) {
    return place_of(*frame, entry.value.position_ned_m);
  };
  all.push_back({"lat", "latitude", "degrees_north", "WGS 84",
                 [place](const auto& e) { return place(e).latitude_deg; }});
  all.push_back({"lon", "longitude", "degrees_east", "WGS 84",
                 [place](const auto& e) { return place(e).longitude_deg; }});
  return all;
}

void write_quantity(NetcdfOutput& file, const RunTimeline& timeline, const TrackVariable& quantity,
                    int observations) {
  const int variable = file.variable(quantity.name, NetcdfOutput::Type::kDouble, {observations});
  const std::string name = quantity.name;
  if (*quantity.standard_name != '\0') file.attribute(variable, "standard_name", quantity.standard_name);
  file.attribute(variable, "units", quantity.unit);
  file.attribute(variable, "long_name", quantity.meaning);
  const bool is_axis = name == "time" || name == "depth" || name == "lat" || name == "lon";
  if (name == "time") file.attribute(variable, "calendar", "standard");
  if (name == "depth") file.attribute(variable, "positive", "down");
  if (is_axis)
    file.attribute(variable, "axis",
                   name == "time"    ? "T"
                   : name == "depth" ? "Z"
                   : name == "lat"   ? "Y"
                                     : "X");
  if (!is_axis)
    file.attribute(variable, "coordinates", frame_of(timeline) ? "time lat lon depth" : "time depth");
  std::vector<double> values;
  for (const VehicleRecord& vehicle : timeline.vehicles()) {
    for (const Timed<TrackPoint>& entry : vehicle.track.all()) values.push_back(quantity.value(entry));
  }
  file.put(variable, values);
}

void write_file(const RunTimeline& timeline, const std::string& path) {
  std::vector<const char*> names;
  std::vector<int> sizes;
  std::size_t total = 0;
  for (const VehicleRecord& vehicle : timeline.vehicles()) {
    names.push_back(vehicle.name.c_str());
    sizes.push_back(static_cast<int>(vehicle.track.size()));
    total += vehicle.track.size();
  }
  AtomicFile replacement(path);
  NetcdfOutput file(replacement.temporary_path());
  file.attribute("Conventions", "CF-1.8");
  file.attribute("featureType", "trajectory");
  file.attribute("title",
                 "Tracks of " + (timeline.scenario().name.empty() ? "a run" : timeline.scenario().name));
  file.attribute("source", std::string("halocline ") + bus::kVersion);
  const int trajectories = file.dimension("trajectory", names.size()),
            observations = file.dimension("obs", total);
  const int name = file.variable("trajectory", NetcdfOutput::Type::kText, {trajectories});
  file.attribute(name, "cf_role", "trajectory_id");
  file.attribute(name, "long_name", "name of the vehicle");
  file.put(name, names);
  const int size = file.variable("rowSize", NetcdfOutput::Type::kInteger, {trajectories});
  file.attribute(size, "long_name", "number of states of the vehicle");
  file.attribute(size, "sample_dimension", "obs");
  file.put(size, sizes);
  for (const TrackVariable& quantity : quantities(timeline))
    write_quantity(file, timeline, quantity, observations);
  file.close();
  replacement.commit();
}

}  // namespace
}  // namespace halocline::clients

extern "C" halocline::clients::TracksWriter halocline_write_tracks_netcdf;

void halocline_write_tracks_netcdf(const halocline::clients::RunTimeline& timeline, const std::string& path) {
  halocline::clients::write_file(timeline, path);
}
