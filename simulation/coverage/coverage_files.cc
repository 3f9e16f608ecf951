// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/coverage/coverage_files.h"

#include <fmt/format.h>

#include "core/check.h"
#include "core/shared_module.h"
#include "core/units.h"

namespace halocline::clients {
namespace {

// Returns the module's function that writes this format; empty for a picture.
std::string writer_of(const std::string& path) {
  if (path.ends_with(".tif")) return "halocline_write_coverage_geotiff";
  if (path.ends_with(".nc")) return "halocline_write_coverage_netcdf";
  return path.ends_with(".geojson") ? "halocline_write_coverage_geojson" : "";
}

}  // namespace

void require_coverage_file(const std::string& path) {
  require(!writer_of(path).empty() || path.ends_with(".png"),
          "'" + path +
              "' is no file for a map of coverage; allowed are names that end in .tif, .nc, "
              ".geojson or .png");
}

std::string reference_system(const bathymetry::LocalFrame& frame) {
  const bool is_flat = frame.mode() == bathymetry::FrameMode::kFlat;
  return fmt::format("+proj={} +lat_0={} +lon_0={} {}+x_0=0 +y_0=0 +datum=WGS84 +units=m +no_defs",
                     is_flat ? "tmerc" : "ortho", to_degrees(frame.origin_latitude_rad()),
                     to_degrees(frame.origin_longitude_rad()), is_flat ? "+k=1 " : "");
}

void write_coverage(const Coverage& coverage, const CoverageFile& file, const std::string& path) {
  require_coverage_file(path);
  const std::string writer = writer_of(path);
  if (writer.empty()) return write_coverage_picture(coverage, file, path);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): a symbol's type is known by its name
  const auto write = reinterpret_cast<CoverageWriter*>(module_symbol("halocline_coverage_files.so", writer));
  write(coverage, file, path);
}

}  // namespace halocline::clients
