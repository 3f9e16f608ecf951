// SPDX-License-Identifier: BSD-3-Clause
// Speed of sound in sea water, m/s, by the published formulas that the project offers.
//
// Each function is the published polynomial of the published variables. Within the stated range the error of
// the fit is as stated. Outside of it the polynomial is still evaluated and no input is clamped, since the
// authors' own check values lie outside. Temperatures are in degC, salinities practical (psu, parts per
// thousand), pressures gauge.
//
//   const double c = mackenzie_1981(25, 35, 1000);  // 1550.744
//
// Left out: bubbles, suspended sediment, dispersion (below 1e-5 at modem frequencies).
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace halocline::acoustics {

// Mackenzie 1981 (JASA 70, 807), nine terms; corrects a misprint of the 2010 IEEE SMC paper, where the T^2
// and T^3 terms are fused. T -2..30, S 25..40, depth 0..8000 m; 0.07 m/s.
double mackenzie_1981(double temperature_degc, double salinity_psu, double depth_m);

// Chen and Millero 1977 as in UNESCO 1983 (Technical Paper 44). T on the IPTS-68 scale, 0..40; S 0..40;
// pressure 0..10 000 dbar, converted internally to the bar of the polynomial. 0.19 m/s.
double unesco_chen_millero(double temperature_t68_degc, double salinity_psu, double pressure_dbar);

// The equation of Chen and Millero refitted to ITS-90 by Wong and Zhu 1995 (JASA 97, 1732). Ranges as for
// unesco_chen_millero().
double chen_millero_wong_zhu_1995(double temperature_t90_degc, double salinity_psu, double pressure_dbar);

// Del Grosso 1974 (JASA 56, 1084) refitted to ITS-90 by Wong and Zhu 1995. T 0..30, S 30..40,
// pressure 0..1000 kg/cm^2 (one is 98 066.5 Pa); 0.05 m/s.
double del_grosso_wong_zhu_1995(double temperature_t90_degc, double salinity_psu, double pressure_kg_per_cm2);

// TEOS-10 by the 75-term polynomial of specific volume v, Roquet et al. 2015 (Ocean Modelling 90, 29):
//   c = sqrt(-v^2 / (dv/dp)).
// Absolute salinity 0..42 g/kg, conservative temperature -2..40 degC, 0..8000 dbar.
double teos10_75_term(double absolute_salinity_g_per_kg, double conservative_temperature_degc,
                      double pressure_dbar);

// The short formula of Harris and Zorzi 2007 ("Modeling the underwater acoustic channel in ns2"), after Urick
// 1983 and Coppens 1981. T 0..35, S 0..45, depth 0..4000 m. Kept because delays were published with it; 0.1
// m/s near 4 km.
double harris_zorzi_2007(double temperature_degc, double salinity_psu, double depth_m);

// Formulas by which a profile of temperature and salinity is converted to sound speed.
enum class SoundSpeedModel {
  kMackenzie1981,
  kUnescoChenMillero,
  kChenMilleroWongZhu1995,
  kDelGrossoWongZhu1995,
  kTeos10,  // needs conservative temperature and absolute salinity
  kHarrisZorzi2007,
};

inline constexpr std::array kSoundSpeedModels = {SoundSpeedModel::kMackenzie1981,
                                                 SoundSpeedModel::kUnescoChenMillero,
                                                 SoundSpeedModel::kChenMilleroWongZhu1995,
                                                 SoundSpeedModel::kDelGrossoWongZhu1995,
                                                 SoundSpeedModel::kTeos10,
                                                 SoundSpeedModel::kHarrisZorzi2007};

// Names of the models: "mackenzie", "unesco", "chen-millero", "del-grosso", "teos10", "harris-zorzi".
std::string_view to_name(SoundSpeedModel model);
// Empty when no model has that name.
std::optional<SoundSpeedModel> sound_speed_model_from_name(std::string_view name);

// Sound speed by any model at a depth. Models of pressure use that of the standard ocean at `latitude_rad`
// (acoustics/sea/pressure.h), and each model its own temperature scale (`temperature_degc` is ITS-90; T68 =
// 1.00024 T90).
double sound_speed_mps(SoundSpeedModel model, double temperature_degc, double salinity_psu, double depth_m,
                       double latitude_rad);

}  // namespace halocline::acoustics
