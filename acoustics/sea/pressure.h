// SPDX-License-Identifier: BSD-3-Clause
// Conversion of depth to pressure and back.
//
// Models:
// - Depth to pressure: Leroy and Parthiot 1998, "Depth-pressure relationships in the oceans and seas" (JASA
//   103, 1346), for the standard ocean (0 degC, 35 psu), and the correction for the common oceans (60 N to 40
//   S, open). The error of the fit is below 0.1 dbar for the standard ocean, 0.2 dbar with the correction.
//   Depth 0 to 12 000 m.
// - Pressure to depth: UNESCO 1983 (Technical Paper 44, Fofonoff and Millard), Saunders and Fofonoff's
//   formula with the international gravity formula of 1980, standard ocean; 0.1 m over 0 to 10 000 dbar.
// The two are fits by different authors: a round trip is off by up to 1.5 m at 10 km. Pressures are gauge
// pressures (0 at the surface), in dbar; pressure_atm_absolute() is 1 at the surface. Left out: the other
// regional corrections (Mediterranean, Baltic, ...), geopotential anomaly.
#pragma once

#include "ocean/potential_temperature.h"

namespace halocline::acoustics {

inline constexpr double kDecibarPerAtmosphere = 10.1325;  // 101 325 Pa (BIPM)
inline constexpr double kPascalPerDecibar = 1e4;

// Gauge pressure, dbar, at `depth_m` (0..12 000) in the standard ocean at `latitude_rad` (-pi/2..pi/2).
double standard_ocean_pressure_dbar(double depth_m, double latitude_rad);

// Gauge pressure, dbar, with the correction for the common oceans.
double common_oceans_pressure_dbar(double depth_m, double latitude_rad);

using ocean::unesco_depth_m;

// Absolute pressure, atm, in the absorption of Fisher and Simmons: 1 + (gauge pressure of the standard ocean)
// / 10.1325 dbar. At 100 m and 45 degrees it is 10.952 atm, the value of the reference figures 6 and 7.
double pressure_atm_absolute(double depth_m, double latitude_rad);

}  // namespace halocline::acoustics
