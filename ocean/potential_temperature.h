// SPDX-License-Identifier: BSD-3-Clause
// Temperature in situ of water whose potential temperature is known, as ocean models hold it.
//
// Model: adiabatic lapse rate of Bryden 1973, integrated by Fofonoff's fourth-order scheme of one step, both
// in the form of Fofonoff and Millard 1983 (UNESCO Technical Paper 44). Salinity 0..42 psu, temperature
// -2..40 degC, pressure 0..10 000 dbar (their check: 40 psu, 40 degC, 10 000 dbar to the surface: 36.89073
// degC). Pressure at a depth after Lovett 1978, p = 1.0052405 (1 + 5.28e-3 sin^2(latitude)) z + 2.36e-6 z^2
// dbar. Error below 0.01 K.
#pragma once

namespace halocline::ocean {

// Of water moved without heat from one pressure to another, dbar; degC.
double adiabatic_temperature_degc(double salinity_psu, double temperature_degc, double from_dbar,
                                  double to_dbar);

double pressure_dbar(double depth_m, double latitude_rad);

// Depth, m, where the gauge pressure is `pressure_dbar` (0..10 000) at `latitude_rad`: UNESCO Technical Paper
// 44, algorithm 3 (Saunders and Fofonoff 1976), standard ocean; 0.1 m.
double unesco_depth_m(double pressure_dbar, double latitude_rad);

// At `depth_m` >= 0, of water that has the potential temperature `potential_degc` re the surface.
double in_situ_temperature_degc(double salinity_psu, double potential_degc, double depth_m,
                                double latitude_rad);

}  // namespace halocline::ocean
