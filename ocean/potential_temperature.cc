// SPDX-License-Identifier: BSD-3-Clause
#include "ocean/potential_temperature.h"

#include "core/elementary.h"

namespace halocline::ocean {
namespace {

// K/dbar, Bryden 1973.
double lapse_rate(double s, double t, double p) {
  const double ds = s - 35;
  return (((-2.1687e-16 * t + 1.8676e-14) * t - 4.6206e-13) * p +
          ((2.7759e-12 * t - 1.1351e-10) * ds + ((-5.4481e-14 * t + 8.733e-12) * t - 6.7795e-10) * t +
           1.8741e-8)) *
             p +
         (-4.2393e-8 * t + 1.8932e-6) * ds + ((6.6228e-10 * t - 6.836e-8) * t + 8.5258e-6) * t + 3.5803e-5;
}

}  // namespace

// Runge-Kutta of fourth order in Gill's form, one step (Fofonoff 1977).
double adiabatic_temperature_degc(double salinity_psu, double temperature_degc, double from_dbar,
                                  double to_dbar) {
  const double h = to_dbar - from_dbar, middle = from_dbar + h / 2;
  double t = temperature_degc, k = h * lapse_rate(salinity_psu, t, from_dbar), q = k;
  t += k / 2;
  k = h * lapse_rate(salinity_psu, t, middle);
  t += 0.29289322 * (k - q);
  q = 0.58578644 * k + 0.121320344 * q;
  k = h * lapse_rate(salinity_psu, t, middle);
  t += 1.707106781 * (k - q);
  q = 3.414213562 * k - 4.121320344 * q;
  k = h * lapse_rate(salinity_psu, t, to_dbar);
  return t + (k - 2 * q) / 6;
}

double pressure_dbar(double depth_m, double latitude_rad) {
  const double sine = elementary::sin(latitude_rad);
  return 1.0052405 * (1 + 5.28e-3 * sine * sine) * depth_m + 2.36e-6 * depth_m * depth_m;
}

// Specific volume integrated over pressure, over gravity.
double unesco_depth_m(double pressure_dbar, double latitude_rad) {
  const double p = pressure_dbar, sine = elementary::sin(latitude_rad), x = sine * sine;
  // Gravity at the surface plus half of its growth down to p.
  const double gravity = 9.780318 * (1 + (5.2788e-3 + 2.36e-5 * x) * x) + 1.092e-6 * p;
  return (((-1.82e-15 * p + 2.279e-10) * p - 2.2512e-5) * p + 9.72659) * p / gravity;
}

double in_situ_temperature_degc(double salinity_psu, double potential_degc, double depth_m,
                                double latitude_rad) {
  return adiabatic_temperature_degc(salinity_psu, potential_degc, 0, pressure_dbar(depth_m, latitude_rad));
}

}  // namespace halocline::ocean
