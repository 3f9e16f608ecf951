// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/arrivals/sea_files.h"

#include <array>
#include <fstream>
#include <istream>
#include <string_view>
#include <utility>

#include "acoustics/sea/absorption.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/pressure.h"
#include "acoustics/sea/profile_reader.h"
#include "acoustics/sea/ray_water.h"
#include "acoustics/sea/sound_speed.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/check.h"
#include "core/csv_table.h"
#include "core/elementary.h"
#include "core/files/input_file.h"

namespace halocline::clients {
namespace {

using acoustics::AbsorbingWater;
using acoustics::RayWater;
using acoustics::SoundSpeedProfile;

// Latitude for pressure, and for the water of tables that hold speed only; such speeds do not depend on it.
const double kLatitude = to_radians(45);

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

// Reads rows of the named columns, in their order; reports all errors of the table at once.
template <std::size_t kCount>
std::vector<std::array<double, kCount>> read_columns(std::istream& in, const std::string& name,
                                                     const std::array<const char*, kCount>& columns) {
  std::vector<std::string> errors;
  const CsvTable table = read_csv(in, errors);
  std::array<std::size_t, kCount> index{};
  for (std::size_t c = 0; c < kCount; ++c) {
    const auto found = table.column(columns[c]);
    if (found)
      index[c] = *found;
    else
      errors.push_back("column " + std::string(columns[c]) + " is missing");
  }
  require(errors.empty(), name + ": " + joined(errors));
  std::vector<std::array<double, kCount>> rows;
  for (const CsvLine& line : table.rows) {
    std::array<double, kCount> row{};
    for (std::size_t c = 0; c < kCount; ++c) {
      const auto number = parse_number(line.cells[index[c]]);
      if (number)
        row[c] = *number;
      else
        errors.push_back("line " + std::to_string(line.number) + ": " + columns[c] + " is no number");
    }
    rows.push_back(row);
  }
  require(errors.empty(), name + ": " + joined(errors));
  return rows;
}

SoundSpeedProfile profile_of(const SeaDescription& sea) {
  const acoustics::WaterSample assumed{sea.temperature_degc, sea.salinity_psu};
  require(sea.water.empty() != !sea.sound_speed_mps.has_value(),
          "give the water: either a file or name, or one sound speed");
  if (sea.sound_speed_mps) return SoundSpeedProfile::isovelocity(*sea.sound_speed_mps, assumed);
  if (auto built_in = acoustics::built_in_profile(sea.water, std::nullopt, assumed))
    return *std::move(built_in);
  const bool has_place = sea.latitude_deg && sea.longitude_deg;
  require(has_place || acoustics::is_profile_table(sea.water),
          sea.water + " is a grid of water: give the place in it by --latitude and --longitude");
  const double latitude = sea.latitude_deg
                              ? to_radians(require_in_range(*sea.latitude_deg, -90, 90, "latitude", "deg"))
                              : kLatitude;
  return acoustics::read_profile(sea.water, {acoustics::SoundSpeedModel::kMackenzie1981, latitude, assumed},
                                 latitude, to_radians(sea.longitude_deg.value_or(0)));
}

acoustics::AbsorptionAtDepth absorption_of(const SeaDescription& sea) {
  if (sea.absorption == "none") return [](double) { return 0.0; };
  const auto model = acoustics::absorption_model_from_name(sea.absorption);
  std::string allowed = "none";
  for (const auto known : acoustics::kAbsorptionModels) allowed += ", " + std::string(to_name(known));
  require(model.has_value(), "'" + sea.absorption + "' is no absorption model; allowed: " + allowed);
  return [sea, model](double depth_m) {
    const AbsorbingWater water{sea.temperature_degc, sea.salinity_psu, depth_m,
                               acoustics::pressure_atm_absolute(depth_m, kLatitude), sea.ph};
    return acoustics::absorption_db_per_km(*model, water, sea.frequency_khz * 1e3);
  };
}

acoustics::FluidBottom bottom_of(const SeaDescription& sea) {
  if (sea.sediment.empty()) {
    return acoustics::fluid_bottom(sea.bottom_density_ratio, sea.bottom_sound_speed_mps,
                                   sea.bottom_attenuation_db);
  }
  const auto named = acoustics::sediment(sea.sediment);
  std::string allowed;
  for (const std::string_view name : acoustics::sediment_names())
    allowed += (allowed.empty() ? "" : ", ") + std::string(name);
  require(named.has_value(), "'" + sea.sediment + "' is no sediment; allowed: " + allowed);
  return *named;
}

acoustics::BottomProfile profile_of_bottom(const SeaDescription& sea) {
  require(sea.bottom.empty() != !sea.bottom_depth_m.has_value(),
          "give the bottom: either a file or one depth");
  if (sea.bottom_depth_m) return acoustics::BottomProfile::flat(*sea.bottom_depth_m);
  std::ifstream file = open_input(sea.bottom);
  return acoustics::BottomProfile(read_bottom_profile(file, sea.bottom), to_radians(sea.crease_angle_deg));
}

acoustics::RaySurface surface_of(const SeaDescription& sea) {
  const auto model = acoustics::surface_model_from_name(sea.surface);
  require(model.has_value(),
          "'" + sea.surface + "' is no surface model; allowed: flat, apl-bubbles, eckart, coates, jones");
  require(sea.wind_mps >= 0 && sea.wind_mps <= 60, "the wind must lie in 0..60 m/s");
  return {*model, sea.wind_mps};
}

acoustics::RayOptions options_of(const SeaDescription& sea) {
  acoustics::RayOptions options;
  options.frequency_hz = sea.frequency_khz * 1e3;
  options.max_launch_angle_rad = to_radians(sea.max_launch_angle_deg);
  options.keep_steep_direct = sea.keep_steep_direct;
  options.max_bounces = sea.max_bounces;
  options.diffuse_below_db = sea.diffuse_below_db;
  options.min_boundary_factor = sea.min_boundary_factor;
  if (sea.min_amplitude_db) options.min_amplitude = elementary::exp10(*sea.min_amplitude_db / 20);
  validate(options);
  return options;
}

}  // namespace

std::vector<acoustics::ProfiledDepth> read_bottom_profile(std::istream& in, const std::string& name) {
  std::vector<acoustics::ProfiledDepth> points;
  for (const auto& [range_m, depth_m] : read_columns<2>(in, name, {"range_m", "depth_m"}))
    points.push_back({range_m, depth_m});
  return points;
}

std::vector<acoustics::RayLink> read_links(std::istream& in, const std::string& name) {
  std::vector<acoustics::RayLink> links;
  for (const auto& [source_m, receiver_m, range_m] :
       read_columns<3>(in, name, {"src_depth_m", "rcv_depth_m", "rcv_range_m"})) {
    links.push_back({source_m, receiver_m, range_m});
  }
  return links;
}

acoustics::RaySea make_sea(const SeaDescription& sea) {
  const acoustics::RayOptions options = options_of(sea);
  return {RayWater::from_profile(profile_of(sea), absorption_of(sea)), profile_of_bottom(sea), bottom_of(sea),
          surface_of(sea), options};
}

std::optional<acoustics::RaySolver> solver_of(const std::string& name) {
  if (name.empty() || name == "auto") return std::nullopt;
  for (const auto solver :
       {acoustics::RaySolver::kImages, acoustics::RaySolver::kSnell, acoustics::RaySolver::kArcs}) {
    if (name == to_name(solver)) return solver;
  }
  throw InvalidArgument("'" + name + "' is no solver; allowed: auto, images, snell, arcs");
}

}  // namespace halocline::clients
