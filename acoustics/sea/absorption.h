// SPDX-License-Identifier: BSD-3-Clause
// Absorption of sound by sea water, dB/km, by every formula the project names.
//
// All of them have one shape: relaxing salts plus viscous water,
//   alpha(f) = constant + a1 f^2/(f1^2 + f^2) + a2 f^2/(f2^2 + f^2) + a3 f^2,
// so water at a point is described once (AbsorptionSpectrum) and evaluated at many frequencies.
//
//   const double a = absorption_spectrum(AbsorptionModel::kFisherSimmons1977, {.temperature_degc = 4,
//       .salinity_psu = 35, .depth_m = 0, .pressure_atm = 1, .ph = 8}).components_at(10e3).total_db_per_km;
//       // 0.83
//
// Frequencies come in Hz; formulas in kHz convert inside. Levels are true decibels (10 log10).
// Left out: scattering, bubbles, turbid water, fresh water with dissolved minerals.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "acoustics/math/frequency_band.h"

namespace halocline::acoustics {

enum class AbsorptionModel {
  // Fisher and Simmons 1977 (JASA 62, 558): T, absolute pressure; fixed S = 35, pH = 8. 10..400 kHz fitted,
  // used
  // from 0.1 kHz. The 2010 IEEE SMC paper's model; f in Hz, pressure in atmospheres, times 8686 to dB/km.
  kFisherSimmons1977,
  // Francois and Garrison 1982 (JASA 72, 896 and 1879): T -2..22, S 30..35, depth, pH; 0.2..1000 kHz; 5 %.
  kFrancoisGarrison1982,
  // Ainslie and McColm 1998 (JASA 103, 1671): T -6..35, S 5..50, depth 0..7 km, pH 7.7..8.3; within 10 % of
  // the above.
  kAinslieMcColm1998,
  // Thorp 1967 (JASA 42, 270), per kiloyard turned into per kilometre once (1.0936 kyd to a km). 4 degC,
  // 0.1..50 kHz.
  kThorp1967,
  // Thorp with the viscous term and the low-frequency floor of later texts (Stojanovic 2006; f above 0.4
  // kHz).
  kThorpExtended,
  // The extended form's low-frequency companion, 0.002 + 0.11 f^2/(1 + f^2) + 0.011 f^2; f below 0.4 kHz.
  kThorpLowFrequency,
  // The two above joined at 0.4 kHz.
  kThorpPiecewise,
  // Thorp in the constants of Jensen, Kuperman, Porter and Schmidt 2011 (equation 1.47).
  kThorpJensen,
};

inline constexpr std::array kAbsorptionModels = {
    AbsorptionModel::kFisherSimmons1977, AbsorptionModel::kFrancoisGarrison1982,
    AbsorptionModel::kAinslieMcColm1998, AbsorptionModel::kThorp1967,
    AbsorptionModel::kThorpExtended,     AbsorptionModel::kThorpLowFrequency,
    AbsorptionModel::kThorpPiecewise,    AbsorptionModel::kThorpJensen};

// "fisher-simmons", "francois-garrison", "ainslie-mccolm", "thorp", "thorp-extended", "thorp-low-frequency",
// "thorp-piecewise", "thorp-jensen".
std::string_view to_name(AbsorptionModel model);
std::optional<AbsorptionModel> absorption_model_from_name(std::string_view name);

// The water at a point, as far as absorption depends on it. Each formula reads what it knows of.
struct AbsorbingWater {
  double temperature_degc;
  double salinity_psu;
  double depth_m;
  double pressure_atm;  // absolute, 1 at the surface: see pressure_atm_absolute
  double ph;            // NBS scale
};

// dB/km; relaxation frequencies in Hz. In Thorp's formulas the components are their first, second and
// quadratic terms (the constant is in the total only).
struct AbsorptionComponents {
  double boric_db_per_km;
  double magnesium_sulphate_db_per_km;
  double water_db_per_km;
  double total_db_per_km;
  double boric_relaxation_hz;
  double magnesium_sulphate_relaxation_hz;
};

// alpha(f) of one model at one point of the water. Frequencies inside in kHz.
struct AbsorptionSpectrum {
  double constant;                  // dB/km
  double boric, boric_khz_squared;  // a1, dB/km; f1^2
  double sulphate, sulphate_khz_squared;
  double water;           // a3, dB/km/kHz^2
  bool low_below_400_hz;  // kThorpPiecewise only
  // Total, dB/km, at `frequency_khz_squared` > 0: the innermost loop of a link.
  double db_per_km(double frequency_khz_squared) const {
    const double f2 = frequency_khz_squared;
    if (low_below_400_hz && f2 < kThorpJoinKhz * kThorpJoinKhz) return thorp_low(f2);
    return constant + boric * f2 / (boric_khz_squared + f2) + sulphate * f2 / (sulphate_khz_squared + f2) +
           water * f2;
  }
  AbsorptionComponents components_at(double frequency_hz) const;  // frequency_hz > 0

  static constexpr double kThorpJoinKhz = kThorpJointHz / 1000;
  static double thorp_low(double frequency_khz_squared);
};

AbsorptionSpectrum absorption_spectrum(AbsorptionModel model, const AbsorbingWater& water);

// Total absorption, dB/km, at `frequency_hz` > 0.
double absorption_db_per_km(AbsorptionModel model, const AbsorbingWater& water, double frequency_hz);

// Thorp's own number, dB per kiloyard (914.4 m).
double thorp_1967_db_per_kiloyard(double frequency_hz);

}  // namespace halocline::acoustics
