// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/messages/scenario_messages.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>

#include "channel_server/vehicles/modem_schedule.h"
#include "core/text/utf8.h"

namespace halocline::channel_server {
namespace {

scenario_vehicle_t to_message(const bus::VehicleEntry& vehicle, const VehicleModem& modem) {
  scenario_vehicle_t message{};
  message.vehicle_name = vehicle.name;
  message.vehicle_id = vehicle.id;
  message.moved_by = vehicle.model == "external" ? scenario_vehicle_t::EXTERNAL
                     : vehicle.model == "fixed"  ? scenario_vehicle_t::FIXED
                                                 : scenario_vehicle_t::MOVED;
  message.vehicle_model = vehicle.model.given();
  std::copy(vehicle.start_ned_m.begin(), vehicle.start_ned_m.end(), message.start_ned_m);
  message.start_heading_rad = std::remainder(vehicle.heading_rad, 2 * std::numbers::pi);
  message.modem_family = modem.modem.family;
  message.framing_profile = modem.profile.given();
  message.source_level_db = modem.modem.source_level.value;
  message.center_frequency_hz = modem.modem.centre_frequency_hz;
  message.bandwidth_hz = modem.modem.bandwidth_hz;
  message.bit_rate_bps = modem.modem.bit_rate_bps;
  return message;
}

scenario_info_t common_part(const bus::Scenario& scenario) {
  scenario_info_t message{};
  message.scenario_name = beginning_of(scenario.name, 200);
  message.description = beginning_of(scenario.description, 1000);
  message.scenario_seed = static_cast<std::int64_t>(scenario.seed);
  message.run_duration_s = scenario.duration.seconds();
  message.origin_latitude_deg = scenario.origin_latitude_deg;
  message.origin_longitude_deg = scenario.origin_longitude_deg;
  message.sea_surface_z_m = scenario.sea_surface_z_m;
  return message;
}

// Divides the configuration into the lines of each part.
std::vector<std::vector<std::string>> shares_of(const std::string& configuration) {
  std::vector<std::vector<std::string>> shares(1);
  std::size_t bytes = 0;
  std::istringstream text(configuration);
  for (std::string line; std::getline(text, line);) {
    if (bytes > 0 && bytes + line.size() > kMaxLineBytesOfPart) {
      shares.emplace_back();
      bytes = 0;
    }
    bytes += line.size() + 5;  // LCM adds 4 bytes of length before a string and a zero after it
    shares.back().push_back(std::move(line));
  }
  return shares;
}

}  // namespace

std::vector<scenario_info_t> to_messages(const bus::Scenario& scenario, const ConfiguredModems& modems) {
  const std::size_t of_vehicles = (scenario.vehicles.size() + kMaxVehiclesOfPart - 1) / kMaxVehiclesOfPart;
  std::vector<std::vector<std::string>> shares = shares_of(scenario.configuration);
  shares.resize(std::max(shares.size(), of_vehicles));
  std::vector<scenario_info_t> parts;
  for (std::size_t part = 0; part < shares.size(); ++part) {
    scenario_info_t message = common_part(scenario);
    message.part_number = static_cast<std::int32_t>(part);
    message.part_count = static_cast<std::int32_t>(shares.size());
    const std::size_t end = std::min((part + 1) * kMaxVehiclesOfPart, scenario.vehicles.size());
    for (std::size_t i = part * kMaxVehiclesOfPart; i < end; ++i)
      message.vehicles.push_back(to_message(scenario.vehicles[i], modems.of(scenario.vehicles[i].name)));
    message.num_vehicles = static_cast<std::int32_t>(message.vehicles.size());
    message.configuration_line = std::move(shares[part]);
    message.num_lines = static_cast<std::int32_t>(message.configuration_line.size());
    parts.push_back(std::move(message));
  }
  return parts;
}

}  // namespace halocline::channel_server
