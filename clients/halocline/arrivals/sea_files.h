// SPDX-License-Identifier: BSD-3-Clause
// The sea of a search for eigenrays, from options of the command line and tables (CSV): water, bottom,
// surface, links.
//
// Files, with the column names of the reference arrivals (other columns are ignored):
//   water   depth_m, sound_speed_mps (linear between rows, taken as it is), or temperature and salinity, or a
//           grid: whatever acoustics/sea/profile_reader.h reads; or the name of a built-in profile
//   bottom  range_m, depth_m: the profile along the link, ranges rising from the source
//   links   src_depth_m, rcv_depth_m, rcv_range_m
// Units here are those that users write; they turn into SI at this edge.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "acoustics/rays/arrivals.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/bottom_profile.h"

namespace halocline::clients {

struct SeaDescription {
  std::string water;                      // file or built-in name; empty: the speed below everywhere
  std::optional<double> sound_speed_mps;  // 1000..2000
  std::optional<double> latitude_deg, longitude_deg;  // of the place in a grid of water
  std::string bottom;                                 // file; empty: the depth below everywhere
  std::optional<double> bottom_depth_m;               // 0.1..12 000
  std::string sediment;                               // TR 9407 name; empty: the three numbers below
  double bottom_density_ratio = 1.9;                  // to the water
  double bottom_sound_speed_mps = 1650;               // of the sediment
  double bottom_attenuation_db = 0.8;                 // per wavelength
  std::string surface = "flat";                       // acoustics::SurfaceModel by name
  double wind_mps = 0;                                // 0..60
  std::string absorption = "none";                    // acoustics::AbsorptionModel by name, or none
  double temperature_degc = 10;                       // of the water that absorbs
  double salinity_psu = 35;                           // likewise
  double ph = 8;                                      // likewise
  double frequency_khz = 25;                          // 0.01..1000
  double max_launch_angle_deg = 80;                   // 0..90
  bool keep_steep_direct = true;                      // also the direct path when it is steeper than that
  double crease_angle_deg = 5;             // of the bottom: above it a corner, below a bend; 0..180
  int max_bounces = 400;                   // 0..10 000
  double min_boundary_factor = 0.005;      // of the pressure, product over all bounces, 0..1
  std::optional<double> min_amplitude_db;  // re 1 m, without absorption
  double diffuse_below_db = acoustics::RayOptions{}.diffuse_below_db;  // 0: every path one by one
};

// Throws InvalidArgument, naming the option or the file with its line, when something cannot be.
acoustics::RaySea make_sea(const SeaDescription& description);

// `name` appears in messages. Throws InvalidArgument with every fault, a line each.
std::vector<acoustics::ProfiledDepth> read_bottom_profile(std::istream& in, const std::string& name);
std::vector<acoustics::RayLink> read_links(std::istream& in, const std::string& name);

// None for "auto" and an empty name. Throws InvalidArgument for a name that is no solver's.
std::optional<acoustics::RaySolver> solver_of(const std::string& name);

}  // namespace halocline::clients
