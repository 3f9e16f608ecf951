// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/messages/world_messages.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "acoustics/modem/beam_pattern.h"
#include "acoustics/modem/error_model.h"
#include "acoustics/modem/receiver_kind.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "channel_server/modems/modem_config.h"
#include "core/check.h"
#include "core/frames.h"
#include "core/names.h"

namespace halocline::channel_server {
namespace {

Vec3 to_vec3(const double (&values)[3]) { return {values[0], values[1], values[2]}; }

acoustics::BeamPattern beam_in(const modem_config_t& message) {
  std::vector<acoustics::BeamRow> rows;
  for (std::size_t i = 0; i < message.beam_elevation_rad.size(); ++i) {
    rows.push_back({message.beam_elevation_rad[i], message.beam_loss_db[i]});
  }
  return rows.empty() ? acoustics::BeamPattern() : acoustics::BeamPattern(std::move(rows));
}

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
constexpr std::size_t kMaxLayers = 2000;  // bound of environment_t

std::vector<double> depths_to_publish(const acoustics::SoundSpeedProfile& profile) {
  const std::vector<double> rows = profile.row_depths_m();
  const std::size_t stride = (rows.size() + kMaxLayers - 1) / kMaxLayers;
  std::vector<double> depths;
  for (std::size_t i = 0; i < rows.size(); i += stride) depths.push_back(rows[i]);
  if (!depths.empty()) return depths;
  for (double depth = 0; depth <= kFormulaDepthM; depth += kFormulaStepM) depths.push_back(depth);
  return depths;
}

}  // namespace

StampedState to_state(const vehicle_state_t& message) {
  return {SimTime::from_utime(message.utime), to_vec3(message.position_ned_m),
          to_vec3(message.velocity_ned_mps)};
}

VehicleModem to_modem(const modem_config_t& message) {
  require(message.error_model >= 0 &&
              static_cast<std::size_t>(message.error_model) < acoustics::kErrorModels.size(),
          "error_model is no value of its enumeration");
  require(message.receiver_kind >= 0 &&
              static_cast<std::size_t>(message.receiver_kind) < acoustics::kReceiverKinds.size(),
          "receiver_kind is no value of its enumeration");
  const VehicleModem profile = load_modem(message.modem_profile);
  VehicleModem modem = profile;
  modem.modem.family = message.family;
  modem.modem.source_level = {message.source_level_db};
  modem.modem.min_receivable_level = {message.cutoff_level_db};
  modem.modem.centre_frequency_hz = message.center_frequency_hz;
  modem.modem.bandwidth_hz = message.bandwidth_hz;
  modem.modem.directivity_index = {message.directivity_index_db};
  modem.modem.bit_rate_bps = message.bit_rate_bps;
  modem.modem.packet_overhead = SimDuration::from_seconds(message.packet_overhead_s);
  modem.modem.preamble = SimDuration::from_seconds(message.preamble_s);
  modem.modem.guard_time = SimDuration::from_seconds(message.guard_time_s);
  modem.modem.guard_taper = taper_from(message.guard_taper_s);
  modem.modem.chip = SimDuration::from_seconds(message.chip_s);
  modem.modem.hop_count = message.hop_count;
  modem.modem.hop_clearing = SimDuration::from_seconds(message.hop_clearing_s);
  modem.modem.doppler_tolerance = message.doppler_tolerance;
  modem.modem.doppler_correction = message.doppler_correction;
  modem.modem.time_quantum = SimDuration::from_seconds(message.time_quantum_s);
  modem.modem.error_model = static_cast<acoustics::ErrorModel>(message.error_model);
  if (message.receiver_channels > 0) {
    modem.modem.receiver = static_cast<acoustics::ReceiverKind>(message.receiver_kind);
    modem.modem.receiver_loss = {message.receiver_loss_db};
    modem.modem.receiver_channels = message.receiver_channels;
    modem.modem.late_echo_share = message.late_echo_share;
    modem.modem.echo_cancelled = message.echo_cancelled;
    modem.modem.impulse_loss = {message.impulse_loss_db};
  }
  modem.modem.beam = beam_in(message);
  modem.max_payload_bytes = message.max_payload_bytes;
  modem.when_busy = static_cast<WhenBusy>(message.when_busy);
  validate(modem.modem);
  if (profile.profile != kGenericProfile) set_rates_of(profile, modem);
  return modem;
}

Listening to_listening(const modem_listen_t& message) {
  Listening listening;
  listening.asleep = message.asleep != 0;
  if (message.wake_utime != 0) listening.wakes = SimTime::from_utime(message.wake_utime);
  listening.promiscuous = message.promiscuous != 0;
  listening.events = message.events != 0;
  listening.carrier_threshold = {message.carrier_threshold_db};
  return listening;
}

modem_config_t to_message(const VehicleModem& modem, SimTime from) {
  modem_config_t message{};
  message.utime = from.to_utime();
  message.family = modem.modem.family;
  message.source_level_db = modem.modem.source_level.value;
  message.cutoff_level_db = modem.modem.min_receivable_level.value;
  message.center_frequency_hz = modem.modem.centre_frequency_hz;
  message.bandwidth_hz = modem.modem.bandwidth_hz;
  message.directivity_index_db = modem.modem.directivity_index.value;
  message.bit_rate_bps = modem.modem.bit_rate_bps;
  message.packet_overhead_s = modem.modem.packet_overhead.seconds();
  message.max_payload_bytes = modem.max_payload_bytes;
  require(is_valid_name(modem.profile.given()),
          "modem profile '" + modem.profile.given() + "' is a file, which modem_config_t cannot name");
  message.modem_profile = modem.profile.given();
  message.preamble_s = modem.modem.preamble.seconds();
  message.guard_time_s = modem.modem.guard_time.seconds();
  message.guard_taper_s = seconds_of(modem.modem.guard_taper);
  message.chip_s = modem.modem.chip.seconds();
  message.hop_count = modem.modem.hop_count;
  message.hop_clearing_s = modem.modem.hop_clearing.seconds();
  message.doppler_tolerance = modem.modem.doppler_tolerance;
  message.doppler_correction = modem.modem.doppler_correction;
  message.time_quantum_s = modem.modem.time_quantum.seconds();
  message.error_model = static_cast<std::int8_t>(modem.modem.error_model);
  message.receiver_kind = static_cast<std::int8_t>(modem.modem.receiver);
  message.receiver_loss_db = modem.modem.receiver_loss.value;
  message.receiver_channels = modem.modem.receiver_channels;
  message.late_echo_share = modem.modem.late_echo_share;
  message.echo_cancelled = modem.modem.echo_cancelled;
  message.impulse_loss_db = modem.modem.impulse_loss.value;
  message.when_busy = static_cast<std::int8_t>(modem.when_busy);
  message.num_beam_rows = static_cast<std::int32_t>(modem.modem.beam.rows().size());
  for (const acoustics::BeamRow& row : modem.modem.beam.rows()) {
    message.beam_elevation_rad.push_back(row.elevation_rad);
    message.beam_loss_db.push_back(row.loss_db);
  }
  return message;
}

double turn_rate_hz(const vehicle_sensors_t& sensors) {
  double fastest_rpm = std::abs(sensors.shaft_rpm);
  for (const double rpm : sensors.thruster_rpm) fastest_rpm = std::max(fastest_rpm, std::abs(rpm));
  return fastest_rpm / 60;
}

environment_t to_message(const acoustics::Environment& environment, const WaterDescription& description,
                         SimTime from, const std::string& terrain_version) {
  environment_t message{};
  message.utime = from.to_utime();
  // Published is the mean over the drift of hours, which nobody aboard knows.
  const acoustics::SoundSpeedProfile profile =
      environment.drift.any() ? environment.profile.without_change() : environment.profile;
  for (const double depth_m : depths_to_publish(profile)) {
    const acoustics::WaterSample water = profile.water(depth_m);
    message.layer_depth_m.push_back(depth_m);
    message.layer_sound_speed_mps.push_back(profile.sound_speed_mps(depth_m));
    message.layer_temperature_degc.push_back(water.temperature_degc);
    message.layer_salinity_psu.push_back(water.salinity_psu);
  }
  message.num_layers = static_cast<std::int32_t>(message.layer_depth_m.size());
  message.wind_speed_mps = environment.noise.wind_mps;
  message.shipping_activity = environment.noise.shipping;
  message.rain_mm_per_h = environment.noise.rain_mm_per_h;
  message.noise_from_table = environment.noise.table ? 1 : 0;
  message.noise_place = environment.noise.site ? "measured" : to_name(environment.noise.place);
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
  if (message.sets_rain != 0) change.rain_mm_per_h = message.rain_mm_per_h;
  if (message.sets_sea_surface != 0) change.sea_surface_z_m = message.sea_surface_z_m;
  if (message.profile_set != environment_change_t::PROFILE_UNCHANGED) {
    change.profile = profile_in(message, before);
  }
  return change;
}

}  // namespace halocline::channel_server
