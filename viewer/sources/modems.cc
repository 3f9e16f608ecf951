// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/sources/modems.h"

#include <algorithm>
#include <cstddef>

#include "acoustics/modem/half_delivery.h"
#include "bus/config/config.h"
#include "bus/messages/channels.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/messages/world_messages.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "core/check.h"
#include "core/names.h"

namespace halocline::monitor {
namespace {

std::optional<double> threshold_of(const modem_config_t& message) try {
  constexpr std::size_t kPayload = 32;
  const auto modem = channel_server::to_modem(message);
  const auto most = static_cast<std::size_t>(std::max(modem.max_payload_bytes, 0));
  const auto threshold = acoustics::half_delivery_sinr(modem.modem, std::min(kPayload, most));
  return threshold ? std::optional(threshold->value) : std::nullopt;
} catch (const InvalidArgument&) {
  return std::nullopt;
}

}  // namespace

modem_config_t modem_message(const channel_server::VehicleModem& modem, SimTime from) {
  channel_server::VehicleModem shown = modem;
  if (!is_valid_name(modem.profile.given())) shown.profile = channel_server::kGenericProfile;
  return channel_server::to_message(shown, from);
}

std::vector<BusMessage> modems_in(const std::string& configuration, std::span<const std::string> vehicles,
                                  SimTime from) try {
  auto file = bus::ConfigFile::parse(configuration, "SCENARIO");
  channel_server::ChannelServerConfig config;
  file.read([&](bus::ConfigVisitor& v) { channel_server::visit(v, config); });
  file.check(/*whole_file=*/false);
  const auto modems = channel_server::make_modems(config);
  std::vector<BusMessage> messages;
  for (const std::string& vehicle : vehicles)
    messages.push_back({from.to_utime(), bus::channels::kModem.of(vehicle),
                        bus::encoded(modem_message(modems.of(vehicle), from))});
  return messages;
} catch (const InvalidArgument&) {
  return {};
}

std::optional<double> ModemThresholds::of(const modem_config_t& modem) {
  modem_config_t timeless = modem;
  timeless.utime = 0;
  const auto [place, is_new] = known_.try_emplace(bus::encoded(timeless));
  if (is_new) place->second = threshold_of(modem);
  return place->second;
}

}  // namespace halocline::monitor
