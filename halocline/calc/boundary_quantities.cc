// SPDX-License-Identifier: BSD-3-Clause
// Quantities of the sea's boundaries: bottom reflection, surface loss, wave height and roughness.
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "acoustics/sea/boundary_reflection.h"
#include "core/elementary.h"
#include "core/units.h"
#include "halocline/calc/columns.h"
#include "halocline/calc/quantity.h"

namespace halocline::clients {
namespace {

using acoustics::FluidBottom;
using acoustics::Reflection;
using acoustics::SurfaceModel;

constexpr double kWaterSpeed = 1500;  // m/s; fixed for the Rayleigh parameter and losses

InputColumn grazing_column() { return {{"grazing_deg"}, 1e-6, 90, {}}; }

std::vector<std::string> reflection_outputs() {
  return {"abs_V", "arg_V_rad(conv n=(1+i*delta)/cr)", "bottom_loss_dB"};
}

std::vector<double> reflection_row(const FluidBottom& bottom, double grazing_deg) {
  const Reflection one = acoustics::bottom_reflection(bottom, to_radians(grazing_deg), kWaterSpeed);
  return {one.magnitude, -one.phase_rad, one.loss_db()};
}

Quantity bottom_reflection() {
  const InputColumn density{{"density_ratio"}, 0.5, 10, {}}, speed{{"sound_speed_ratio"}, 0.5, 5, {}};
  const InputColumn loss{{"loss_parameter_delta"}, 0, 1, {}};
  Quantity quantity{
      "bottom-reflection",
      "Rayleigh's reflection at a fluid bottom, given by numbers or as a sediment of TR 9407",
      {plain("rayleigh", {density, speed, loss, grazing_column()}, reflection_outputs(),
             [](const std::vector<double>& v) {
               return reflection_row({v[0], v[1], 0, v[2], acoustics::BottomLoss::kComplexWaveNumber}, v[3]);
             })}};
  for (const std::string_view name : acoustics::sediment_names()) {
    const FluidBottom bottom = *acoustics::sediment(name);
    quantity.forms.push_back(
        plain(std::string(name), {grazing_column()}, reflection_outputs(),
              [bottom](const std::vector<double>& v) { return reflection_row(bottom, v[0]); }));
  }
  return quantity;
}

QuantityForm loss_form(SurfaceModel model, const std::string& output) {
  return plain(
      std::string(to_name(model)), {frequency_column("f_kHz"), wind_column(), grazing_column()}, {output},
      [model](const std::vector<double>& v) {
        return std::vector{acoustics::surface_loss_db({model, v[1]}, to_radians(v[2]), khz_to_hz(v[0]))};
      });
}

Quantity surface_loss() {
  return {"surface-loss",
          "loss of one bounce at the surface",
          {loss_form(SurfaceModel::kAplBubbles, "loss_APL9407_bubble_dB"),
           loss_form(SurfaceModel::kEckart, "loss_Eckart_coherent_dB"),
           loss_form(SurfaceModel::kCoates, "loss_Coates1988_BS_dB(wind in knots inside)"),
           loss_form(SurfaceModel::kJones, "loss_Jones2009_BS_dB")}};
}

Quantity wave_height() {
  return {
      "wave-height",
      "rms height of a fully developed sea",
      {plain("pierson-moskowitz", {wind_column()}, {"h_rms_PM_0p22w2_over_4g_m"},
             [](const std::vector<double>& v) { return std::vector{acoustics::rms_wave_height_m(v[0])}; })}};
}

// Rayleigh parameter of the surface, with sigma the rms wave height and G the grazing angle:
//   Gamma = 2 k sigma sin G,  k = 2 pi f / c,  c = 1500 m/s
Quantity rayleigh_parameter() {
  return {"rayleigh-parameter",
          "2 k sigma sin(grazing) of the surface, k at 1500 m/s, sigma the rms wave height",
          {plain("pierson-moskowitz", {frequency_column("f_kHz"), wind_column(), grazing_column()},
                 {"Rayleigh_parameter_Gamma(c=1500)"}, [](const std::vector<double>& v) {
                   const double wave_number = 2 * std::numbers::pi * khz_to_hz(v[0]) / kWaterSpeed;
                   return std::vector{2 * wave_number * acoustics::rms_wave_height_m(v[1]) *
                                      elementary::sin(to_radians(v[2]))};
                 })}};
}

}  // namespace

std::vector<Quantity> boundary_quantities() {
  return {bottom_reflection(), surface_loss(), wave_height(), rayleigh_parameter()};
}

}  // namespace halocline::clients
