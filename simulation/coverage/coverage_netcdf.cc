// SPDX-License-Identifier: BSD-3-Clause
// Coverage maps as netCDF-4 after the CF conventions 1.8 (grid mappings: appendix F). Part of the module
// halocline_coverage_files.so, which only coverage_files.cc loads.
#include <cstddef>
#include <string>
#include <vector>

#include <ogr_spatialref.h>

#include "bathymetry/terrain/local_frame.h"
#include "bus/version.h"
#include "core/atomic_file.h"
#include "core/units.h"
#include "runs/export/netcdf_output.h"
#include "simulation/coverage/coverage.h"
#include "simulation/coverage/coverage_files.h"

namespace halocline::clients {
namespace {

using Type = NetcdfOutput::Type;

struct GridAxis {
  const char *name, *letter, *standard_name, *unit, *meaning;
};

void define_axis(NetcdfOutput& file, const GridAxis& axis, int dimension, const std::vector<double>& values) {
  const int variable = file.variable(axis.name, Type::kDouble, {dimension});
  file.attribute(variable, "standard_name", axis.standard_name);
  file.attribute(variable, "long_name", axis.meaning);
  file.attribute(variable, "units", axis.unit);
  file.attribute(variable, "axis", axis.letter);
  if (*axis.letter == 'Z') file.attribute(variable, "positive", "down");
  file.put(variable, values);
}

void define_grid_mapping(NetcdfOutput& file, const bathymetry::LocalFrame& frame) {
  const int variable = file.variable("crs", Type::kInteger, {});
  const bool is_flat = frame.mode() == bathymetry::FrameMode::kFlat;
  file.attribute(variable, "grid_mapping_name", is_flat ? "transverse_mercator" : "orthographic");
  file.attribute(variable, "latitude_of_projection_origin", to_degrees(frame.origin_latitude_rad()));
  file.attribute(variable, is_flat ? "longitude_of_central_meridian" : "longitude_of_projection_origin",
                 to_degrees(frame.origin_longitude_rad()));
  if (is_flat) file.attribute(variable, "scale_factor_at_central_meridian", 1.0);
  file.attribute(variable, "false_easting", 0.0);
  file.attribute(variable, "false_northing", 0.0);
  file.attribute(variable, "semi_major_axis", 6378137.0);         // WGS 84
  file.attribute(variable, "inverse_flattening", 298.257223563);  // WGS 84
  OGRSpatialReference system;
  char* text = nullptr;
  if (system.SetFromUserInput(reference_system(frame).c_str()) == OGRERR_NONE &&
      system.exportToWkt(&text) == OGRERR_NONE)
    file.attribute(variable, "crs_wkt", text);
  CPLFree(text);
  file.put(variable, std::vector<int>{0});
}

// Defines the latitude and longitude of each cell, degrees.
void define_places(NetcdfOutput& file, const CoverageArea& area, const bathymetry::LocalFrame& frame,
                   const std::vector<int>& dimensions) {
  std::vector<double> latitudes, longitudes;
  for (std::size_t row = 0; row < area.side; ++row) {
    for (std::size_t column = 0; column < area.side; ++column) {
      const auto place = frame.to_geodetic({area.north_m(row), area.east_m(column), 0});
      latitudes.push_back(to_degrees(place.latitude_rad));
      longitudes.push_back(to_degrees(place.longitude_rad));
    }
  }
  const auto define = [&](const char* name, const char* meaning, const char* unit,
                          const std::vector<double>& values) {
    const int variable = file.variable(name, Type::kDouble, dimensions);
    file.fill_with_nan(variable);
    file.attribute(variable, "standard_name", meaning);
    file.attribute(variable, "long_name", std::string(meaning) + " on WGS 84");
    file.attribute(variable, "units", unit);
    file.put(variable, values);
  };
  define("lat", "latitude", "degrees_north", latitudes);
  define("lon", "longitude", "degrees_east", longitudes);
}

void write_netcdf(const Coverage& coverage, const CoverageFile& description, const std::string& path) {
  const CoverageArea& area = coverage.area;
  AtomicFile replacement(path);
  NetcdfOutput file(replacement.temporary_path());
  file.attribute("Conventions", "CF-1.8");
  file.attribute("title", description.title);
  file.attribute("source", std::string("halocline ") + bus::kVersion);
  const int depth = file.dimension("depth", area.depths_m.size()), y = file.dimension("y", area.side),
            x = file.dimension("x", area.side);
  std::vector<double> north, east;
  for (std::size_t i = 0; i < area.side; ++i) {
    north.push_back(area.north_m(i));
    east.push_back(area.east_m(i));
  }
  define_axis(file, {"depth", "Z", "depth", "m", "below the sea surface"}, depth, area.depths_m);
  define_axis(file, {"y", "Y", "projection_y_coordinate", "m", "north of the scenario's origin"}, y, north);
  define_axis(file, {"x", "X", "projection_x_coordinate", "m", "east of the scenario's origin"}, x, east);
  define_grid_mapping(file, description.frame);
  define_places(file, area, description.frame, {y, x});
  for (const CoverageQuantity quantity : description.quantities) {
    const QuantityMeaning& meaning = meaning_of(quantity);
    const int variable = file.variable(meaning.name, Type::kDouble, {depth, y, x});
    file.fill_with_nan(variable);
    file.attribute(variable, "long_name", meaning.meaning);
    file.attribute(variable, "units", meaning.unit);
    file.attribute(variable, "grid_mapping", "crs");
    file.attribute(variable, "coordinates", "lat lon");
    for (std::size_t i = 0; i < area.depths_m.size(); ++i)
      file.put_at(variable, i, {area.side, area.side}, coverage.values(quantity, i));
  }
  file.close();
  replacement.commit();
}

}  // namespace
}  // namespace halocline::clients

extern "C" halocline::clients::CoverageWriter halocline_write_coverage_netcdf;

void halocline_write_coverage_netcdf(const halocline::clients::Coverage& coverage,
                                     const halocline::clients::CoverageFile& file, const std::string& path) {
  halocline::clients::write_netcdf(coverage, file, path);
}
