// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/channel_server_config.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "acoustics/noise/noise_spectrum.h"
#include "acoustics/noise/place_noise.h"
#include "bus/config/carried_files.h"
#include "channel_server/modems/clock_config.h"
#include "channel_server/modems/modem_config.h"
#include "channel_server/own_noise.h"
#include "channel_server/packets/extra_loss.h"
#include "channel_server/packets/packet.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_power.h"
#include "core/check.h"
#include "core/units.h"
#include "ocean/cf_time.h"

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

void visit_vehicle_noise(bus::ConfigVisitor& v, NoiseSource& noise) {
  std::vector<double> frequencies_khz, levels_db = noise.at_1m.levels_db();
  for (const double f : noise.at_1m.frequencies_hz()) frequencies_khz.push_back(f / 1000);
  v.numbers("frequency_khz", frequencies_khz, {0.001, 1000, "kHz", "frequencies of level_db, rising"});
  v.numbers("level_db", levels_db,
            {-200, 300, "dB re 1 uPa^2/Hz at 1 m",
             "spectral level of the noise at the reference; linear between, constant beyond"});
  const std::vector<std::string> kDrivers{"propeller", "speed", "nothing"};
  bus::choice(
      v, "varies_with", noise.driver, kDrivers,
      "cause of changes, by 60 log10 of turn rate or speed over ground to the reference; nothing: constant");
  double turns_per_min = noise.driver == NoiseDriver::kPropeller ? noise.reference * 60 : kReferenceRpm;
  double speed_mps = noise.driver == NoiseDriver::kSpeed ? noise.reference : kReferenceMps;
  bus::when_one_of(v, "varies_with", noise.driver, kDrivers, {NoiseDriver::kPropeller}, [&] {
    v.number("reference_rpm", turns_per_min,
             {1, 1e5, "rpm", "varies_with = propeller: turn rate of the fastest propeller"});
  });
  bus::when_one_of(v, "varies_with", noise.driver, kDrivers, {NoiseDriver::kSpeed}, [&] {
    v.number("reference_mps", speed_mps, {0.01, 100, "m/s", "varies_with = speed: speed over ground"});
  });
  noise.reference = noise.driver == NoiseDriver::kPropeller ? turns_per_min / 60 : speed_mps;
  v.advanced([&] {
    v.number("own_loss_db", noise.own_loss.value, {0, 200, "dB", "loss from 1 m to the own hydrophone"});
  });
  bus::report_refusal(v, "level_db", [&] {
    std::vector<double> frequencies_hz;
    for (const double f : frequencies_khz) frequencies_hz.push_back(f * 1000);
    noise.at_1m = acoustics::NoiseSpectrum(std::move(frequencies_hz), std::move(levels_db));
  });
}

void visit_vehicle(bus::ConfigVisitor& v, ChannelServerConfig::OfVehicle& vehicle,
                   const VehicleModem& standard, bool sea_fades) {
  v.shared_with_others();
  v.text("name", vehicle.name, {}, "channel suffix");
  if (v.writing() ? vehicle.clock.has_value() : v.given("clock")) {
    ClockSettings clock = vehicle.clock.value_or(ClockSettings());
    v.section("clock", "Clock that stamps packets; without this section it has simulation time",
              [&](bus::ConfigVisitor& section) { visit_clock(section, clock); });
    vehicle.clock = clock;
  }
  if (v.writing() ? vehicle.noise.has_value() : v.given("noise")) {
    NoiseSource noise = vehicle.noise.value_or(NoiseSource());
    v.section("noise", "Noise that the vehicle makes; without this section it is silent",
              [&](bus::ConfigVisitor& section) { visit_vehicle_noise(section, noise); });
    vehicle.noise = noise;
  }
  if (!v.writing() && !v.given("own_noise")) vehicle.own_noise = sea_fades;
  v.boolean("own_noise", vehicle.own_noise,
            "true: without [vehicle.noise] the propellers of its model are heard at its own hydrophone; by "
            "default with fading = \"sea\"");
  v.boolean("has_modem", vehicle.carries_modem,
            "false: a ship or a jammer, which sends and receives nothing");
  v.when(vehicle.carries_modem, "has_modem = true", [&] {
    v.boolean("transponder", vehicle.is_transponder, "true: the modem answers pings to all (long baseline)");
    vehicle.has_modem = v.given("modem");
    if (!vehicle.has_modem) return;
    if (vehicle.modem == VehicleModem()) vehicle.modem = standard;
    v.section("modem", "Modem of this vehicle where it differs, with the keys of [modem]",
              [&](bus::ConfigVisitor& modem) {
                modem.listed_elsewhere([&] { visit_modem(modem, vehicle.modem); });
              });
  });
}

