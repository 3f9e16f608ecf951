// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/scenario_checks.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

#include "acoustics/modem/modem.h"
#include "bus/config/scenario.h"
#include "bus/messages/messages.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_framing.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "clients/onboard/autopilot/autopilot_config.h"
#include "clients/onboard/autopilot/formation.h"
#include "clients/onboard/localiser/localiser_config.h"
#include "clients/onboard/traffic/traffic_config.h"
#include "core/check.h"
#include "core/csv_table.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "ocean/ocean_field.h"
#include "ocean/ocean_field_reader.h"
#include "vehicle_sim/fleet.h"
#include "vehicle_sim/vehicle_sim_config.h"

namespace halocline::clients {
namespace {

// Source of packets: the section that configures it, and the packets that it sends.
struct PacketSource {
  std::string section, size_key;
  SimDuration period;
  std::size_t payload_bytes;
  std::int8_t kind = modem_send_t::DATA;
  std::int32_t rate = -1;
};

channel_server::Framing framing_of(const PacketSource& source, const channel_server::VehicleModem& modem) {
  channel_server::SendRequest request;
  request.payload.resize(source.payload_bytes);
  request.kind = static_cast<channel_server::PacketKind>(source.kind);
  if (source.rate >= 0) request.rate_number = source.rate;
  return channel_server::framing_of(modem, request);
}

void check_packets(std::size_t i, const PacketSource& source, const channel_server::VehicleModem& modem,
                   bus::ConfigFile& file) {
  if (source.period <= SimDuration()) return;
  const channel_server::Framing framing = framing_of(source, modem);
  const std::string bytes = std::to_string(source.payload_bytes);
  using channel_server::SendResult;
  if (framing.problem == SendResult::kNoRate)
    return file.refuse(key_of(i, source.section + ".rate"), std::to_string(source.rate),
                       "allowed is -1, or the number of a rate of this vehicle's modem");
  if (framing.problem == SendResult::kNoKind)
    return file.refuse(key_of(i, source.section + ".kind"), std::to_string(source.kind),
                       "this vehicle's modem has no packets of this kind, or not at this rate");
  if (framing.problem != SendResult::kAccepted) {
    const std::size_t most = channel_server::largest_payload_bytes(modem);
    return file.refuse(key_of(i, source.section + source.size_key), bytes,
                       "its packets have " + bytes +
                           " bytes; allowed with this vehicle's modem are at most " +
                           (source.rate < 0 ? std::to_string(most) : "those of the rate"));
  }
  const double duration_s = framing.timing.duration.seconds();
  if (duration_s <= source.period.seconds()) return;
  file.warn(key_of(i, source.section + ".period_s"), format_number(source.period.seconds()),
            "a packet of " + bytes + " bytes lasts " + format_number(rounded_down(duration_s)) +
                " s with this vehicle's modem, so packets are refused");
}

void check_modems(const ScenarioConfig& config, bus::ConfigFile& file) {
  for (std::size_t i = 0; i < config.scenario.vehicles.size(); ++i) {
    const channel_server::VehicleModem& modem = modem_of(config, i);
    const VehicleTraffic& traffic = config.traffic.vehicles.at(i);
    check_packets(
        i, {"traffic", ".payload_bytes", traffic.period, traffic.packet_bytes(), traffic.kind, traffic.rate},
        modem, file);
    check_packets(
        i, {"mission.broadcast", ".period_s", config.autopilot.vehicles.at(i).broadcast.period, kReportBytes},
        modem, file);
  }
}

// Checks that relays carry the largest packets that they pass on, and that packets with hops find a relay.
void check_relays(const ScenarioConfig& config, bus::ConfigFile& file) {
  std::size_t largest = 0;
  bool has_relay = false;
  for (const VehicleTraffic& traffic : config.traffic.vehicles) {
    has_relay = has_relay || traffic.relay.passes_on;
    if (traffic.is_relayed() && traffic.period > SimDuration())
      largest = std::max(largest, traffic.packet_bytes());
  }
  for (std::size_t i = 0; i < config.traffic.vehicles.size(); ++i) {
    const VehicleTraffic& traffic = config.traffic.vehicles[i];
    const std::size_t most = largest_payload_bytes(modem_of(config, i));
    if (traffic.relay.passes_on && most < largest)
      file.refuse(key_of(i, "traffic.relay"), "true",
                  "packets that are passed on have up to " + std::to_string(largest) +
                      " bytes with their header, and its modem takes " + std::to_string(most));
    if (traffic.is_relayed() && !has_relay)
      file.warn(key_of(i, "traffic.hops"), std::to_string(traffic.relay.hops),
                "no vehicle has relay = true, so none passes its packets on");
  }
}

// Refuses the key when `attempt` throws InvalidArgument, with the message of the exception.
template <class Attempt>
void refuse_if_thrown(bus::ConfigFile& file, const std::string& key, const std::string& value,
                      const Attempt& attempt) {
  try {
    attempt();
  } catch (const InvalidArgument& error) {
    file.refuse(key, value, error.what());
  }
}

// Checks the vehicle names in faults, tethers and other vehicles.
void check_names(const ScenarioConfig& config, bus::ConfigFile& file) {
  const auto members = vehicle_sim::members_of(config.scenario, config.vehicle_sim);
  vehicle_sim::VehicleSimConfig one = config.vehicle_sim;
  one.tethers.clear();
  for (std::size_t i = 0; i < config.vehicle_sim.faults.size(); ++i) {
    one.faults = {config.vehicle_sim.faults[i]};
    refuse_if_thrown(file, "fault." + std::to_string(i) + ".vehicle", one.faults[0].vehicle,
                     [&] { vehicle_sim::faults_of(members, one); });
  }
  for (std::size_t i = 0; i < config.vehicle_sim.tethers.size(); ++i) {
    one.tethers = {config.vehicle_sim.tethers[i]};
    refuse_if_thrown(file, "tether." + std::to_string(i) + ".vehicle", one.tethers[0].vehicle,
                     [&] { settings_of(config.scenario, one); });
  }
  for (std::size_t i = 0; i < config.scenario.vehicles.size(); ++i) {
    const PilotConfig& pilot = config.autopilot.vehicles.at(i);
    refuse_if_thrown(file, key_of(i, "mission.navigator.usbl_beacons"), pilot.usbl_beacons,
                     [&] { beacons_of(config.autopilot, pilot); });
    const VehicleLocaliser& localiser = config.localiser.vehicles.at(i);
    refuse_if_thrown(file, key_of(i, "localiser.beacons"), localiser.beacons,
                     [&] { beacons_of(config.localiser, localiser); });
  }
}

// Checks the ocean file. Returns false when it is refused; other checks need not read it then.
bool check_ocean(const ScenarioConfig& config, bus::ConfigFile& file) {
  const bus::OceanEntry& entry = config.scenario.ocean;
  if (entry.file.empty()) return true;
  try {
    const auto field = ocean::read_ocean_field({entry.file.place(),
                                                entry.start_date,
                                                {to_radians(config.scenario.origin_latitude_deg),
                                                 to_radians(config.scenario.origin_longitude_deg)}});
    make_environment(config.channel_server.environment, config.scenario);
    for (const std::string& remark : field->remarks()) file.warn("ocean.file", entry.file.given(), remark);
    const double last_s = field->grid().times_s.back();
    if (!field->is_steady() && config.scenario.duration.seconds() > last_s) {
      file.warn("ocean.file", entry.file.given(),
                "its last time is " + format_number(last_s) +
                    " s after the start: the ocean stays so from then on");
    }
    for (std::size_t i = 0; i < config.scenario.vehicles.size(); ++i) {
      const Vec3& start = config.scenario.vehicles[i].start_ned_m;
      if (!field->covers(start.x(), start.y()))
        file.warn(key_of(i, "start_ned_m"), "", "the ocean is not known there: the nearest column is used");
    }
    return true;
  } catch (const InvalidArgument& error) {
    file.refuse("ocean.file", entry.file.given(), error.what());
    return false;
  }
}

// Warns of unknown names only: external vehicles have no entry in the scenario, so a name may be valid.
void check_extra_loss(const ScenarioConfig& config, bus::ConfigFile& file) {
  const auto& losses = config.channel_server.rules.medium.extra_loss;
  for (std::size_t i = 0; i < losses.size(); ++i) {
    for (const auto& [key, name] : {std::pair("from", losses[i].from), {"to", losses[i].to}}) {
      if (!name.empty() && config.scenario.find(name) == nullptr)
        file.warn("extra_loss." + std::to_string(i) + "." + key, name,
                  "the scenario has no vehicle of that name");
    }
  }
}

void check_profile(const ScenarioConfig& config, bus::ConfigFile& file) {
  const channel_server::ProfileConfig& profile = config.channel_server.environment.profile;
  if (profile.source != channel_server::ProfileSource::kFile) return;
  refuse_if_thrown(file, "environment.profile_file", profile.file.given(),
                   [&] { make_environment(config.channel_server.environment, config.scenario); });
}

}  // namespace

const channel_server::VehicleModem& modem_of(const ScenarioConfig& config, std::size_t vehicle) {
  const auto& own = config.channel_server.vehicles.at(vehicle);
  return own.has_modem ? own.modem : config.channel_server.modem;
}

void check_water(const ScenarioConfig& config, bus::ConfigFile& file) {
  if (!check_ocean(config, file)) return;
  check_names(config, file);
  check_extra_loss(config, file);
  check_profile(config, file);
}

void check_missions(const ScenarioConfig& config, bus::ConfigFile& file) {
  check_modems(config, file);
  check_relays(config, file);
  check_network(config, file);
  check_pilots(config, file);
  check_intent(config, file);
}

}  // namespace halocline::clients
