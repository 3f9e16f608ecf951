#include "channel_server/environment_messages.h"

#include "core/check.h"

namespace halocline::channel_server {
namespace {

acoustics::SoundSpeedProfile profile_in(const environment_change_t& m, const acoustics::Environment& before) {
  require(!m.layer_depth_m.empty(), "a profile needs at least one layer");
  std::vector<acoustics::WaterRow> water;
  std::vector<acoustics::SpeedRow> speeds;
  for (std::size_t i = 0; i < m.layer_depth_m.size(); ++i) {
    water.push_back({m.layer_depth_m[i], m.layer_temperature_degc[i], m.layer_salinity_psu[i]});
    speeds.push_back({m.layer_depth_m[i], m.layer_sound_speed_mps[i]});
  }
  using Profile = acoustics::SoundSpeedProfile;
  if (m.profile_set == environment_change_t::PROFILE_SPEED) {
    return Profile::from_speeds(std::move(speeds), {m.layer_temperature_degc[0], m.layer_salinity_psu[0]});
  }
  return Profile::from_water(std::move(water), before.profile.model(), before.latitude_rad);
}

constexpr double kFormulaStepM = 100, kFormulaDepthM = 5000;
constexpr std::size_t kMaxLayers = 2000;  // environment_t

std::vector<double> depths_to_publish(const acoustics::SoundSpeedProfile& profile) {
  const std::vector<double> rows = profile.row_depths_m();
  const std::size_t stride = rows.size() / kMaxLayers + 1;
  std::vector<double> depths;
  for (std::size_t i = 0; i < rows.size(); i += stride) depths.push_back(rows[i]);
  if (!depths.empty()) return depths;
  for (double depth = 0; depth <= kFormulaDepthM; depth += kFormulaStepM) depths.push_back(depth);
  return depths;
}

}  // namespace

environment_t to_message(const acoustics::Environment& environment, const WaterDescription& description,
                         SimTime from, const std::string& terrain_version) {
  environment_t message{};
  message.utime = from.to_utime();
  for (const double depth_m : depths_to_publish(environment.profile)) {
    const acoustics::WaterSample water = environment.profile.water(depth_m);
    message.layer_depth_m.push_back(depth_m);
    message.layer_sound_speed_mps.push_back(environment.profile.sound_speed_mps(depth_m));
    message.layer_temperature_degc.push_back(water.temperature_degc);
    message.layer_salinity_psu.push_back(water.salinity_psu);
  }
  message.num_layers = static_cast<std::int32_t>(message.layer_depth_m.size());
  message.wind_speed_mps = environment.noise.wind_mps;
  message.shipping_activity = environment.noise.shipping;
  message.acidity_ph = environment.ph;
  message.sea_surface_z_m = environment.sea_surface_z_m;
  message.spreading_exponent = environment.spreading_exponent;
  message.sound_speed_model = to_name(environment.profile.model());
  message.absorption_model = to_name(environment.absorption_model);
  message.propagation_model = description.propagation;
  if (description.surface) message.surface_model = to_name(*description.surface);
  if (description.bottom) {
    message.bottom_density_ratio = description.bottom->density_ratio;
    message.bottom_sound_speed_ratio = description.bottom->sound_speed_ratio;
    message.bottom_sound_speed_mps = description.bottom->sound_speed_mps;
    message.bottom_loss_parameter = description.bottom->loss_parameter;
  }
  message.terrain_version = terrain_version;
  return message;
}

EnvironmentChange to_change(const environment_change_t& message, const acoustics::Environment& before) {
  EnvironmentChange change;
  if (message.sets_wind != 0) change.wind_mps = message.wind_speed_mps;
  if (message.sets_shipping != 0) change.shipping = message.shipping_activity;
  if (message.sets_sea_surface != 0) change.sea_surface_z_m = message.sea_surface_z_m;
  if (message.profile_set != environment_change_t::PROFILE_UNCHANGED) {
    change.profile = profile_in(message, before);
  }
  return change;
}

}  // namespace halocline::channel_server