// Sets the constants that the level bounds.
void use(const DetailLevel& level, ChannelServerConfig& config) {
  RayModel& rays = config.propagation.rays;
  rays.options.diffuse_below_flux_db = level.diffuse_below_flux_db;
  rays.diffuse_below_noise = level.diffuse_below_noise;
  rays.weak_below_diffuse = level.weak_below_diffuse;
  rays.reuse_for_packets = level.reuse_for_packets;
  const double searches = level.searches_per_vehicle * static_cast<double>(config.vehicles.size());
  rays.max_searches_per_tick = static_cast<int>(std::ceil(searches));
  config.rules.reach.below_noise = level.reach_below_noise;
  config.rules.reach.acquired_once_in = level.acquired_once_in;
  config.rules.reach.table_range_m = level.table_range_m;
}

void visit_detail(bus::ConfigVisitor& v, ChannelServerConfig& config) {
  bus::choice(v, "detail", config.detail, {"exact", "fast"},
              "detail of weak sound and of link tables; fast is for fleets (docs/performance.md)");
  if (!v.writing()) use(level_of(config.detail), config);
}

void visit_rules(bus::ConfigVisitor& v, ServerRules& r) {
  double rate_hz = 1 / r.link_period.seconds();
  v.number("link_rate_hz", rate_hz,
           {kMinLinkRateHz, kMaxLinkRateHz, "Hz", "rate of the link tables of each vehicle"});
  r.link_period = SimDuration::from_seconds(1 / rate_hz);
  bus::seconds(v, "state_lag_s", r.position.state_lag,
               {0, 10, "s", "age from which a STATE is used; longer than a message takes on the bus"});
  bus::seconds(v, "state_timeout_s", r.position.state_timeout,
               {0.01, 3600, "s", "age of its last STATE from which a vehicle is in no link table"});
  bus::choice(v, "reach", r.reach.by_level, {"none", "level"},
              "limit of the links of a sender; level leaves out those over which sound cannot matter "
              "(docs/packets.md)");
  visit_count(v, "threads", r.threads,
              {1, 64, "", "threads that compute link tables and the paths of packets"});
  visit_count(v, "predicted_payload_bytes", r.predicted_payload_bytes,
              {0, acoustics::kMaxPayloadBytes, "bytes",
               "payload of the packets whose delivery link tables predict; 0: the header alone"});
  visit_count(v, "shards", r.medium.shard.count,
              {1, kMaxShards, "", "channel servers that share the vehicles, by where they start"});
  visit_count(
      v, "shard", r.medium.shard.index,
      {0, kMaxShards - 1.0, "", "index of this channel server among the shards; in one process all run"});
}

void visit_extra_loss(bus::ConfigVisitor& v, ExtraLoss& loss) {
  constexpr std::array kKinds{"any", "data",        "ping",  "ping-reply",
                              "ack", "mini-packet", "janus", "janus-cargo"};
  v.text("from", loss.from, {}, "name of the sender; empty: any");
  v.text("to", loss.to, {}, "name of the receiver; empty: any");
  std::size_t kind = loss.kind ? 1 + static_cast<std::size_t>(*loss.kind) : 0;
  bus::choice(v, "kind", kind, {kKinds.begin(), kKinds.end()}, "kind of packet");
  loss.kind = kind == 0 ? std::nullopt : std::optional(static_cast<PacketKind>(kind - 1));
  v.number("share", loss.share, {0, 1, "", "share of the packets that would have been received"});
  double at_s = loss.begin.seconds(), until_s = loss.end == SimTime::never() ? 0 : loss.end.seconds();
  v.number("at_s", at_s, {0, 1e7, "s", "time of departure from which packets are lost"});
  v.number("until_s", until_s, {0, 1e7, "s", "time of departure until which packets are lost; 0: no end"});
  loss.begin = SimTime::from_seconds(at_s);
  loss.end = until_s > 0 ? SimTime::from_seconds(until_s) : SimTime::never();
}

