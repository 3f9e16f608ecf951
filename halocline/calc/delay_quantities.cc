// SPDX-License-Identifier: BSD-3-Clause
// Quantities that need a profile of the water: delays, and the figures of the 2010 IEEE SMC paper.
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "acoustics/link/link_budget.h"
#include "acoustics/link/link_kernel.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/profile_reader.h"
#include "acoustics/sea/sound_speed.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/units.h"
#include "halocline/calc/columns.h"
#include "halocline/calc/quantity.h"

namespace halocline::clients {
namespace {

using acoustics::AbsorptionModel;
using acoustics::SoundSpeedModel;
using acoustics::SoundSpeedProfile;

// Water of profiles that hold sound speed only, as in the profile reader: 10 degC, 35 PSU.
constexpr acoustics::WaterSample kAssumed{10, 35};

SoundSpeedProfile load_profile(const CalcOptions& options, std::optional<SoundSpeedModel> model) {
  const SoundSpeedModel speed = model.value_or(SoundSpeedModel::kMackenzie1981);
  const std::string& name = options.profile;
  if (auto built_in = acoustics::built_in_profile(name.empty() ? "global-mean" : name, model, kAssumed))
    return *std::move(built_in);
  const double latitude = to_radians(require_in_range(options.latitude_deg, -90, 90, "latitude", "deg"));
  return acoustics::read_profile(name, {speed, latitude, kAssumed}, latitude,
                                 to_radians(options.longitude_deg));
}

using ProfileRowFunction =
    std::function<std::vector<double>(const SoundSpeedProfile&, const std::vector<double>&)>;

// Returns one form for each sound speed formula. Only an explicit --model overrides the formula that a
// profile prefers.
std::vector<QuantityForm> forms_by_speed(const std::vector<InputColumn>& inputs,
                                         const std::vector<std::string>& outputs,
                                         const ProfileRowFunction& function) {
  std::vector<QuantityForm> forms;
  for (const SoundSpeedModel model : acoustics::kSoundSpeedModels) {
    const auto prepare = [model, function](const CalcOptions& options) -> RowFunction {
      std::optional<SoundSpeedModel> chosen;
      if (!options.model.empty()) chosen = model;
      const auto profile = std::make_shared<const SoundSpeedProfile>(load_profile(options, chosen));
      return [profile, function](const std::vector<double>& v) { return function(*profile, v); };
    };
    forms.push_back({std::string(to_name(model)), inputs, outputs, prepare});
  }
  return forms;
}

Quantity delay() {
  return {"delay", "travel time along a straight slant path through a profile",
          forms_by_speed(
              {depth_column("depth_tx_m"), depth_column("depth_rx_m"), {{"horizontal_range_m"}, 0, 1e8, {}}},
              {"path_length_m", "delay_s", "mean_speed_m_per_s"},
              [](const SoundSpeedProfile& profile, const std::vector<double>& v) {
                const double length = elementary::hypot(v[2], v[1] - v[0]);
                return std::vector{length, profile.travel_time_s(v[0], v[1], length),
                                   profile.mean_sound_speed_mps(v[0], v[1])};
              })};
}

Quantity profile_speed() {
  return {"profile", "water, speed and horizontal delay of a profile at a depth",
          forms_by_speed({depth_column("depth_m"), or_else(range_column(), 1000)},
                         {"T_degC", "S_psu", "c_m_per_s", "delay_s"},
                         [](const SoundSpeedProfile& profile, const std::vector<double>& v) {
                           const acoustics::WaterSample water = profile.water(v[0]);
                           return std::vector{water.temperature_degc, water.salinity_psu,
                                              profile.sound_speed_mps(v[0]),
                                              profile.travel_time_s(v[0], v[0], v[1])};
                         })};
}

// Equation 1 as misprinted in the paper, with its T^2 and T^3 terms merged into one, for comparison only:
//   -5.304e-4 T^3  in place of  -5.304e-2 T^2 + 2.374e-4 T^3
double misprinted_speed_mps(const SoundSpeedProfile& mackenzie, double depth_m) {
  const double t = mackenzie.water(depth_m).temperature_degc;
  return mackenzie.sound_speed_mps(depth_m) + 5.304e-2 * t * t - (2.374e-4 + 5.304e-4) * t * t * t;
}

// Computes the curves of figure 4: for each profile in turn, speed and delay over `range_m` at equal depths.
RowFunction figure_4_row() {
  const auto mean = SoundSpeedProfile::global_mean(), s35 = SoundSpeedProfile::global_mean_of_salinity_35();
  const auto harris = SoundSpeedProfile::harris_zorzi();
  const auto harris_mackenzie = SoundSpeedProfile::harris_zorzi(SoundSpeedModel::kMackenzie1981);
  return [=](const std::vector<double>& v) {
    const double z = v[0], range = v[1];
    const auto water = mean.water(z);
    std::vector<double> row = {water.temperature_degc, water.salinity_psu};
    const auto add_speed = [&](double c) { row.insert(row.end(), {c, range / c}); };
    add_speed(mean.sound_speed_mps(z));
    add_speed(s35.sound_speed_mps(z));
    row.push_back(harris.water(z).temperature_degc);
    add_speed(harris.sound_speed_mps(z));
    add_speed(harris_mackenzie.sound_speed_mps(z));
    add_speed(acoustics::munk_sound_speed_mps(z));
    add_speed(misprinted_speed_mps(mean, z));
    return row;
  };
}

Quantity figure_4() {
  return {"figure-4",
          "delay between two nodes at equal depth, in every built-in profile",
          {{"mackenzie",
            {depth_column("depth_m"), or_else(range_column(), 1000)},
            {"T_woa98_degC", "S_woa98_psu", "c_mackenzie_woa98_m_per_s", "delay_woa98_s",
             "c_mackenzie_woa98_S35", "delay_woa98_S35_s", "T_harris_ns2_degC", "c_ns2_expr_harris",
             "delay_harris_s", "c_mackenzie_harris", "delay_mackenzie_harris_s", "c_munk", "delay_munk_s",
             "c_seed_misprint_woa98", "delay_seed_misprint_s"},
            [](const CalcOptions&) { return figure_4_row(); }}}};
}

// Computes a link; columns: low, high, shipping, wind, range, level, depth, directivity, spreading.
std::vector<double> link_row(acoustics::Environment sea, const std::vector<double>& v) {
  sea.noise = {v[2], v[3]};
  sea.spreading_exponent = v[8];
  acoustics::Modem modem;
  modem.source_level = {v[5]};
  modem.centre_frequency_hz = khz_to_hz((v[0] + v[1]) / 2);
  modem.bandwidth_hz = khz_to_hz(v[1] - v[0]);
  modem.directivity_index = {v[7]};
  const acoustics::LinkBudget link = link_budget(sea, modem, modem, {0, 0, v[6]}, {v[4], 0, v[6]});
  return {link.absorption_db_per_km, link.transmission_loss.value,
          link.received_level.value, link.snr_narrowband.value,
          link.capacity_bps,         link.snr.value,
          link.noise_level.value,    link.delay_s};
}

Quantity link() {
  const std::vector<InputColumn> inputs = {frequency_column("f_lo_kHz"),
                                           frequency_column("f_hi_kHz"),
                                           shipping_column(),
                                           wind_column(),
                                           range_column(),
                                           source_level_column(),
                                           or_else(depth_column("depth_m"), 100),
                                           {{"DI_dB"}, 0, 40, 0},
                                           spreading_column()};
  const std::vector<std::string> outputs = {"alpha_fc_dB_per_km", "TL_fc_dB",        "Prx_fc_dB_re_1uPa",
                                            "SNR_eq7_dB",         "C_eq8_bit_per_s", "SNR_band_dB",
                                            "N_band_dB_re_1uPa",  "delay_s"};
  Quantity quantity{"link", "a link at one depth of a profile: the columns of figures 6 and 7", {}};
  for (const AbsorptionModel model : acoustics::kAbsorptionModels) {
    const auto prepare = [model](const CalcOptions& options) -> RowFunction {
      acoustics::Environment sea;
      sea.profile = load_profile(options, std::nullopt);
      sea.absorption_model = model;
      sea.latitude_rad = to_radians(options.latitude_deg);
      return [sea](const std::vector<double>& v) { return link_row(sea, v); };
    };
    quantity.forms.push_back({std::string(to_name(model)), inputs, outputs, prepare});
  }
  return quantity;
}

}  // namespace

std::vector<Quantity> delay_quantities() { return {delay(), profile_speed(), figure_4(), link()}; }

}  // namespace halocline::clients
