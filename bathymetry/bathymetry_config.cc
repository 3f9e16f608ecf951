// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/bathymetry_config.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bathymetry/rasters/raster_options.h"
#include "bathymetry/terrain/fractal_relief.h"
#include "bus/config/carried_files.h"
#include "core/files/file_path.h"

namespace halocline::bathymetry {
namespace {

using bus::ConfigVisitor;

const std::vector<std::string> kKinds{"flat", "slope", "ridge", "seamount", "raster"};

void visit_domain(ConfigVisitor& v, DomainRecipe& d) {
  v.number("center_north_m", d.center_north_m, {-1e6, 1e6, "m", "centre of the grid, north of the origin"});
  v.number("center_east_m", d.center_east_m, {-1e6, 1e6, "m", "centre of the grid, east of the origin"});
  v.number("size_north_m", d.size_north_m, {0.1, 1e6, "m", "north-south extent, a multiple of the spacing"});
  v.number("size_east_m", d.size_east_m, {0.1, 1e6, "m", "east-west extent, a multiple of the spacing"});
  v.number("spacing_m", d.spacing_m, {0.01, 1e5, "m", "distance between grid points"});
}

void check_domain(ConfigVisitor& v, const DomainRecipe& d) {
  if (d.is_possible()) return;
  v.problem("spacing_m", "allowed is a spacing that divides size_north_m and size_east_m, 1 to 32768 times");
}

void visit_bounds(ConfigVisitor& v, RasterOptions& r) {
  RasterBounds bounds = r.bounds.value_or(RasterBounds{});
  const bool given = v.given("bounds") && (r.bounds || v.given("row_order"));
  std::vector<double> numbers;
  if (r.bounds) numbers = {bounds.west, bounds.south, bounds.east, bounds.north};
  v.numbers(
      "bounds", numbers,
      {-1e8, 1e8, "", "west, south, east, north of the pixel edges of a raster without a geotransform"});
  v.when(!numbers.empty(), "bounds", [&] {
    bus::choice(v, "row_order", bounds.row_order, {"north_first", "south_first"}, "row order, with bounds");
  });
  if (numbers.empty()) return;
  if (numbers.size() != 4 || !(numbers[0] < numbers[2] && numbers[1] < numbers[3])) {
    return v.problem("bounds",
                     "allowed are four numbers: west, south, east, north; west < east, south < north");
  }
  if (!given) v.problem("row_order", "bounds need it: allowed are north_first, south_first");
  r.bounds = RasterBounds{numbers[0], numbers[1], numbers[2], numbers[3], bounds.row_order};
}

void visit_raster(ConfigVisitor& v, RasterOptions& r) {
  v.file("path", r.path, bus::FileNames::kRasters, "file of the raster, relative to the scenario's folder");
  v.text("variable", r.variable, {}, "variable of a netCDF file that holds several; empty: the only one");
  bus::integer_as(v, "band", r.band, {1, 1000, "", "band of the raster"});
  v.boolean("positive_down", r.positive_down, "true: the file holds depths without stating so");
  std::vector<double> no_data;
  if (r.no_data) no_data = {*r.no_data};
  v.numbers("no_data", no_data, {-3.5e38, 3.5e38, "", "one more value that means no data; empty: none"});
  if (no_data.size() > 1) v.problem("no_data", "allowed is an array of no or one number");
  if (no_data.size() == 1) r.no_data = no_data.front();
  v.advanced([&] {
    v.boolean("trust_every_value", r.trust_every_value, "true: no value is suspected to be no data");
    bus::choice(v, "registration", r.registration, {"as_declared", "node"},
                "place of the outermost points; node: on the file's bounds, not half a pixel inside");
  });
  visit_bounds(v, r);
  v.text("coordinate_system", r.coordinate_system, {},
         "coordinate system of a file that names none: EPSG:..., or local for metres");
  v.text("vertical_datum", r.vertical_datum, {}, "vertical datum of a file that names none");
  v.number("datum_offset_m", r.datum_offset_m, {-200, 200, "m", "offset added to every depth"});
}

// Requires a readable file, unless GDAL's own names are allowed, which need not be files.
void require_raster(ConfigVisitor& v, const FilePath& path) {
  if (!is_any_raster_allowed()) bus::require_readable(v, "path", path);
}

// Visits the keys that belong to one kind of terrain.
void with_kind(ConfigVisitor& v, const TerrainRecipe& t, TerrainKind kind,
               const std::function<void()>& body) {
  bus::when_one_of(v, "kind", t.kind, kKinds, {kind}, body);
}

void visit_shapes(ConfigVisitor& v, TerrainRecipe& t) {
  constexpr double kDeep = 12'000;
  const auto shape = [&](std::string_view key, std::string_view meaning, TerrainKind kind, auto&& body) {
    with_kind(v, t, kind, [&] { v.section(key, meaning, body); });
  };
  shape("flat", "Flat seabed (kind = flat)", TerrainKind::kFlat, [&](ConfigVisitor& s) {
    s.number("depth_m", t.flat.depth_m, {-kDeep, kDeep, "m", "z of the bottom"});
  });
  shape("slope", "Plane slope (kind = slope)", TerrainKind::kSlope, [&](ConfigVisitor& s) {
    s.number("depth_m", t.slope.depth_m, {-kDeep, kDeep, "m", "z of the bottom at the origin"});
    s.number("slope", t.slope.slope, {-10, 10, "", "gradient: metres down a metre along the azimuth"});
    bus::degrees(s, "azimuth_deg", t.slope.azimuth_rad,
                 {-360, 360, "deg", "direction in which it falls, clockwise from north"});
  });
  shape("ridge", "Ridge, Gaussian across and endless along (kind = ridge)", TerrainKind::kRidge,
        [&](ConfigVisitor& s) {
          s.number("depth_m", t.ridge.depth_m, {-kDeep, kDeep, "m", "z of the bottom far from it"});
          s.number("height_m", t.ridge.height_m,
                   {-kDeep, kDeep, "m", "height of the crest above depth_m; negative: a trench"});
          s.number("half_width_m", t.ridge.half_width_m, {0.001, 1e6, "m", "standard deviation across"});
          s.number("crest_north_m", t.ridge.crest_x_m, {-1e6, 1e6, "m", "point of the crest, north"});
          s.number("crest_east_m", t.ridge.crest_y_m, {-1e6, 1e6, "m", "point of the crest, east"});
          bus::degrees(s, "azimuth_deg", t.ridge.azimuth_rad,
                       {-360, 360, "deg", "direction of the crest, clockwise from north"});
        });
  shape("seamount", "Seamount, a round Gaussian (kind = seamount)", TerrainKind::kSeamount,
        [&](ConfigVisitor& s) {
          s.number("depth_m", t.seamount.depth_m, {-kDeep, kDeep, "m", "z of the bottom far from it"});
          s.number("height_m", t.seamount.height_m,
                   {-kDeep, kDeep, "m", "height of the summit above depth_m; negative: a basin"});
          s.number("radius_m", t.seamount.radius_m, {0.001, 1e6, "m", "standard deviation of the Gaussian"});
          s.number("summit_north_m", t.seamount.summit_x_m, {-1e6, 1e6, "m", "place of the summit, north"});
          s.number("summit_east_m", t.seamount.summit_y_m, {-1e6, 1e6, "m", "place of the summit, east"});
        });
}

void visit_relief(ConfigVisitor& v, FractalRelief& r) {
  v.number("rms_m", r.rms_m, {0, 5000, "m", "standard deviation; 0: no relief"});
  v.when(r.rms_m > 0, "rms_m above 0", [&] {
    v.number("longest_wavelength_m", r.longest_wavelength_m, {0.01, 1e6, "m", "largest wavelength"});
    v.number("shortest_wavelength_m", r.shortest_wavelength_m,
             {0.01, 1e6, "m", "smallest wavelength; cut below two grid points"});
    v.number("hurst", r.hurst,
             {0, 1, "", "Hurst exponent; smaller is rougher at small scale; the sea floor has about 0.9"});
    bus::integer_as(v, "seed", r.seed, {0, 9e15, "", "seed of the relief"});
  });
  if (r.shortest_wavelength_m > r.longest_wavelength_m) {
    v.problem("shortest_wavelength_m", "allowed is at most longest_wavelength_m");
  }
}

void visit_nested(ConfigVisitor& v, NestedRecipe& n) {
  visit_domain(v, n.domain);
  check_domain(v, n.domain);
  v.number("blend_width_m", n.blend_width_m,
           {0, 1e5, "m", "width inside its border over which it is blended into the grid around it"});
  bus::choice(v, "holes", n.holes, {"keep", "fill_from_around"}, "points without data in the finer raster");
  v.section("raster", "Finer raster file", [&](ConfigVisitor& s) {
    visit_raster(s, n.raster);
    require_raster(s, n.raster.path);
  });
}

}  // namespace

void visit(ConfigVisitor& v, TerrainRecipe& t) {
  v.section("terrain", "Seabed", [&](ConfigVisitor& s) {
    bus::choice(s, "kind", t.kind, kKinds, "source of the seabed");
    const bool has_nested = s.writing() ? !t.nested.empty() : s.given("nested");
    s.when(t.kind == TerrainKind::kRaster || has_nested, "kind = \"raster\", or a nested raster", [&] {
      bus::choice(s, "frame", t.frame, {"flat", "enu"},
                  "vertical axis of a raster: flat (z is depth) or enu (the Earth's curvature in z)");
    });
    if (!s.writing()) {
      with_kind(s, t, TerrainKind::kRaster, [&] { s.boolean("whole_file", t.whole_file, ""); });
    }
    const bool is_whole_file = t.kind == TerrainKind::kRaster && t.whole_file;
    s.when(!is_whole_file, "whole_file = false", [&] { visit_domain(s, t.domain); });
    visit_shapes(s, t);
    with_kind(s, t, TerrainKind::kRaster, [&] {
      s.section("raster",
                "Raster file of elevations or depths: GeoTIFF, netCDF, ESRI ASCII and others (kind = raster)",
                [&](ConfigVisitor& r) {
                  visit_raster(r, t.raster);
                  if (t.kind == TerrainKind::kRaster) require_raster(r, t.raster.path);
                });
      s.boolean("whole_file", t.whole_file,
                "true: the points of a raster in local metres as they are; the grid above is not used");
    });
    s.section("relief", "Synthetic relief on top, fractal and seeded",
              [&](ConfigVisitor& r) { visit_relief(r, t.relief); });
    s.list(
        "nested", "A finer raster inside", t.nested.size(), [&](std::size_t n) { t.nested.resize(n); },
        [&](ConfigVisitor& item, std::size_t n) { visit_nested(item, t.nested[n]); });
    const bool uses_grid = !t.is_level() && !is_whole_file;
    if (uses_grid) check_domain(s, t.domain);
  });
}

}  // namespace halocline::bathymetry
