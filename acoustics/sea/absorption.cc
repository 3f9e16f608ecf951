// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/absorption.h"

#include <cmath>

#include "core/elementary.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

constexpr double kDbPerKmPerNeperPerMetre = 8686;  // 1000 * 20 log10(e), as rounded by Fisher and Simmons
// Rounded, as in common use with Thorp's formula; exact is 1.09361.
constexpr double kKiloyardsPerKilometre = 1.0936;
constexpr double kHzSquaredPerKhzSquared = 1e6;

struct NamedModel {
  AbsorptionModel model;
  std::string_view name;
};
constexpr NamedModel kNames[] = {
    {AbsorptionModel::kFisherSimmons1977, "fisher-simmons"},
    {AbsorptionModel::kFrancoisGarrison1982, "francois-garrison"},
    {AbsorptionModel::kAinslieMcColm1998, "ainslie-mccolm"},
    {AbsorptionModel::kThorp1967, "thorp"},
    {AbsorptionModel::kThorpExtended, "thorp-extended"},
    {AbsorptionModel::kThorpLowFrequency, "thorp-low-frequency"},
    {AbsorptionModel::kThorpPiecewise, "thorp-piecewise"},
    {AbsorptionModel::kThorpJensen, "thorp-jensen"},
};

// Fisher and Simmons 1977, equations as in table II of the 2010 IEEE SMC paper: boric acid, magnesium
// sulphate and water; f in Hz, P in atm, T in degC, result in Np/m.
//   alpha = A1 f1 f^2 / (f1^2 + f^2) + A2 P2 f2 f^2 / (f2^2 + f^2) + A3 P3 f^2
AbsorptionSpectrum fisher_simmons(const AbsorbingWater& water) {
  const double t = water.temperature_degc, p = water.pressure_atm, kelvin = t + 273.1;
  const double a1 = 1.03e-8 + 2.36e-10 * t - 5.22e-12 * t * t;
  const double a2 = 5.62e-8 + 7.52e-10 * t;
  const double a3 = (55.9 - 2.37 * t + 4.77e-2 * t * t - 3.48e-4 * t * t * t) * 1e-15;
  const double f1_hz = 1.32e3 * kelvin * elementary::exp(-1700 / kelvin);
  const double f2_hz = 1.55e7 * kelvin * elementary::exp(-3052 / kelvin);
  const double p2 = 1 - 10.3e-4 * p + 3.7e-7 * p * p;
  const double p3 = 1 - 3.84e-4 * p + 7.57e-8 * p * p;
  constexpr double k = kDbPerKmPerNeperPerMetre;
  return {.constant = 0,
          .boric = k * a1 * f1_hz,
          .boric_khz_squared = f1_hz * f1_hz / kHzSquaredPerKhzSquared,
          .sulphate = k * a2 * p2 * f2_hz,
          .sulphate_khz_squared = f2_hz * f2_hz / kHzSquaredPerKhzSquared,
          .water = k * a3 * p3 * kHzSquaredPerKhzSquared,
          .low_below_400_hz = false,
          .load = {}};
}

// Cubic for the viscosity of pure water, in two pieces (Francois and Garrison 1982, part II, equation 10).
double francois_garrison_a3(double t) {
  return t <= 20 ? 4.937e-4 - 2.59e-5 * t + 9.11e-7 * t * t - 1.50e-8 * t * t * t
                 : 3.964e-4 - 1.146e-5 * t + 1.45e-7 * t * t - 6.5e-10 * t * t * t;
}

// Francois and Garrison 1982, part II, with P1 = 1; f in kHz, D in m, result in dB/km.
//   alpha = A1 f1 f^2 / (f1^2 + f^2) + A2 P2 f2 f^2 / (f2^2 + f^2) + A3 P3 f^2
AbsorptionSpectrum francois_garrison(const AbsorbingWater& water) {
  const double t = water.temperature_degc, s = water.salinity_psu, d = water.depth_m;
  // Estimate of sound speed by the same authors, m/s.
  const double c = 1412 + 3.21 * t + 1.19 * s + 0.0167 * d;
  const double a1 = 8.86 / c * elementary::exp10(0.78 * water.ph - 5);
  const double f1 = 2.8 * std::sqrt(s / 35) * elementary::exp10(4 - 1245 / (t + 273));
  const double a2 = 21.44 * s / c * (1 + 0.025 * t);
  const double p2 = 1 - 1.37e-4 * d + 6.2e-9 * d * d;
  const double f2 = 8.17 * elementary::exp10(8 - 1990 / (t + 273)) / (1 + 0.0018 * (s - 35));
  const double p3 = 1 - 3.83e-5 * d + 4.9e-10 * d * d;
  return {.constant = 0,
          .boric = a1 * f1,
          .boric_khz_squared = f1 * f1,
          .sulphate = a2 * p2 * f2,
          .sulphate_khz_squared = f2 * f2,
          .water = francois_garrison_a3(t) * p3,
          .low_below_400_hz = false,
          .load = {}};
}

