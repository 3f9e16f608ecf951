// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/channel_server_config.h"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "acoustics/noise/noise_spectrum.h"
#include "bus/config/carried_files.h"
#include "channel_server/modems/clock_config.h"
#include "channel_server/modems/modem_config.h"
#include "channel_server/packets/extra_loss.h"
#include "channel_server/packets/packet.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_power.h"
#include "core/check.h"
#include "core/limits.h"

namespace halocline::channel_server {
namespace {

// References of a vehicle's noise when a scenario gives none; the values are chosen.
constexpr double kReferenceRpm = 1500, kReferenceMps = 2;

// Bounds of the rate of link tables. LCM carries more, but 50 Hz of a large fleet already floods the bus, and
// tables less often than once a minute are of no use.
constexpr double kMinLinkRateHz = 1.0 / 60, kMaxLinkRateHz = 50;

template <class Count>
void visit_count(bus::ConfigVisitor& v, std::string_view key, Count& value, const bus::NumberRule& rule) {
  bus::integer_as(v, key, value, rule);
}

void visit_noise_variation(bus::ConfigVisitor& v, acoustics::NoiseVariation& n) {
  v.number("noise_spread_db", n.spread_db,
           {0, 30, "dB", "standard deviation of the noise about these; 0: none"});
  v.when(n.spread_db > 0, "noise_spread_db above 0", [&] {
    v.number("noise_spread_s", n.spread_time_s, {0.1, 1e6, "s", "its correlation time"});
  });
  v.number("impulse_exponent", n.burst_exponent,
           {0, 2, "", "of impulsive, alpha-stable noise, 0.5 to 2; 0: there is none"});
  v.when(n.burst_exponent > 0, "impulse_exponent above 0", [&] {
    v.number("impulse_level_db", n.burst_level.value,
             {-100, 100, "dB", "impulsive noise: its scale over the noise"});
    bus::seconds(v, "impulse_s", n.burst, {0.001, 60, "s", "impulsive noise: how long a burst lasts"});
  });
  bus::report_refusal(v, "impulse_exponent", [&] { validate(n); });
}

void visit_vehicle_noise(bus::ConfigVisitor& v, NoiseSource& noise) {
  std::vector<double> frequencies_khz, levels_db = noise.at_1m.levels_db();
  for (const double f : noise.at_1m.frequencies_hz()) frequencies_khz.push_back(f / 1000);
  v.numbers("frequency_khz", frequencies_khz, {0.001, 1000, "kHz", "of level_db, rising"});
  v.numbers("level_db", levels_db,
            {-200, 300, "dB re 1 uPa^2/Hz at 1 m",
             "of its noise at the reference; linear between, constant beyond"});
  const std::vector<std::string> kDrivers{"propeller", "speed", "nothing"};
  bus::choice(v, "varies_with", noise.driver, kDrivers,
              "60 log10 of the turn rate or speed over ground to the reference; nothing: always as loud");
  double turns_per_min = noise.driver == NoiseDriver::kPropeller ? noise.reference * 60 : kReferenceRpm;
  double speed_mps = noise.driver == NoiseDriver::kSpeed ? noise.reference : kReferenceMps;
  bus::when_one_of(v, "varies_with", noise.driver, kDrivers, {NoiseDriver::kPropeller}, [&] {
    v.number("reference_rpm", turns_per_min,
             {1, 1e5, "rpm", "varies_with = propeller: of its fastest propeller"});
  });
  bus::when_one_of(v, "varies_with", noise.driver, kDrivers, {NoiseDriver::kSpeed}, [&] {
    v.number("reference_mps", speed_mps, {0.01, 100, "m/s", "varies_with = speed: over ground"});
  });
  noise.reference = noise.driver == NoiseDriver::kPropeller ? turns_per_min / 60 : speed_mps;
  v.number("own_loss_db", noise.own_loss.value, {0, 200, "dB", "from 1 m to its own hydrophone"});
  bus::report_refusal(v, "level_db", [&] {
    std::vector<double> frequencies_hz;
    for (const double f : frequencies_khz) frequencies_hz.push_back(f * 1000);
    noise.at_1m = acoustics::NoiseSpectrum(std::move(frequencies_hz), std::move(levels_db));
  });
}

void visit_vehicle(bus::ConfigVisitor& v, ChannelServerConfig::OfVehicle& vehicle,
                   const VehicleModem& standard) {
  v.shared_with_others();
  v.text("name", vehicle.name, {}, "channel suffix");
  if (v.writing() ? vehicle.clock.has_value() : v.given("clock")) {
    ClockSettings clock = vehicle.clock.value_or(ClockSettings());
    v.section("clock", "By which it stamps packets; without this it has simulation time",
              [&](bus::ConfigVisitor& section) { visit_clock(section, clock); });
    vehicle.clock = clock;
  }
  if (v.writing() ? vehicle.noise.has_value() : v.given("noise")) {
    NoiseSource noise = vehicle.noise.value_or(NoiseSource());
    v.section("noise", "That it makes; without this it is silent",
              [&](bus::ConfigVisitor& section) { visit_vehicle_noise(section, noise); });
    vehicle.noise = noise;
  }
  v.boolean("has_modem", vehicle.carries_modem,
            "false: a ship or a jammer, which sends and receives nothing");
  v.when(vehicle.carries_modem, "has_modem = true", [&] {
    v.boolean("transponder", vehicle.is_transponder,
              "its modem answers pings to all, of long-baseline ranging");
    vehicle.has_modem = v.given("modem");
    if (!vehicle.has_modem) return;
    if (vehicle.modem == VehicleModem()) vehicle.modem = standard;
    v.section("modem", "Where it differs from [modem]",
              [&](bus::ConfigVisitor& modem) { visit_modem(modem, vehicle.modem); });
  });
}

void visit_rules(bus::ConfigVisitor& v, ServerRules& r, PropagationModel model) {
  const auto with_rays = [&](const std::function<void()>& body) {
    v.when(model == PropagationModel::kRays, "propagation.model = \"rays\"", body);
  };
  double rate_hz = 1 / r.link_period.seconds();
  v.number("link_rate_hz", rate_hz, {kMinLinkRateHz, kMaxLinkRateHz, "Hz", "link tables of each vehicle"});
  r.link_period = SimDuration::from_seconds(1 / rate_hz);
  bus::seconds(v, "state_lag_s", r.position.state_lag,
               {0, 10, "s", "how old a state must be to be used; longer than a message takes on the bus"});
  bus::seconds(v, "state_timeout_s", r.position.state_timeout,
               {0.01, 3600, "s", "a vehicle without a younger state leaves the tables"});
  visit_count(v, "max_unlisted_vehicles", r.position.max_unlisted_vehicles,
              {0, kMaxVehicles, "", "vehicles that are not of the scenario and are followed"});
  bus::seconds(v, "max_lateness_s", r.medium.max_lateness,
               {0, 600, "s", "how long after its start a SEND may be received"});
  bus::seconds(v, "max_earliness_s", r.medium.max_earliness,
               {0, 3600, "s", "how long before its start a transmission may be announced"});
  bus::choice(v, "reach", r.reach.by_level, {"none", "level"},
              "level: links over which sound cannot matter are left out (docs/packets.md); none: none is");
  v.when(r.reach.by_level, "reach = \"level\"", [&] {
    v.number("reach_below_noise_db", r.reach.below_noise.value,
             {0, 200, "dB", "reach: how far below the noise sound disturbs nobody"});
    v.number("reach_acquired_once_in", r.reach.acquired_once_in,
             {10, 1e5, "packets", "reach: a preamble that is acquired no more often is not noticed"});
  });
  v.number("table_range_m", r.reach.table_range_m,
           {0, 4e7, "m", "link tables: peers further away have no row; 0: only those who cannot be heard"});
  with_rays([&] {
    v.number("profile_spacing_m", r.seabed.spacing_m,
             {1, 1000, "m", "rays: lattice of the depths that the bottom is made of"});
  });
  with_rays([&] {
    visit_count(v, "max_searches_per_tick", r.max_searches_per_tick,
                {0, 1e6, "",
                 "rays, link tables: paths searched for at a tick, the most audible and most changed links "
                 "first; 0: all"});
  });
  visit_count(v, "threads", r.threads, {1, 64, "", "that compute link tables and the paths of packets"});
  visit_count(v, "predicted_payload_bytes", r.predicted_payload_bytes,
              {1, acoustics::kMaxPayloadBytes, "bytes", "of the packets whose delivery link tables predict"});
  visit_count(v, "shards", r.medium.shard.count,
              {1, kMaxShards, "", "channel servers that share the vehicles, by where they start"});
  visit_count(v, "shard", r.medium.shard.index,
              {0, kMaxShards - 1.0, "", "which of them this one is; in one process all run"});
}

void visit_extra_loss(bus::ConfigVisitor& v, ExtraLoss& loss) {
  constexpr std::array kKinds{"any", "data",        "ping",  "ping-reply",
                              "ack", "mini-packet", "janus", "janus-cargo"};
  v.text("from", loss.from, {}, "name of the sender; empty: any");
  v.text("to", loss.to, {}, "name of the receiver; empty: any");
  std::size_t kind = loss.kind ? 1 + static_cast<std::size_t>(*loss.kind) : 0;
  bus::choice(v, "kind", kind, {kKinds.begin(), kKinds.end()}, "of packet");
  loss.kind = kind == 0 ? std::nullopt : std::optional(static_cast<PacketKind>(kind - 1));
  v.number("share", loss.share, {0, 1, "", "of the packets that would have been received, lost on purpose"});
  double at_s = loss.begin.seconds(), until_s = loss.end == SimTime::never() ? 0 : loss.end.seconds();
  v.number("at_s", at_s, {0, 1e7, "s", "simulation time from which packets depart into it"});
  v.number("until_s", until_s, {0, 1e7, "s", "and until when; 0: for ever"});
  loss.begin = SimTime::from_seconds(at_s);
  loss.end = until_s > 0 ? SimTime::from_seconds(until_s) : SimTime::never();
}

}  // namespace

void visit_noise(bus::ConfigVisitor& v, EnvironmentConfig& e) {
  v.number("wind_mps", e.noise.wind_mps, {0, 60, "m/s", "wind 10 m above the sea: noise"});
  v.file("noise_file", e.noise_file, bus::FileNames::kFiles,
         "CSV of t_s, frequency_khz, level_db: the noise instead of wind, shipping and rain; empty: none");
  if (!e.noise_file.empty()) bus::require_readable(v, "noise_file", e.noise_file);
  v.when(e.noise_file.empty(), "no noise_file", [&] {
    v.number("shipping", e.noise.shipping, {0, 1, "", "shipping activity: noise"});
    v.number("rain_mm_per_h", e.noise.rain_mm_per_h, {0, 500, "mm/h", "rain on the sea: noise"});
  });
  visit_noise_variation(v, e.noise_variation);
}

std::vector<acoustics::TimedSpectrum> noise_table(const EnvironmentConfig& config) {
  if (config.noise_file.empty()) return {};
  return acoustics::read_noise_table(config.noise_file.place());
}

acoustics::NoiseSources noise_sources(const EnvironmentConfig& config) {
  acoustics::NoiseSources sources = config.noise;
  const auto table = noise_table(config);
  if (!table.empty()) sources.table = table.front().spectrum;
  return sources;
}

void visit(bus::ConfigVisitor& v, ChannelServerConfig& config) {
  visit_water(v, config);
  v.section("modem", "The modem of every vehicle without one of its own",
            [&](bus::ConfigVisitor& s) { visit_modem(s, config.modem); });
  v.list(
      "vehicle", "A vehicle", config.vehicles.size(), [&](std::size_t n) { config.vehicles.resize(n); },
      [&](bus::ConfigVisitor& item, std::size_t i) {
        visit_vehicle(item, config.vehicles[i], config.modem);
      });
  // A vehicle whose own modem reports events takes the threshold of [modem].
  const auto has_events = [](const ChannelServerConfig::OfVehicle& vehicle) {
    return vehicle.has_modem && vehicle.modem.listening.events;
  };
  if (!v.writing() && std::any_of(config.vehicles.begin(), config.vehicles.end(), has_events)) {
    v.section("modem", "",
              [&](bus::ConfigVisitor& s) { visit_carrier_threshold(s, config.modem.listening); });
  }
  std::vector<ExtraLoss>& losses = config.rules.medium.extra_loss;
  v.list(
      "extra_loss", "Packets lost on purpose, for tests of protocols", losses.size(),
      [&](std::size_t n) { losses.resize(n); },
      [&](bus::ConfigVisitor& item, std::size_t i) { visit_extra_loss(item, losses[i]); });
  v.section("channel_server", "How the channel server works",
            [&](bus::ConfigVisitor& s) { visit_rules(s, config.rules, config.propagation.model); });
}

ConfiguredModems make_modems(const ChannelServerConfig& config) {
  validate(config.modem.modem);
  ConfiguredModems modems{config.modem, {}};
  for (const auto& vehicle : config.vehicles) {
    if (!vehicle.has_modem && vehicle.carries_modem) continue;
    VehicleModem modem = vehicle.has_modem ? vehicle.modem : config.modem;
    modem.fitted = vehicle.carries_modem;
    validate(modem.modem);
    modems.of_vehicle.emplace(vehicle.name, std::move(modem));
  }
  return modems;
}

VehicleEquipment make_equipment(const ChannelServerConfig& config, const bus::Scenario& scenario) {
  std::vector<ClockOf> clocks;
  std::vector<NoiseSource> noise;
  std::set<VehicleId> transponders;
  for (const auto& vehicle : config.vehicles) {
    const bus::VehicleEntry* entry = scenario.find(vehicle.name);
    if (entry == nullptr) continue;
    if (vehicle.is_transponder) transponders.insert(entry->id);
    if (vehicle.clock) clocks.push_back({vehicle.name, entry->id, *vehicle.clock});
    if (vehicle.noise) {
      noise.push_back(*vehicle.noise);
      noise.back().vehicle = vehicle.name;
      noise.back().id = entry->id;
    }
  }
  std::vector<PowerOf> batteries;
  for (const bus::VehicleEntry& vehicle : scenario.vehicles) {
    const auto& b = vehicle.battery;
    if (b) batteries.push_back({vehicle.name, vehicle.id, b->transmit_efficiency, b->receiving_w});
  }
  const SimDuration lag = config.rules.position.state_lag;
  return {VehicleClocks(clocks, scenario.seed, lag), VehiclePower(std::move(batteries), lag),
          VehicleNoise(std::move(noise), lag), std::move(transponders)};
}

ServerRules make_rules(const ChannelServerConfig& config, const bus::Scenario& scenario) {
  ServerRules rules = config.rules;
  rules.medium.seed = scenario.seed;
  rules.medium.fading = rules.reach.fading = config.propagation.fading;
  rules.medium.noise = config.environment.noise_variation;
  rules.reach.noise_spread_db = config.environment.noise_variation.spread_db;
  return rules;
}

LinkPredictor make_predictor(const ServerRules& rules) {
  LinkPredictor::Rule rule{static_cast<std::size_t>(rules.predicted_payload_bytes), rules.medium.fading, {}};
  for (const std::string& name : built_in_modems()) rule.profiles.push_back(built_in_modem(name));
  return LinkPredictor(std::move(rule));
}

}  // namespace halocline::channel_server
