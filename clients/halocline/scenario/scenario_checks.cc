#include "clients/halocline/scenario/scenario_checks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "acoustics/modem/modem.h"
#include "bus/messages.h"
#include "bus/runtime/scenario.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_framing.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "clients/autopilot/autopilot_config.h"
#include "clients/autopilot/formation.h"
#include "clients/autopilot/plan.h"
#include "clients/halocline/scenario/speed_trial.h"
#include "clients/localiser/localiser_config.h"
#include "clients/traffic/traffic_config.h"
#include "core/check.h"
#include "core/csv_table.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "ocean/ocean_field.h"
#include "ocean/ocean_field_reader.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/fleet.h"
#include "vehicle_sim/vehicle_sim_config.h"

namespace halocline::clients {
namespace {

std::string key_of(std::size_t vehicle, const std::string& key) {
  return "vehicle." + std::to_string(vehicle) + "." + key;
}

double rounded_down(double value) { return std::floor(100 * value) / 100; }

const channel_server::VehicleModem& modem_of(const ScenarioConfig& config, std::size_t vehicle) {
  const auto& own = config.channel_server.vehicles.at(vehicle);
  return own.has_modem ? own.modem : config.channel_server.modem;
}

// A source of packets: the section that says so, and what it sends.
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

// A relay passes on whole packets, and packets with hops need one.
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

// Trials are made once for vehicles of one kind.
class SpeedJudge {
 public:
  SpeedJudge(const ScenarioConfig& config, bus::ConfigFile& file) : config_(config), file_(file) {}

  void check(std::size_t i, const vehicle_sim::Model& model) {
    const PilotConfig& pilot = config_.autopilot.vehicles.at(i);
    bool uses_mission_speed = pilot.behaviours.empty();
    for (std::size_t k = 0; k < pilot.behaviours.size(); ++k) {
      const double speed = pilot.behaviours[k].speed_mps;
      uses_mission_speed = uses_mission_speed || speed <= 0;
      if (speed > 0)
        check(key_of(i, "mission.behaviour." + std::to_string(k) + ".speed_mps"), speed, model, pilot);
    }
    if (uses_mission_speed) check(key_of(i, "mission.speed_mps"), pilot.mission.speed_mps, model, pilot);
  }

 private:
  void check(const std::string& key, double speed_mps, const vehicle_sim::Model& model,
             const PilotConfig& pilot) {
    const double held = held_speed(speed_mps, model, pilot);
    if (held < speed_mps)
      file_.refuse(key, format_number(speed_mps),
                   "allowed is at most " + format_number(rounded_down(held)) + " m/s, which " + model.name() +
                       " holds at its depth in still water");
  }

  // The set speed where it is held, else the greatest below it that is.
  double held_speed(double speed_mps, const vehicle_sim::Model& model, const PilotConfig& pilot) {
    const auto bytes_of = [](const auto& gains) {
      return std::string(reinterpret_cast<const char*>(&gains), sizeof gains);
    };
    const bool by_thrusters = pilot.steering == Steering::kThrusters;
    const auto [known, is_new] = held_.try_emplace(
        {&model, speed_mps, by_thrusters ? bytes_of(pilot.hover_gains) : bytes_of(pilot.gains)}, speed_mps);
    if (!is_new || holds(speed_mps, model, pilot)) return known->second;
    constexpr int kHalvings = 8;
    double held = 0, not_held = speed_mps;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (held + not_held);
      (holds(middle, model, pilot) ? held : not_held) = middle;
    }
    return known->second = held;
  }

  bool holds(double speed_mps, const vehicle_sim::Model& model, const PilotConfig& pilot) const {
    constexpr double kSlower = 0.05, kFarthestOff_m = 1;
    const SpeedTrial trial = try_speed(model, pilot, config_.autopilot.command_period, speed_mps);
    const bool keeps_depth = pilot.steering == Steering::kFins || trial.depth_error_m < kFarthestOff_m;
    return keeps_depth && trial.speed_mps > (1 - kSlower) * speed_mps;
  }