// Ainslie and McColm 1998; f in kHz, z in km, result in dB/km.
//   alpha = 0.106 f1 f^2 / (f1^2 + f^2) e^((pH - 8) / 0.56)
//         + 0.52 (1 + T / 43) (S / 35) f2 f^2 / (f2^2 + f^2) e^(-z / 6)
//         + 0.00049 f^2 e^(-(T / 27 + z / 17))
AbsorptionSpectrum ainslie_mccolm(const AbsorbingWater& water) {
  const double t = water.temperature_degc, s = water.salinity_psu, z_km = water.depth_m / 1000;
  const double f1 = 0.78 * std::sqrt(s / 35) * elementary::exp(t / 26);
  const double f2 = 42 * elementary::exp(t / 17);
  return {.constant = 0,
          .boric = 0.106 * f1 * elementary::exp((water.ph - 8) / 0.56),
          .boric_khz_squared = f1 * f1,
          .sulphate = 0.52 * (1 + t / 43) * (s / 35) * f2 * elementary::exp(-z_km / 6),
          .sulphate_khz_squared = f2 * f2,
          .water = 0.00049 * elementary::exp(-(t / 27 + z_km / 17)),
          .low_below_400_hz = false,
          .load = {}};
}

// Thorp 1967, f in kHz, with the constants a, b, c, d of each author:
//   alpha = a + b f^2 / (1 + f^2) + c f^2 / (4100 + f^2) + d f^2
constexpr AbsorptionSpectrum thorp(double constant, double first, double second, double quadratic) {
  return {constant, first, 1, second, 4100, quadratic, false, {}};
}

constexpr AbsorptionSpectrum kThorpKiloyard = thorp(0, 0.1, 40, 0);
constexpr AbsorptionSpectrum kThorpKilometre =
    thorp(0, 0.1 * kKiloyardsPerKilometre, 40 * kKiloyardsPerKilometre, 0);
constexpr AbsorptionSpectrum kExtended = thorp(0.003, 0.11, 44, 2.75e-4);
constexpr AbsorptionSpectrum kLow = thorp(0.002, 0.11, 0, 0.011);
constexpr AbsorptionSpectrum kJensen = thorp(3.3e-3, 0.11, 44, 3.0e-4);

AbsorptionSpectrum piecewise() {
  AbsorptionSpectrum spectrum = kExtended;
  spectrum.low_below_400_hz = true;
  return spectrum;
}

}  // namespace

std::string_view to_name(AbsorptionModel model) {
  for (const NamedModel& known : kNames) {
    if (known.model == model) return known.name;
  }
  return "unknown";
}

std::optional<AbsorptionModel> absorption_model_from_name(std::string_view name) {
  for (const NamedModel& known : kNames) {
    if (known.name == name) return known.model;
  }
  return std::nullopt;
}

double AbsorptionSpectrum::thorp_low(double frequency_khz_squared) {
  return kLow.db_per_km(frequency_khz_squared);
}

AbsorptionComponents AbsorptionSpectrum::components_at(double frequency_hz) const {
  const double f = hz_to_khz(frequency_hz), f2 = f * f;
  if (low_below_400_hz && f < kThorpJoinKhz) {
    AbsorptionSpectrum low = kLow;
    low.load = load;
    return low.components_at(frequency_hz);
  }
  return {.boric_db_per_km = boric * f2 / (boric_khz_squared + f2),
          .magnesium_sulphate_db_per_km = sulphate * f2 / (sulphate_khz_squared + f2),
          .water_db_per_km = water * f2,
          .total_db_per_km = db_per_km(f2),
          .boric_relaxation_hz = khz_to_hz(std::sqrt(boric_khz_squared)),
          .magnesium_sulphate_relaxation_hz = khz_to_hz(std::sqrt(sulphate_khz_squared))};
}

AbsorptionSpectrum absorption_spectrum(AbsorptionModel model, const AbsorbingWater& water) {
  switch (model) {
    case AbsorptionModel::kFrancoisGarrison1982:
      return francois_garrison(water);
    case AbsorptionModel::kAinslieMcColm1998:
      return ainslie_mccolm(water);
    case AbsorptionModel::kThorp1967:
      return kThorpKilometre;
    case AbsorptionModel::kThorpExtended:
      return kExtended;
    case AbsorptionModel::kThorpLowFrequency:
      return kLow;
    case AbsorptionModel::kThorpPiecewise:
      return piecewise();
    case AbsorptionModel::kThorpJensen:
      return kJensen;
    case AbsorptionModel::kFisherSimmons1977:
      break;
  }
  return fisher_simmons(water);
}

double absorption_db_per_km(AbsorptionModel model, const AbsorbingWater& water, double frequency_hz) {
  const double f = hz_to_khz(frequency_hz);
  return absorption_spectrum(model, water).db_per_km(f * f);
}

double thorp_1967_db_per_kiloyard(double frequency_hz) {
  const double f = hz_to_khz(frequency_hz);
  return kThorpKiloyard.db_per_km(f * f);
}

}  // namespace halocline::acoustics
