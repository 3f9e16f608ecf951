// SPDX-License-Identifier: BSD-3-Clause
#include "ocean/potential_temperature.h"

#include "core/elementary.h"

namespace halocline::ocean {
namespace {

// Returns the adiabatic lapse rate, K/dbar, at salinity s, temperature t, degC, and pressure p, dbar (Bryden
// 1973): polynomials A to E of t in
//
//   A(t) + B(t) (s - 35) + [C(t) + D(t) (s - 35)] p + E(t) p^2
double lapse_rate(double s, double t, double p) {
  const double ds = s - 35;
  return (((-2.1687e-16 * t + 1.8676e-14) * t - 4.6206e-13) * p +
          ((2.7759e-12 * t - 1.1351e-10) * ds + ((-5.4481e-14 * t + 8.733e-12) * t - 6.7795e-10) * t +
           1.8741e-8)) *
             p +
         (-4.2393e-8 * t + 1.8932e-6) * ds + ((6.6228e-10 * t - 6.836e-8) * t + 8.5258e-6) * t + 3.5803e-5;
}

}  // namespace

// One Runge-Kutta step of fourth order in Gill's form (Fofonoff 1977) from p0 to p1. With the lapse rate
// L(t, p), h = p1 - p0 and r = 1 / sqrt(2),
//
//   k1 = h L(t0, p0)           t1 = t0 + k1 / 2               q1 = k1
//   k2 = h L(t1, p0 + h / 2)   t2 = t1 + (1 - r) (k2 - q1)    q2 = (2 - 2 r) k2 + (3 r - 2) q1
//   k3 = h L(t2, p0 + h / 2)   t3 = t2 + (1 + r) (k3 - q2)    q3 = (2 + 2 r) k3 - (2 + 3 r) q2
//   k4 = h L(t3, p1)           t4 = t3 + (k4 - 2 q3) / 6
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

// Lovett 1978, with latitude phi and depth z:
//
//   p = 1.0052405 (1 + 5.28e-3 sin^2(phi)) z + 2.36e-6 z^2
double pressure_dbar(double depth_m, double latitude_rad) {
  const double sine = elementary::sin(latitude_rad);
  return 1.0052405 * (1 + 5.28e-3 * sine * sine) * depth_m + 2.36e-6 * depth_m * depth_m;
}

// The depth is the specific volume integrated over pressure, divided by gravity (UNESCO Technical Paper 44,
// algorithm 3):
//
//   z = (9.72659 p - 2.2512e-5 p^2 + 2.279e-10 p^3 - 1.82e-15 p^4) / g
//   g = 9.780318 (1 + 5.2788e-3 x + 2.36e-5 x^2) + 1.092e-6 p,  x = sin^2(phi)
double unesco_depth_m(double pressure_dbar, double latitude_rad) {
  const double p = pressure_dbar, sine = elementary::sin(latitude_rad), x = sine * sine;
  // Gravity at the surface plus half of its increase down to p, m/s^2.
  const double gravity = 9.780318 * (1 + (5.2788e-3 + 2.36e-5 * x) * x) + 1.092e-6 * p;
  return (((-1.82e-15 * p + 2.279e-10) * p - 2.2512e-5) * p + 9.72659) * p / gravity;
}

double in_situ_temperature_degc(double salinity_psu, double potential_degc, double depth_m,
                                double latitude_rad) {
  return adiabatic_temperature_degc(salinity_psu, potential_degc, 0, pressure_dbar(depth_m, latitude_rad));
}

}  // namespace halocline::ocean