  const ScenarioConfig& config_;
  bus::ConfigFile& file_;
  std::map<std::tuple<const vehicle_sim::Model*, double, std::string>, double> held_;
};

const char* to_text(Steering steering) {
  return steering == Steering::kFins ? "fins" : steering == Steering::kThrusters ? "thrusters" : "buoyancy";
}

// What a model can be steered with.
std::vector<Steering> steerings_of(const vehicle_sim::ModelParameters& model) {
  constexpr std::size_t kHorizontal = 2;  // thrusters that steer on the surface
  const bool has_thrusters = model.thrusters.size() == vehicle_sim::kMaxThrusters ||
                             (!model.floats.empty() && model.thrusters.size() >= kHorizontal);
  std::vector<Steering> all;
  if (model.propeller.diameter_m > 0 && model.rudder.area_m2 > 0 && model.stern_planes.area_m2 > 0)
    all.push_back(Steering::kFins);
  if (has_thrusters) all.push_back(Steering::kThrusters);
  if (model.buoyancy_engine.pump.limit > 0 || model.drop_weight.mass_kg > 0)
    all.push_back(Steering::kBuoyancy);
  return all;
}

// Empty when the model has what the pilot steers with.
std::string lacking(const vehicle_sim::ModelParameters& model, Steering steering) {
  const std::vector<Steering> all = steerings_of(model);
  if (std::find(all.begin(), all.end(), steering) != all.end()) return "";
  std::string allowed;
  for (const Steering other : all)
    allowed += (allowed.empty() ? "\"" : " or \"") + std::string(to_text(other)) + "\"";
  const std::string lack = steering == Steering::kFins ? " has no propeller, rudder and stern planes"
                           : steering == Steering::kThrusters
                               ? " has no thrusters to steer by: four, or two where it floats on the surface"
                               : " has no buoyancy engine and no drop weight";
  return lack + "; allowed for it is " + (allowed.empty() ? "neither: it cannot be piloted" : allowed);
}

// Without an engine a vehicle can only wait before it rises.
void check_glide(std::size_t i, const vehicle_sim::ModelParameters& model, const PilotConfig& pilot,
                 bus::ConfigFile& file) {
  if (model.buoyancy_engine.pump.limit > 0) return;
  for (std::size_t k = 0; k < pilot.behaviours.size(); ++k) {
    if (pilot.behaviours[k].kind == BehaviourKind::kWait) continue;
    file.refuse(key_of(i, "mission.behaviour." + std::to_string(k) + ".kind"), "",
                "the model " + model.name + " has no buoyancy engine; allowed for it is \"wait\"");
  }
  if (pilot.behaviours.empty())
    file.refuse(key_of(i, "mission.waypoints"), "",
                "the model " + model.name +
                    " has no buoyancy engine; allowed for it are behaviours of kind \"wait\"");
}

void check_pilots(const ScenarioConfig& config, bus::ConfigFile& file) {
  const auto members = vehicle_sim::members_of(config.scenario, config.vehicle_sim);
  SpeedJudge judge(config, file);
  std::size_t member = 0;
  for (std::size_t i = 0; i < config.scenario.vehicles.size(); ++i) {
    if (config.scenario.vehicles[i].model == "external") continue;
    const std::shared_ptr<const vehicle_sim::Model> model = members.at(member++).model;
    const PilotConfig& pilot = config.autopilot.vehicles.at(i);
    if (!model || !pilot.is_piloted()) continue;
    const std::string lack = lacking(model->parameters(), pilot.steering);
    if (!lack.empty()) {
      file.refuse(key_of(i, "mission.steering"), to_text(pilot.steering),
                  "the model " + model->name() + lack);
    } else if (pilot.steering == Steering::kBuoyancy) {
      check_glide(i, model->parameters(), pilot, file);
    } else {
      judge.check(i, *model);
    }
  }
}

void check_count(const ScenarioConfig& config, bus::ConfigFile& file) {
  constexpr std::size_t kMost = channel_server::VehicleRegistry::kMaxVehicles;
  const std::size_t count = config.scenario.vehicles.size();
  if (count > kMost)
    file.refuse(key_of(kMost, "name"), config.scenario.vehicles[kMost].name,
                "the channel server follows " + std::to_string(kMost) +
                    " vehicles, allowed are no more; these are " + std::to_string(count));
}

// Refuses the key where `attempt` throws InvalidArgument, with its reason.
template <class Attempt>
void refuse_if_thrown(bus::ConfigFile& file, const std::string& key, const std::string& value,
                      const Attempt& attempt) {
  try {
    attempt();
  } catch (const InvalidArgument& error) {
    file.refuse(key, value, error.what());
  }
}

// Vehicles that other vehicles, faults and tethers name.
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

// False where its file is refused, which others then need not read.
bool check_ocean(const ScenarioConfig& config, bus::ConfigFile& file) {
  const bus::OceanEntry& entry = config.scenario.ocean;
  if (entry.file.empty()) return true;
  try {
    const auto field = ocean::read_ocean_field({(std::filesystem::path(config.folder) / entry.file).string(),
                                                entry.start_date,
                                                {to_radians(config.scenario.origin_latitude_deg),
                                                 to_radians(config.scenario.origin_longitude_deg)}});
    make_environment(config.channel_server.environment, config.scenario, config.folder);
    const double last_s = field->grid().times_s.back();
    if (!field->is_steady() && config.scenario.duration.seconds() > last_s) {
      file.warn("ocean.file", entry.file,
                "its last time is " + format_number(last_s) +
                    " s after the start: the ocean stays so from then on");
    }
    for (std::size_t i = 0; i < config.scenario.vehicles.size(); ++i) {
      const Vec3& start = config.scenario.vehicles[i].start_ned_m;
      if (!field->covers(start.x(), start.y()))
        file.warn(key_of(i, "start_ned_m"), "", "the ocean is not known there: the nearest column holds");
    }
    return true;
  } catch (const InvalidArgument& error) {
    file.refuse("ocean.file", entry.file, error.what());
    return false;
  }
}

// Vehicles of processes that are not ours need no entry, so an unknown name may be meant.
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
  refuse_if_thrown(file, "environment.profile_file", profile.file, [&] {
    make_environment(config.channel_server.environment, config.scenario, config.folder);
  });
}

}  // namespace

void check_water(const ScenarioConfig& config, bus::ConfigFile& file) {
  if (!check_ocean(config, file)) return;
  check_count(config, file);
  check_names(config, file);
  check_extra_loss(config, file);
  check_profile(config, file);
}

void check_missions(const ScenarioConfig& config, bus::ConfigFile& file) {
  check_modems(config, file);
  check_relays(config, file);
  check_pilots(config, file);
}

}  // namespace halocline::clients
