#include "channel_server/vehicle_messages.h"

#include <string>

#include "channel_server/modems/modem_config.h"
#include "core/check.h"

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

// The profile that the message names.
std::string profile_in(const modem_config_t& message) {
  switch (message.modem_profile) {
    case modem_config_t::PROFILE_GENERIC:
      return kGenericProfile;
    case modem_config_t::PROFILE_JANUS:
      return "janus";
    case modem_config_t::PROFILE_MICROMODEM_FSK:
      return "micromodem-fsk";
    case modem_config_t::PROFILE_MICROMODEM_PSK:
      return "micromodem-psk-" + std::to_string(message.psk_rate);
  }
  throw InvalidArgument("modem_profile is no value of its enumeration");
}

void set_profile(const std::string& profile, modem_config_t& message) {
  for (const std::int8_t number :
       {modem_config_t::PROFILE_GENERIC, modem_config_t::PROFILE_JANUS,
        modem_config_t::PROFILE_MICROMODEM_FSK, modem_config_t::PROFILE_MICROMODEM_PSK}) {
    message.modem_profile = number;
    const bool has_rates = number == modem_config_t::PROFILE_MICROMODEM_PSK;
    for (message.psk_rate = has_rates ? 1 : 0; message.psk_rate <= (has_rates ? 5 : 0); ++message.psk_rate) {
      if (profile_in(message) == profile) return;
    }
  }
  throw InvalidArgument("modem profile '" + profile + "' has no number in modem_config_t");
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
  const VehicleModem profile = load_modem(profile_in(message));
  VehicleModem modem = profile;
  modem.modem.source_level = {message.source_level_db};
  modem.modem.min_receivable_level = {message.cutoff_level_db};
  modem.modem.centre_frequency_hz = message.center_frequency_hz;
  modem.modem.bandwidth_hz = message.bandwidth_hz;
  modem.modem.directivity_index = {message.directivity_index_db};
  modem.modem.bit_rate_bps = message.bit_rate_bps;
  modem.modem.packet_overhead = SimDuration::from_seconds(message.packet_overhead_s);
  modem.modem.preamble = SimDuration::from_seconds(message.preamble_s);
  modem.modem.guard_time = SimDuration::from_seconds(message.guard_time_s);
  modem.modem.doppler_tolerance = message.doppler_tolerance;
  modem.modem.error_model = static_cast<acoustics::ErrorModel>(message.error_model);
  modem.modem.beam = beam_in(message);
  modem.max_payload_bytes = message.max_payload_bytes;
  modem.when_busy = static_cast<WhenBusy>(message.when_busy);
  validate(modem.modem);
  if (profile.profile != kGenericProfile) require_packets_of(profile, modem.modem);
  return modem;
}

modem_config_t to_message(const VehicleModem& modem, SimTime from) {
  modem_config_t message{};
  message.utime = from.to_utime();
  message.source_level_db = modem.modem.source_level.value;
  message.cutoff_level_db = modem.modem.min_receivable_level.value;
  message.center_frequency_hz = modem.modem.centre_frequency_hz;
  message.bandwidth_hz = modem.modem.bandwidth_hz;
  message.directivity_index_db = modem.modem.directivity_index.value;
  message.bit_rate_bps = modem.modem.bit_rate_bps;
  message.packet_overhead_s = modem.modem.packet_overhead.seconds();
  message.max_payload_bytes = modem.max_payload_bytes;
  set_profile(modem.profile, message);
  message.preamble_s = modem.modem.preamble.seconds();
  message.guard_time_s = modem.modem.guard_time.seconds();
  message.doppler_tolerance = modem.modem.doppler_tolerance;
  message.error_model = static_cast<std::int8_t>(modem.modem.error_model);
  message.when_busy = static_cast<std::int8_t>(modem.when_busy);
  message.num_beam_rows = static_cast<std::int32_t>(modem.modem.beam.rows().size());
  for (const acoustics::BeamRow& row : modem.modem.beam.rows()) {
    message.beam_elevation_rad.push_back(row.elevation_rad);
    message.beam_loss_db.push_back(row.loss_db);
  }
  return message;
}

}  // namespace halocline::channel_server
