// SPDX-License-Identifier: BSD-3-Clause
// Quantities of a straight link through uniform water: transmission loss, signal-to-noise ratio, capacity.
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "acoustics/link/capacity.h"
#include "acoustics/link/optimum_band.h"
#include "acoustics/link/transmission_loss.h"
#include "acoustics/math/frequency_band.h"
#include "acoustics/sea/absorption.h"
#include "core/check.h"
#include "core/units.h"
#include "halocline/calc/columns.h"
#include "halocline/calc/quantity.h"

namespace halocline::clients {
namespace {

using acoustics::AbsorptionModel;

using ModelRowFunction = std::function<std::vector<double>(AbsorptionModel, const std::vector<double>&)>;

// Returns one form for each absorption formula, with the columns `own` followed by those of the water.
std::vector<QuantityForm> forms_by_absorption(const std::vector<InputColumn>& own,
                                              const std::vector<std::string>& outputs,
                                              const ModelRowFunction& function) {
  std::vector<QuantityForm> forms;
  for (const AbsorptionModel model : acoustics::kAbsorptionModels) {
    const RowFunction of_model = [model, function](const std::vector<double>& v) {
      return function(model, v);
    };
    forms.push_back({std::string(to_name(model)), joined(own, absorbing_water_columns(model)), outputs,
                     [of_model](const CalcOptions&) { return of_model; }});
  }
  return forms;
}

Quantity transmission_loss() {
  return {"transmission-loss", "loss along a straight path",
          forms_by_absorption({range_column(), frequency_column("f_kHz"), spreading_column()},
                              {"alpha_dB_per_km", "spreading_dB", "absorption_dB", "TL_dB", "A_linear"},
                              [](AbsorptionModel model, const std::vector<double>& v) {
                                const double alpha =
                                    absorption_db_per_km(model, to_absorbing_water(v, 3), khz_to_hz(v[1]));
                                const auto loss = acoustics::transmission_loss(v[0], v[2], alpha);
                                return std::vector{alpha, loss.spreading.value, loss.absorption.value,
                                                   loss.total.value, to_power_ratio(loss.total).value};
                              })};
}

// Computes a signal-to-noise ratio; columns: level, range, frequency, bandwidth, spreading, shipping, wind,
// directivity, water:
//   SNR = SL - TL - NL - 10 log10(B) + DI
std::vector<double> snr_row(AbsorptionModel model, const std::vector<double>& v) {
  const double frequency_hz = khz_to_hz(v[2]);
  const double alpha = absorption_db_per_km(model, to_absorbing_water(v, 8), frequency_hz);
  const Decibels loss = acoustics::transmission_loss(v[1], v[4], alpha).total;
  const Decibels received = Decibels{v[0]} - loss;
  const Decibels noise = acoustics::noise_components(frequency_hz, {v[5], v[6]}).total;
  const Decibels snr = received - noise - to_decibels(PowerRatio{v[3]}) + Decibels{v[7]};
  return {loss.value, received.value, noise.value, snr.value};
}

Quantity snr() {
  const InputColumn bandwidth{{"B_Hz"}, 1e-6, 1e9, {}}, directivity{{"DI_dB"}, -100, 100, 0};
  return {"snr", "signal-to-noise ratio, noise of the centre over the band (equation 7)",
          forms_by_absorption({source_level_column(), range_column(), frequency_column("f_kHz"), bandwidth,
                               spreading_column(), shipping_column(), wind_column(), directivity},
                              {"TL_dB", "Prx_dB_re_1uPa", "N_dB_re_1uPa2_per_Hz", "SNR_dB"}, snr_row)};
}

// Computes the capacity; columns: level, range, low, high, spreading, shipping, wind, water.
std::vector<double> capacity_row(AbsorptionModel model, const std::vector<double>& v) {
  require(v[2] < v[3], "f_lo_kHz has to be below f_hi_kHz");
  const acoustics::UniformLink link{.source_level = {v[0]},
                                    .range_m = v[1],
                                    .spreading_exponent = v[4],
                                    .absorption = absorption_spectrum(model, to_absorbing_water(v, 7)),
                                    .noise = {v[5], v[6]}};
  const acoustics::Band band{khz_to_hz(v[2]), khz_to_hz(v[3])};
  return {capacity_bps(link, band), narrowband_capacity_bps(link, band)};
}

Quantity capacity() {
  return {"capacity", "capacity of a band, integrated (equation 8) and as if narrow",
          forms_by_absorption(
              {source_level_column(), range_column(), frequency_column("f_lo_kHz"),
               frequency_column("f_hi_kHz"), spreading_column(), shipping_column(), wind_column()},
              {"C_bit_per_s", "C_narrowband_at_fc_bit_per_s"}, capacity_row)};
}

void add_plan(std::vector<double>& row, const acoustics::BandPlan& plan) {
  row.insert(row.end(),
             {hz_to_khz(plan.band.low_hz), hz_to_khz(plan.band.high_hz), plan.band.width_hz(),
              plan.source_level.value, plan.capacity_bps, plan.capacity_bps / plan.band.width_hz()});
}

// Computes the optimum band; columns: range in km, spreading, shipping, wind, target ratio, water.
std::vector<double> optimum_row(AbsorptionModel model, const std::vector<double>& v) {
  const acoustics::OptimumBand best =
      acoustics::optimum_band({.range_m = 1000 * v[0],
                               .spreading_exponent = v[1],
                               .absorption = absorption_spectrum(model, to_absorbing_water(v, 5)),
                               .noise = {v[2], v[3]},
                               .target_snr = {v[4]}});
  std::vector<double> row = {hz_to_khz(best.optimum_frequency_hz), -best.min_loss_and_noise.value};
  add_plan(row, best.flat);
  add_plan(row, best.water_filling);
  return row;
}

Quantity optimum_band() {
  const InputColumn range{{"range_km"}, 1e-3, 1e3, {}}, target{{"snr_target_dB"}, -100, 100, 20};
  Quantity quantity{
      "optimum-band", "best band over a distance, its power and capacity (Stojanovic 2006)",
      forms_by_absorption({range, spreading_column(), shipping_column(), wind_column(), target},
                          {"f_opt_kHz", "minus_AN_min_dB", "f3_lo_kHz", "f3_hi_kHz", "B3_Hz", "P3_dB_re_1uPa",
                           "C3_bit_per_s", "C3_over_B3", "fwf_lo_kHz", "fwf_hi_kHz", "Bwf_Hz",
                           "Pwf_dB_re_1uPa", "Cwf_bit_per_s", "Cwf_over_Bwf"},
                          optimum_row)};
  // Stojanovic's absorption formula comes first.
  for (QuantityForm& form : quantity.forms) {
    if (form.model == to_name(AbsorptionModel::kThorpPiecewise)) std::swap(form, quantity.forms.front());
  }
  return quantity;
}

}  // namespace

std::vector<Quantity> link_quantities() { return {transmission_loss(), snr(), capacity(), optimum_band()}; }

}  // namespace halocline::clients
