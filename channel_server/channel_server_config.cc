#include "channel_server/channel_server_config.h"

#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "channel_server/modems/modem_config.h"
#include "channel_server/packets/extra_loss.h"
#include "channel_server/packets/packet.h"
#include "core/check.h"

namespace halocline::channel_server {
namespace {

// LCM carries more, but a table a minute is no table and 50 Hz of a large fleet is a flood.
constexpr double kMinLinkRateHz = 1.0 / 60, kMaxLinkRateHz = 50;

template <class Count>
void visit_count(bus::ConfigVisitor& v, std::string_view key, Count& value, const bus::NumberRule& rule) {
  bus::integer_as(v, key, value, rule);
}

void visit_vehicle(bus::ConfigVisitor& v, ChannelServerConfig::OfVehicle& vehicle,
                   const VehicleModem& standard) {
  v.shared_with_others();
  v.text("name", vehicle.name, {}, "channel suffix");
  vehicle.has_modem = v.given("modem");
  if (!vehicle.has_modem) return;
  if (vehicle.modem == VehicleModem()) vehicle.modem = standard;
  v.section("modem", "Where it differs from [modem]",
            [&](bus::ConfigVisitor& modem) { visit_modem(modem, vehicle.modem); });
}

void visit_rules(bus::ConfigVisitor& v, ServerRules& r) {
  double rate_hz = 1 / r.link_period.seconds();
  v.number("link_rate_hz", rate_hz, {kMinLinkRateHz, kMaxLinkRateHz, "Hz", "link tables of each vehicle"});
  r.link_period = SimDuration::from_seconds(1 / rate_hz);
  bus::seconds(v, "state_lag_s", r.position.state_lag,
               {0, 10, "s", "how old a state must be to be used; longer than a message takes on the bus"});
  bus::seconds(v, "state_timeout_s", r.position.state_timeout,
               {0.01, 3600, "s", "a vehicle without a younger state leaves the tables"});
  bus::seconds(v, "max_lateness_s", r.medium.max_lateness,
               {0, 600, "s", "how long after its start a SEND may be received"});
  bus::seconds(v, "max_earliness_s", r.medium.max_earliness,
               {0, 3600, "s", "how long before its start a transmission may be announced"});
  bus::choice(v, "reach", r.reach.by_level, {"none", "level"},
              "level: links over which sound cannot matter are left out (docs/packets.md); none: none is");
  v.number("reach_below_noise_db", r.reach.below_noise.value,
           {0, 200, "dB", "reach: how far below the noise sound disturbs nobody"});
  v.number("reach_acquired_once_in", r.reach.acquired_once_in,
           {10, 1e5, "packets", "reach: a preamble that is acquired no more often is not noticed"});
  v.number("table_range_m", r.reach.table_range_m,
           {0, 4e7, "m", "link tables: peers further away have no row; 0: only those who cannot be heard"});
  visit_count(v, "bottom_points", r.bottom_points,
              {1, 64, "", "points of the bottom surveyed for each link"});
  v.number("echo_reuse_distance_m", r.echo_reuse_distance_m,
           {0, 1e5, "m", "how far the ends of a link may move before its echoes are surveyed again"});
  v.number("profile_reuse_distance_m", r.profile_reuse_distance_m,
           {0.1, 1000, "m", "rays, link tables: lattice of the ends of bottom profiles"});
  v.number("profile_spacing_m", r.seabed.spacing_m,
           {1, 1000, "m", "rays: lattice of the depths that the bottom is made of"});
  v.number(
      "row_reuse_distance_m", r.row_reuse_distance_m,
      {0, 1000, "m", "link tables: how far the ends of a link may move before its row is computed again"});
  visit_count(v, "max_searches_per_tick", r.max_searches_per_tick,
              {0, 1e6, "",
               "rays, link tables: paths searched for at a tick, the most audible and most changed links "
               "first; 0: all"});
  visit_count(v, "threads", r.threads, {1, 64, "", "that compute link tables and the paths of packets"});
  visit_count(v, "predicted_payload_bytes", r.predicted_payload_bytes,
              {1, acoustics::kMaxPayloadBytes, "bytes", "of the packets whose delivery link tables predict"});
  visit_count(v, "shards", r.medium.shard.count,
              {1, kMaxShards, "", "channel servers that share the vehicles (id mod shards = shard)"});
  visit_count(v, "shard", r.medium.shard.index,
              {0, kMaxShards - 1.0, "", "which of them this one is; in one process all run"});
  bus::seconds(v, "echo_deadline_s", r.ray_queries.answer_deadline,
               {0.001, 60, "s", "the bathymetry service is away when it has not answered by then"});
  visit_count(v, "echo_rays_per_message", r.ray_queries.rays_per_batch,
              {128, 4096, "", "rays in one RAY_QUERY"});
  visit_count(v, "echo_messages_in_flight", r.ray_queries.batches_in_flight,
              {1, 64, "", "RAY_QUERYs without an answer"});
  visit_count(v, "echo_messages_per_table", r.ray_queries.batches_per_tick,
              {1, 10000, "", "RAY_QUERYs for one link table"});
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

void visit(bus::ConfigVisitor& v, ChannelServerConfig& config) {
  visit_water(v, config);
  v.section("modem", "The modem of every vehicle without one of its own",
            [&](bus::ConfigVisitor& s) { visit_modem(s, config.modem); });
  v.list(
      "vehicle", "A vehicle", config.vehicles.size(), [&](std::size_t n) { config.vehicles.resize(n); },
      [&](bus::ConfigVisitor& item, std::size_t i) {
        visit_vehicle(item, config.vehicles[i], config.modem);
      });
  std::vector<ExtraLoss>& losses = config.rules.medium.extra_loss;
  v.list(
      "extra_loss", "Packets lost on purpose, for tests of protocols", losses.size(),
      [&](std::size_t n) { losses.resize(n); },
      [&](bus::ConfigVisitor& item, std::size_t i) { visit_extra_loss(item, losses[i]); });
  v.section("channel_server", "How the channel server works",
            [&](bus::ConfigVisitor& s) { visit_rules(s, config.rules); });
}

ConfiguredModems make_modems(const ChannelServerConfig& config) {
  validate(config.modem.modem);
  ConfiguredModems modems{config.modem, {}};
  for (const auto& vehicle : config.vehicles) {
    if (!vehicle.has_modem) continue;
    validate(vehicle.modem.modem);
    modems.of_vehicle.emplace(vehicle.name, vehicle.modem);
  }
  return modems;
}

LinkPredictor make_predictor(const ServerRules& rules) {
  LinkPredictor::Rule rule{static_cast<std::size_t>(rules.predicted_payload_bytes), rules.medium.fading, {}};
  for (const std::string& name : built_in_modems()) rule.profiles.push_back(built_in_modem(name));
  return LinkPredictor(std::move(rule));
}

}  // namespace halocline::channel_server
