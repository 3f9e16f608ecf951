// SPDX-License-Identifier: BSD-3-Clause
// Absorption of sound by sea water, dB/km, by the published formulas that the project offers.
//
// All formulas have one form, relaxation of salts plus viscous water:
//   alpha(f) = constant + a1 f^2/(f1^2 + f^2) + a2 f^2/(f2^2 + f^2) + a3 f^2.
// The coefficients at a point of the water are computed once (AbsorptionSpectrum) and evaluated at many
// frequencies.
//
//   const double a = absorption_spectrum(AbsorptionModel::kFisherSimmons1977, {.temperature_degc = 4,
//       .salinity_psu = 35, .depth_m = 0, .pressure_atm = 1, .ph = 8}).components_at(10e3).total_db_per_km;
//       // 0.83
//
// Frequencies are in Hz; formulas in kHz convert internally. Levels are in dB (10 log10 of power). What
// turbid water carries is added where a spectrum states it (water_load.h). Left out: scattering, bubbles,
// fresh water with dissolved minerals.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "acoustics/math/frequency_band.h"
#include "acoustics/sea/water_load.h"
#include "core/units.h"

namespace halocline::acoustics {

// Formulas for absorption, with their sources and the ranges for which they were published.
enum class AbsorptionModel {
  // Fisher and Simmons 1977 (JASA 62, 558): temperature and absolute pressure; S = 35 and pH = 8 are fixed.
  // Fitted for 10..400 kHz, used from 0.1 kHz. The model of the 2010 IEEE SMC paper; f in Hz, pressure in
  // atmospheres, times 8686 to give dB/km.
  kFisherSimmons1977,
  // Francois and Garrison 1982 (JASA 72, 896 and 1879): T -2..22, S 30..35, depth, pH; 0.2..1000 kHz; 5 %.
  kFrancoisGarrison1982,
  // Ainslie and McColm 1998 (JASA 103, 1671): T -6..35, S 5..50, depth 0..7 km, pH 7.7..8.3; within 10 % of
  // Francois and Garrison.
  kAinslieMcColm1998,
  // Thorp 1967 (JASA 42, 270), converted from kiloyards to kilometres (1.0936 kyd to a km). 4 degC, 0.1..50
  // kHz.
  kThorp1967,
  // Thorp with the viscous term and the low-frequency constant of later texts (Stojanovic 2006; f above 0.4
  // kHz).
  kThorpExtended,
  // The low-frequency form that goes with kThorpExtended, 0.002 + 0.11 f^2/(1 + f^2) + 0.011 f^2; f below 0.4
  // kHz.
  kThorpLowFrequency,
  // kThorpExtended and kThorpLowFrequency joined at 0.4 kHz.
  kThorpPiecewise,
  // Thorp with the constants of Jensen, Kuperman, Porter and Schmidt 2011 (equation 1.47).
  kThorpJensen,
};

inline constexpr std::array kAbsorptionModels = {
    AbsorptionModel::kFisherSimmons1977, AbsorptionModel::kFrancoisGarrison1982,
    AbsorptionModel::kAinslieMcColm1998, AbsorptionModel::kThorp1967,
    AbsorptionModel::kThorpExtended,     AbsorptionModel::kThorpLowFrequency,
    AbsorptionModel::kThorpPiecewise,    AbsorptionModel::kThorpJensen};

// Names of the models: "fisher-simmons", "francois-garrison", "ainslie-mccolm", "thorp", "thorp-extended",
// "thorp-low-frequency", "thorp-piecewise", "thorp-jensen". The inverse is empty for any other name.
std::string_view to_name(AbsorptionModel model);
std::optional<AbsorptionModel> absorption_model_from_name(std::string_view name);

// Properties of the water at a point that absorption depends on. Each formula uses those that it has terms
// for.
struct AbsorbingWater {
  double temperature_degc;
  double salinity_psu;
  double depth_m;
  double pressure_atm;  // absolute, 1 at the surface: see pressure_atm_absolute
  double ph;            // NBS scale
};

// Components of absorption, dB/km, and relaxation frequencies, Hz. For Thorp's formulas the components are
// the first, second and quadratic terms; the constant is included in the total only.
struct AbsorptionComponents {
  double boric_db_per_km;
  double magnesium_sulphate_db_per_km;
  double water_db_per_km;
  double total_db_per_km;
  double boric_relaxation_hz;
  double magnesium_sulphate_relaxation_hz;
};

// Coefficients of alpha(f) for one model at one point of the water; frequencies in kHz.
struct AbsorptionSpectrum {
  double constant;                  // dB/km
  double boric, boric_khz_squared;  // a1, dB/km; f1^2, kHz^2
  double sulphate, sulphate_khz_squared;
  double water;           // a3, dB/km/kHz^2
  bool low_below_400_hz;  // kThorpPiecewise only
  WaterLoad load = {};    // load of the water
  // Total absorption, dB/km, at `frequency_khz_squared` > 0: the innermost loop of a link budget.
  double db_per_km(double frequency_khz_squared) const {
    const double clear = clear_db_per_km(frequency_khz_squared);
    return load.is_none() ? clear : clear + load.db_per_km(khz_to_hz(std::sqrt(frequency_khz_squared)));
  }
  // Absorption of clear water, dB/km.
  double clear_db_per_km(double frequency_khz_squared) const {
    const double f2 = frequency_khz_squared;
    if (low_below_400_hz && f2 < kThorpJoinKhz * kThorpJoinKhz) return thorp_low(f2);
    return constant + boric * f2 / (boric_khz_squared + f2) + sulphate * f2 / (sulphate_khz_squared + f2) +
           water * f2;
  }
  AbsorptionComponents components_at(double frequency_hz) const;  // frequency_hz > 0

  static constexpr double kThorpJoinKhz = kThorpJointHz / 1000;
  static double thorp_low(double frequency_khz_squared);
};

// The coefficients of `model` for the given water.
AbsorptionSpectrum absorption_spectrum(AbsorptionModel model, const AbsorbingWater& water);

// Total absorption, dB/km, at `frequency_hz` > 0.
double absorption_db_per_km(AbsorptionModel model, const AbsorbingWater& water, double frequency_hz);

// Thorp's original value, dB per kiloyard (914.4 m).
double thorp_1967_db_per_kiloyard(double frequency_hz);

}  // namespace halocline::acoustics
