// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/sound_speed.h"

#include <cmath>

#include "acoustics/sea/pressure.h"

namespace halocline::acoustics {
namespace {

constexpr double kT68PerT90 = 1.00024;           // Saunders 1990
constexpr double kPascalPerKgPerCm2 = 98'066.5;  // standard gravity on one kilogram, Pa
constexpr double kDecibarPerBar = 10;

struct NamedModel {
  SoundSpeedModel model;
  std::string_view name;
};
constexpr NamedModel kNames[] = {
    {SoundSpeedModel::kMackenzie1981, "mackenzie"},
    {SoundSpeedModel::kUnescoChenMillero, "unesco"},
    {SoundSpeedModel::kChenMilleroWongZhu1995, "chen-millero"},
    {SoundSpeedModel::kDelGrossoWongZhu1995, "del-grosso"},
    {SoundSpeedModel::kTeos10, "teos10"},
    {SoundSpeedModel::kHarrisZorzi2007, "harris-zorzi"},
};

// Chen and Millero 1977, rows for powers of P in bar, columns for powers of T. Both fits share this form and
// differ in the coefficients.
//   c = Cw(T,P) + A(T,P) S + B(T,P) S^(3/2) + D(P) S^2
struct ChenMilleroCoefficients {
  double c[4][6];
  double a[4][5];
  double b[2][2];
  double d[2];
};

constexpr ChenMilleroCoefficients kUnesco1983 = {
    {{1402.388, 5.03711, -5.80852e-2, 3.3420e-4, -1.47800e-6, 3.1464e-9},
     {0.153563, 6.8982e-4, -8.1788e-6, 1.3621e-7, -6.1185e-10, 0},
     {3.1260e-5, -1.7107e-6, 2.5974e-8, -2.5335e-10, 1.0405e-12, 0},
     {-9.7729e-9, 3.8504e-10, -2.3643e-12, 0, 0, 0}},
    {{1.389, -1.262e-2, 7.164e-5, 2.006e-6, -3.21e-8},
     {9.4742e-5, -1.2580e-5, -6.4885e-8, 1.0507e-8, -2.0122e-10},
     {-3.9064e-7, 9.1041e-9, -1.6002e-10, 7.988e-12, 0},
     {1.100e-10, 6.649e-12, -3.389e-13, 0, 0}},
    {{-1.922e-2, -4.42e-5}, {7.3637e-5, 1.7945e-7}},
    {1.727e-3, -7.9836e-6}};

constexpr ChenMilleroCoefficients kWongZhu1995 = {
    {{1402.388, 5.03830, -5.81090e-2, 3.3432e-4, -1.47797e-6, 3.1419e-9},
     {0.153563, 6.8999e-4, -8.1829e-6, 1.3632e-7, -6.1260e-10, 0},
     {3.1260e-5, -1.7111e-6, 2.5986e-8, -2.5353e-10, 1.0415e-12, 0},
     {-9.7729e-9, 3.8513e-10, -2.3654e-12, 0, 0, 0}},
    {{1.389, -1.262e-2, 7.166e-5, 2.008e-6, -3.21e-8},
     {9.4742e-5, -1.2583e-5, -6.4928e-8, 1.0515e-8, -2.0142e-10},
     {-3.9064e-7, 9.1061e-9, -1.6009e-10, 7.994e-12, 0},
     {1.100e-10, 6.651e-12, -3.391e-13, 0, 0}},
    {{-1.922e-2, -4.42e-5}, {7.3637e-5, 1.7950e-7}},
    {1.727e-3, -7.9836e-6}};

template <std::size_t N>
double polynomial(const double (&coefficients)[N], double x) {
  double sum = 0;
  for (std::size_t i = N; i-- > 0;) sum = sum * x + coefficients[i];
  return sum;
}

template <std::size_t M, std::size_t N>
double polynomial(const double (&rows)[M][N], double t, double p) {
  double sum = 0;
  for (std::size_t i = M; i-- > 0;) sum = sum * p + polynomial(rows[i], t);
  return sum;
}

double chen_millero(const ChenMilleroCoefficients& k, double t, double s, double pressure_dbar) {
  const double p = pressure_dbar / kDecibarPerBar;
  return polynomial(k.c, t, p) + polynomial(k.a, t, p) * s + polynomial(k.b, t, p) * s * std::sqrt(s) +
         polynomial(k.d, p) * s * s;
}

}  // namespace

double mackenzie_1981(double temperature_degc, double salinity_psu, double depth_m) {
  // Mackenzie 1981, nine terms, S' = S - 35:
  //   c = 1448.96 + 4.591 T - 5.304e-2 T^2 + 2.374e-4 T^3 + 1.340 S' + 1.630e-2 D + 1.675e-7 D^2
  //     - 1.025e-2 T S' - 7.139e-13 T D^3
  const double t = temperature_degc, s = salinity_psu - 35, d = depth_m;
  return 1448.96 + ((2.374e-4 * t - 5.304e-2) * t + 4.591) * t + 1.340 * s + (1.630e-2 + 1.675e-7 * d) * d -
         1.025e-2 * t * s - 7.139e-13 * t * d * d * d;
}

double unesco_chen_millero(double temperature_t68_degc, double salinity_psu, double pressure_dbar) {
  return chen_millero(kUnesco1983, temperature_t68_degc, salinity_psu, pressure_dbar);
}

double chen_millero_wong_zhu_1995(double temperature_t90_degc, double salinity_psu, double pressure_dbar) {
  return chen_millero(kWongZhu1995, temperature_t90_degc, salinity_psu, pressure_dbar);
}

// Polynomial of table III of Wong and Zhu 1995: c = 1402.392 + CT(T) + CS(S) + CP(P) + CSTP(S, T, P).
double del_grosso_wong_zhu_1995(double temperature_t90_degc, double salinity_psu,
                                double pressure_kg_per_cm2) {
  const double t = temperature_t90_degc, s = salinity_psu, p = pressure_kg_per_cm2;
  const double of_temperature = 0.5012285e1 * t - 0.551184e-1 * t * t + 0.221649e-3 * t * t * t;
  const double of_salinity = 0.1329530e1 * s + 0.1288598e-3 * s * s;
  const double of_pressure = 0.1560592 * p + 0.2449993e-4 * p * p - 0.8833959e-8 * p * p * p;
  const double of_all = -0.1275936e-1 * t * s + 0.6353509e-2 * t * p + 0.2656174e-7 * t * t * p * p -
                        0.1593895e-5 * t * p * p + 0.5222483e-9 * t * p * p * p -
                        0.4383615e-6 * t * t * t * p - 0.1616745e-8 * s * s * p * p +
                        0.9688441e-4 * t * t * s + 0.4857614e-5 * t * s * s * p - 0.3406824e-3 * t * s * p;
  return 1402.392 + of_temperature + of_salinity + of_pressure + of_all;
}

// Short formula of Urick 1983, with t in tens of degrees and z in kilometres:
//   c = 1449.05 + 45.7 t - 5.21 t^2 + 0.23 t^3 + (1.333 - 0.126 t + 0.009 t^2) (S - 35) + 16.3 z + 0.18 z^2
double harris_zorzi_2007(double temperature_degc, double salinity_psu, double depth_m) {
  const double t = temperature_degc / 10, z = depth_m / 1000;
  return 1449.05 + (45.7 + (-5.21 + 0.23 * t) * t) * t +
         (1.333 + (-0.126 + 0.009 * t) * t) * (salinity_psu - 35) + (16.3 + 0.18 * z) * z;
}

std::string_view to_name(SoundSpeedModel model) {
  for (const NamedModel& known : kNames) {
    if (known.model == model) return known.name;
  }
  return "unknown";
}

std::optional<SoundSpeedModel> sound_speed_model_from_name(std::string_view name) {
  for (const NamedModel& known : kNames) {
    if (known.name == name) return known.model;
  }
  return std::nullopt;
}

double sound_speed_mps(SoundSpeedModel model, double temperature_degc, double salinity_psu, double depth_m,
                       double latitude_rad) {
  const double t = temperature_degc, s = salinity_psu;
  if (model == SoundSpeedModel::kMackenzie1981) return mackenzie_1981(t, s, depth_m);
  if (model == SoundSpeedModel::kHarrisZorzi2007) return harris_zorzi_2007(t, s, depth_m);
  const double p = standard_ocean_pressure_dbar(depth_m, latitude_rad);
  switch (model) {
    case SoundSpeedModel::kUnescoChenMillero:
      return unesco_chen_millero(t * kT68PerT90, s, p);
    case SoundSpeedModel::kDelGrossoWongZhu1995:
      return del_grosso_wong_zhu_1995(t, s, p * kPascalPerDecibar / kPascalPerKgPerCm2);
    case SoundSpeedModel::kTeos10:
      return teos10_75_term(s, t, p);
    default:
      return chen_millero_wong_zhu_1995(t, s, p);
  }
}

}  // namespace halocline::acoustics
