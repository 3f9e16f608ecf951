// SPDX-License-Identifier: BSD-3-Clause
// Conversion of potential temperature, which ocean models use, to in-situ temperature.
//
// Model. The adiabatic lapse rate of Bryden 1973 is integrated in one step of the fourth-order scheme of
// Fofonoff, both in the form of Fofonoff and Millard 1983 (UNESCO Technical Paper 44). Ranges: salinity 0..42
// psu, temperature -2..40 degC, pressure 0..10 000 dbar. Their check value: water of 40 psu and 40 degC moved
// from 10 000 dbar to the surface has 36.89073 degC. Pressure at depth z and latitude phi, dbar (Lovett
// 1978):
//
//   p = 1.0052405 (1 + 5.28e-3 sin^2(phi)) z + 2.36e-6 z^2
//
// Error below 0.01 K.
#pragma once

namespace halocline::ocean {

// Returns the temperature, degC, of water that is moved adiabatically from one pressure to another, dbar.
double adiabatic_temperature_degc(double salinity_psu, double temperature_degc, double from_dbar,
                                  double to_dbar);

double pressure_dbar(double depth_m, double latitude_rad);

// Returns the depth, m, at which the gauge pressure is `pressure_dbar` (0..10 000), at `latitude_rad`: UNESCO
// Technical Paper 44, algorithm 3 (Saunders and Fofonoff 1976), standard ocean. Error 0.1 m.
double unesco_depth_m(double pressure_dbar, double latitude_rad);

// Returns the temperature at `depth_m` >= 0, degC, of water whose potential temperature referred to the
// surface is `potential_degc`.
double in_situ_temperature_degc(double salinity_psu, double potential_degc, double depth_m,
                                double latitude_rad);

}  // namespace halocline::ocean
