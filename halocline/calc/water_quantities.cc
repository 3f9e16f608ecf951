// SPDX-License-Identifier: BSD-3-Clause
// Quantities of the water: sound speed, pressure, absorption, noise.
#include <string>
#include <utility>
#include <vector>

#include "acoustics/sea/absorption.h"
#include "acoustics/sea/noise.h"
#include "acoustics/sea/pressure.h"
#include "acoustics/sea/sound_speed.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/units.h"
#include "halocline/calc/columns.h"
#include "halocline/calc/quantity.h"

namespace halocline::clients {
namespace {

using acoustics::AbsorptionComponents;
using acoustics::AbsorptionModel;

using ThreeArguments = double (*)(double, double, double);

QuantityForm speed_form(const std::string& model, std::vector<InputColumn> inputs, ThreeArguments formula) {
  return plain(model, std::move(inputs), {"c_m_per_s"},
               [formula](const std::vector<double>& v) { return std::vector{formula(v[0], v[1], v[2])}; });
}

Quantity sound_speed() {
  const InputColumn s{{"S_psu", "S_ppt"}, 0, 60, {}}, p{{"p_dbar"}, 0, 12'000, {}};
  const InputColumn kilograms{{"P_kg_per_cm2"}, 0, 1300, {}}, absolute{{"SA_g_per_kg"}, 0, 60, {}};
  const InputColumn t = temperature_column("T_degC"), t68 = temperature_column("T68_degC"),
                    t90 = temperature_column("T90_degC"), ct = temperature_column("CT_degC");
  const InputColumn depth = depth_column("depth_m");
  return {"sound-speed",
          "speed of sound in sea water",
          {speed_form("mackenzie", {t, salinity_column(), depth}, acoustics::mackenzie_1981),
           speed_form("unesco", {t68, s, p}, acoustics::unesco_chen_millero),
           speed_form("chen-millero", {t90, s, p}, acoustics::chen_millero_wong_zhu_1995),
           speed_form("del-grosso", {t90, s, kilograms}, acoustics::del_grosso_wong_zhu_1995),
           speed_form("teos10", {absolute, ct, p}, acoustics::teos10_75_term),
           speed_form("harris-zorzi", {t, salinity_column(), depth}, acoustics::harris_zorzi_2007)}};
}

Quantity munk() {
  return {"munk",
          "sound speed of Munk's profile",
          {plain("munk", {depth_column("depth_m")}, {"c_m_per_s"}, [](const std::vector<double>& v) {
            return std::vector{acoustics::munk_sound_speed_mps(v[0])};
          })}};
}

Quantity pressure() {
  return {"pressure",
          "pressure at a depth (Leroy and Parthiot 1998)",
          {plain("leroy-parthiot", {depth_column("depth_m"), latitude_column()},
                 {"p_standard_ocean_dbar", "p_common_oceans_dbar"}, [](const std::vector<double>& v) {
                   const double latitude = to_radians(v[1]);
                   return std::vector{acoustics::standard_ocean_pressure_dbar(v[0], latitude),
                                      acoustics::common_oceans_pressure_dbar(v[0], latitude)};
                 })}};
}

Quantity depth() {
  return {"depth",
          "depth at a pressure (UNESCO 1983, Saunders and Fofonoff)",
          {plain("unesco", {{{"p_dbar"}, 0, 12'000, {}}, latitude_column()}, {"depth_m"},
                 [](const std::vector<double>& v) {
                   return std::vector{acoustics::unesco_depth_m(v[0], to_radians(v[1]))};
                 })}};
}

// Returns the form with absorption components, total and relaxation frequencies, which are in Hz or kHz as in
// the reference tables.
QuantityForm absorption_form(AbsorptionModel model, const std::string& frequency_unit, double hz_per_unit) {
  return plain(std::string(to_name(model)),
               joined({frequency_column("f_kHz")}, absorbing_water_columns(model)),
               {"alpha_boric_dB_per_km", "alpha_MgSO4_dB_per_km", "alpha_water_dB_per_km",
                "alpha_total_dB_per_km", "f1_boric_" + frequency_unit, "f2_MgSO4_" + frequency_unit},
               [model, hz_per_unit](const std::vector<double>& v) {
                 const AbsorptionComponents a =
                     absorption_spectrum(model, to_absorbing_water(v, 1)).components_at(khz_to_hz(v[0]));
                 return std::vector{a.boric_db_per_km,
                                    a.magnesium_sulphate_db_per_km,
                                    a.water_db_per_km,
                                    a.total_db_per_km,
                                    a.boric_relaxation_hz / hz_per_unit,
                                    a.magnesium_sulphate_relaxation_hz / hz_per_unit};
               });
}

double thorp_at(AbsorptionModel model, double frequency_khz) {
  // Thorp's formulas do not depend on the water.
  return absorption_db_per_km(model, {4, 35, 0, 1, 8}, khz_to_hz(frequency_khz));
}

QuantityForm all_thorp_forms() {
  return plain("thorp", {frequency_column("f_kHz")},
               {"thorp1967_dB_per_kyd", "thorp1967_dB_per_km(x1.0936)", "thorp_extended_dB_per_km",
                "thorp_lowfreq_dB_per_km", "thorp_piecewise_0.4kHz_dB_per_km", "thorp_JKPS_dB_per_km"},
               [](const std::vector<double>& v) {
                 return std::vector{acoustics::thorp_1967_db_per_kiloyard(khz_to_hz(v[0])),
                                    thorp_at(AbsorptionModel::kThorp1967, v[0]),
                                    thorp_at(AbsorptionModel::kThorpExtended, v[0]),
                                    thorp_at(AbsorptionModel::kThorpLowFrequency, v[0]),
                                    thorp_at(AbsorptionModel::kThorpPiecewise, v[0]),
                                    thorp_at(AbsorptionModel::kThorpJensen, v[0])};
               });
}

QuantityForm one_thorp_form(AbsorptionModel model) {
  return plain(std::string(to_name(model)), {frequency_column("f_kHz")}, {"alpha_total_dB_per_km"},
               [model](const std::vector<double>& v) { return std::vector{thorp_at(model, v[0])}; });
}

Quantity absorption() {
  return {
      "absorption",
      "absorption of sound, by salt and in total",
      {absorption_form(AbsorptionModel::kFisherSimmons1977, "Hz", 1),
       absorption_form(AbsorptionModel::kFrancoisGarrison1982, "kHz", 1000),
       absorption_form(AbsorptionModel::kAinslieMcColm1998, "kHz", 1000), all_thorp_forms(),
       one_thorp_form(AbsorptionModel::kThorpExtended), one_thorp_form(AbsorptionModel::kThorpLowFrequency),
       one_thorp_form(AbsorptionModel::kThorpPiecewise), one_thorp_form(AbsorptionModel::kThorpJensen)}};
}

Quantity noise() {
  return {
      "noise",
      "ambient noise, spectrum level by source and in total",
      {plain(
          "coates", {frequency_column("f_kHz"), shipping_column(), wind_column()},
          {"Nt_dB", "Ns_dB", "Nw_dB", "Nth_dB", "N_total_dB_re_1uPa2_per_Hz", "N_total_linear_uPa2_per_Hz"},
          [](const std::vector<double>& v) {
            const acoustics::NoiseComponents n = acoustics::noise_components(khz_to_hz(v[0]), {v[1], v[2]});
            return std::vector{n.turbulence.value, n.shipping.value, n.wind.value,
                               n.thermal.value,    n.total.value,    n.total_power.value};
          })}};
}

Quantity band_noise() {
  return {
      "noise-band",
      "ambient noise integrated over a band",
      {plain("coates",
             {frequency_column("f_lo_kHz"), frequency_column("f_hi_kHz"), shipping_column(), wind_column()},
             {"N_band_dB_re_1uPa"}, [](const std::vector<double>& v) {
               return std::vector{
                   acoustics::noise_level_over_band(khz_to_hz(v[0]), khz_to_hz(v[1]), {v[2], v[3]}).value};
             })}};
}

}  // namespace

std::vector<Quantity> water_quantities() {
  return {sound_speed(), absorption(), noise(), band_noise(), pressure(), depth(), munk()};
}

}  // namespace halocline::clients