void visit_calibration(bus::ConfigVisitor& v, ReceiverCalibration& calibration) {
  v.number("receiver_loss_db", calibration.loss_db,
           {-20, 40, "dB", "loss of all receivers on top of receiver_loss_db of their modems"});
  v.number("echo_factor", calibration.echo_factor,
           {0, 100, "", "factor on late_echo_share of all modems, whose product ends at 8"});
}

void calibrate(const ReceiverCalibration& calibration, acoustics::Modem& modem) {
  modem.receiver_loss.value = std::clamp(modem.receiver_loss.value + calibration.loss_db,
                                         acoustics::kMinReceiverLossDb, acoustics::kMaxReceiverLossDb);
  modem.late_echo_share =
      std::min(modem.late_echo_share * calibration.echo_factor, acoustics::kMaxLateEchoShare);
}

VehicleModem calibrated(const ReceiverCalibration& calibration, VehicleModem vehicle) {
  if (calibration.loss_db == 0 && calibration.echo_factor == 1) return vehicle;
  calibrate(calibration, vehicle.modem);
  std::vector<ModemRate> rates(vehicle.rates.all().begin(), vehicle.rates.all().end());
  for (ModemRate& rate : rates) calibrate(calibration, rate.modem);
  vehicle.rates = RateSet(std::move(rates));
  return vehicle;
}

// Returns the kind of the place; empty when it is left to the depth.
std::optional<acoustics::NoisePlace> noise_place(const EnvironmentConfig& config) {
  for (const acoustics::NoisePlace place : acoustics::kNoisePlaces) {
    if (config.noise_place == to_name(place)) return place;
  }
  require(config.noise_place == kByDepth, "no place of noise is called " + config.noise_place);
  return std::nullopt;
}

bool has_site_noise(const EnvironmentConfig& config) {
  return !config.site_noise_file.empty() || !config.site_noise.empty();
}

std::shared_ptr<const acoustics::NoiseSpectrum> site_spectrum(const EnvironmentConfig& config) {
  if (!config.site_noise_file.empty()) return acoustics::read_noise_spectrum(config.site_noise_file.place());
  if (config.site_noise.empty()) return nullptr;
  std::vector<double> frequencies_hz, levels_db;
  for (const auto& [khz, level_db] : config.site_noise) {
    frequencies_hz.push_back(khz_to_hz(khz));
    levels_db.push_back(level_db);
  }
  return std::make_shared<const acoustics::NoiseSpectrum>(std::move(frequencies_hz), std::move(levels_db));
}

// Simulation time of noon, local solar time, s.
double noon_s(const bus::Scenario& scenario) {
  if (scenario.ocean.start_date.empty()) return 0;
  constexpr double kDayS = 86'400, kSecondsPerDegree = kDayS / 360;
  const auto utc = ocean::CfTimeAxis::parse("seconds since 2000-01-01", "standard");
  const double start_s =
      utc.seconds_of(scenario.ocean.start_date) + kSecondsPerDegree * scenario.origin_longitude_deg;
  return kDayS / 2 - (start_s - kDayS * std::floor(start_s / kDayS));
}

}  // namespace

std::vector<acoustics::TimedSpectrum> noise_table(const EnvironmentConfig& config) {
  if (config.noise_file.empty()) return {};
  return acoustics::read_noise_table(config.noise_file.place());
}

acoustics::NoiseSources noise_sources(const EnvironmentConfig& config) {
  acoustics::NoiseSources sources = config.noise;
  const auto table = noise_table(config);
  if (!table.empty()) sources.table = table.front().spectrum;
  sources.place = noise_place(config).value_or(acoustics::NoisePlace::kOpen);
  sources.site = site_spectrum(config);
  return sources;
}

