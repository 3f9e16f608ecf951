// SPDX-License-Identifier: BSD-3-Clause
// Sea of an eigenray search, from command-line options and CSV tables: water, bottom, surface, links.
//
// Files, with the column names of the reference arrivals (other columns are ignored):
//
//   water   depth_m, sound_speed_mps (linear between rows, used without conversion), or temperature and
//           salinity, or a grid: any file that acoustics/sea/profile_reader.h reads; or the name of a
//           built-in profile
//   bottom  range_m, depth_m: the profile along the link, ranges ascending from the source
//   links   src_depth_m, rcv_depth_m, rcv_range_m
//
// Values are in the units that users write; they are converted to SI here.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/bottom_profile.h"

namespace halocline::clients {

// Options that describe the sea and the search, in the units of the command line.
struct SeaDescription {
  std::string water;                                  // file or built-in name; empty: uniform speed
  std::optional<double> sound_speed_mps;              // 1000..2000
  std::optional<double> latitude_deg, longitude_deg;  // position within a grid of water
  std::string bottom;                                 // file; empty: uniform depth
  std::optional<double> bottom_depth_m;               // 0.1..12 000
  std::string sediment;                               // TR 9407 name; empty: the three values below
  double bottom_density_ratio = 1.9;                  // relative to the water
  double bottom_sound_speed_mps = 1650;               // sound speed of the sediment
  double bottom_attenuation_db = 0.8;                 // per wavelength
  std::string surface = "flat";                       // name of an acoustics::SurfaceModel
  double wind_mps = 0;                                // 0..60 m/s
  std::string absorption = "none";                    // name of an acoustics::AbsorptionModel, or none
  double temperature_degc = 10;                       // for absorption
  double salinity_psu = 35;                           // for absorption
  double ph = 8;                                      // for absorption
  double frequency_khz = 25;                          // 0.01..1000
  double max_launch_angle_deg = 80;                   // 0..90
  bool keep_steep_direct = true;                      // keep the direct path even if it is steeper
  double crease_angle_deg = 5;         // bottom angle above which a post is a corner, below it a bend; 0..180
  int max_bounces = 400;               // 0..10 000
  double min_boundary_factor = 0.005;  // product over all bounces, of pressure, 0..1
  std::optional<double> min_amplitude_db;                              // re 1 m, without absorption
  double diffuse_below_db = acoustics::RayOptions{}.diffuse_below_db;  // 0: every path is output by itself
};

// Returns the sea. Throws InvalidArgument that names the option, or the file with its line, for a wrong
// value.
acoustics::RaySea make_sea(const SeaDescription& description);

// Read a bottom profile and a list of links. `name` appears in messages. Throw InvalidArgument with every
// error, one per line.
std::vector<acoustics::ProfiledDepth> read_bottom_profile(std::istream& in, const std::string& name);
std::vector<acoustics::RayLink> read_links(std::istream& in, const std::string& name);

// Returns the solver of that name; empty for "auto" and an empty name. Throws InvalidArgument for an unknown
// name.
std::optional<acoustics::RaySolver> solver_of(const std::string& name);

}  // namespace halocline::clients