bool needs_depth(const EnvironmentConfig& config) {
  return config.noise_place == kByDepth && config.noise_file.empty() && !has_site_noise(config);
}

void use_depth(double depth_m, EnvironmentConfig& config) {
  if (!needs_depth(config)) return;
  const bool is_fast_ice = config.ice.kind == acoustics::IceKind::kFast;
  config.noise_place =
      to_name(is_fast_ice ? acoustics::NoisePlace::kFastIce : acoustics::place_of_depth(depth_m));
}

void visit(bus::ConfigVisitor& v, ChannelServerConfig& config) {
  visit_water(v, config);
  v.section("modem", "Modem of every vehicle that does not set its own",
            [&](bus::ConfigVisitor& s) { visit_modem(s, config.modem); });
  v.section("calibration", "Receivers of all modems at this place, as `halocline calibrate` finds them",
            [&](bus::ConfigVisitor& s) { visit_calibration(s, config.calibration); });
  v.list(
      "vehicle", "A vehicle", config.vehicles.size(), [&](std::size_t n) { config.vehicles.resize(n); },
      [&](bus::ConfigVisitor& item, std::size_t i) {
        visit_vehicle(item, config.vehicles[i], config.modem, config.propagation.fading.enabled);
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
  v.section("channel_server", "Channel server: its detail, rates, limits and shares",
            [&](bus::ConfigVisitor& s) {
              visit_detail(s, config);
              visit_rules(s, config.rules);
            });
}

ConfiguredModems make_modems(const ChannelServerConfig& config) {
  validate(config.modem.modem);
  ConfiguredModems modems{calibrated(config.calibration, config.modem), {}};
  for (const auto& vehicle : config.vehicles) {
    if (!vehicle.has_modem && vehicle.carries_modem) continue;
    VehicleModem modem = calibrated(config.calibration, vehicle.has_modem ? vehicle.modem : config.modem);
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
    std::optional<NoiseSource> source = vehicle.noise;
    if (!source && vehicle.own_noise && vehicle.carries_modem) source = propeller_noise(entry->model);
    if (source) {
      noise.push_back(*std::move(source));
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

acoustics::NoiseVariation make_noise_variation(const EnvironmentConfig& config,
                                               const bus::Scenario& scenario) {
  acoustics::NoiseVariation variation = config.noise_variation;
  if (!config.noise_file.empty()) return variation;
  const auto place = noise_place(config).value_or(acoustics::NoisePlace::kOpen);
  variation.day_night_db = acoustics::day_night_db(place);
  if (variation.day_night_db > 0) variation.noon_s = noon_s(scenario);
  if (acoustics::is_impulsive(place) && !variation.has_bursts()) {
    variation.burst_exponent = acoustics::kPlaceBurstExponent;
    variation.bursts_within_level = true;
  }
  return variation;
}

ServerRules make_rules(const ChannelServerConfig& config, const bus::Scenario& scenario) {
  ServerRules rules = config.rules;
  rules.medium.seed = scenario.seed;
  rules.medium.fading = rules.reach.fading = fading_of(config);
  rules.medium.near_surface = make_surface_ends(config, scenario);
  rules.medium.noise = make_noise_variation(config.environment, scenario);
  rules.reach.noise_spread_db = config.environment.noise_variation.spread_db;
  return rules;
}

LinkPredictor make_predictor(const ServerRules& rules) {
  LinkPredictor::Rule rule{static_cast<std::size_t>(rules.predicted_payload_bytes), rules.medium.fading, {}};
  rule.noise = rules.medium.noise;
  rule.seed = rules.medium.seed;
  rule.impulsive_noise = rules.medium.noise.has_bursts();
  rule.receiver_margin = {rules.receiver_margin_db};
  for (const std::string& name : built_in_modems()) rule.profiles.push_back(built_in_modem(name));
  return LinkPredictor(std::move(rule));
}

}  // namespace halocline::channel_server
