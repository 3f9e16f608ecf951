// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/channel_server_node.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "acoustics/modem/modem.h"
#include "bus/messages/channels.h"
#include "channel_server/link_messages.h"
#include "channel_server/links/link_table.h"
#include "channel_server/packets/medium_event.h"
#include "channel_server/packets/packet.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/scenario_messages.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/shard.h"
#include "channel_server/world_messages.h"
#include "core/check.h"
#include "core/hash.h"

namespace halocline::channel_server {
namespace {

namespace channels = bus::channels;

// An instant before every time that a message may hold: due as soon as simulation time is known.
constexpr SimTime kBeforeAll = SimTime::from_nanoseconds(-4'000'000'000'000'000'000);
constexpr SimDuration kEnvironmentPeriod = SimDuration::from_milliseconds(60'000);
constexpr SimDuration kScenarioPeriod = SimDuration::from_milliseconds(60'000);
// Largest number of missed ticks for which tables are made after a jump of time.
constexpr std::int64_t kMaxTicksBehind = 100;
// Additional time for which states and receipts are kept, beyond their rules, for every instant that may
// still be evaluated.
constexpr SimDuration kKeptLonger = SimDuration::from_milliseconds(1000);
constexpr SimDuration kForgettingPeriod = SimDuration::from_milliseconds(1000);

// Returns a hash of the configuration that is the same for all servers of a scenario, wherever each has its
// files.
std::uint64_t hash_of(const std::vector<scenario_info_t>& scenario) {
  std::string lines;
  for (const scenario_info_t& part : scenario) {
    for (const std::string& line : part.configuration_line) {
      if (!line.starts_with("place = ")) lines += line + '\n';
    }
  }
  return xxh3(lines);
}

// Returns the period of SCENARIO: a minute, or more for a configuration that carries files, so that it takes
// about a kilobyte a second at most.
SimDuration scenario_period(const std::vector<scenario_info_t>& scenario) {
  constexpr std::size_t kBytesAMinute = 64'000;
  std::size_t bytes = 0;
  for (const scenario_info_t& part : scenario) bytes += static_cast<std::size_t>(part.getEncodedSize());
  return kScenarioPeriod * static_cast<std::int64_t>(1 + bytes / kBytesAMinute);
}

SimTime on_grid_from(SimTime now, SimDuration period) {
  return next_on_grid(now - SimDuration::from_nanoseconds(1), period);
}

}  // namespace

ChannelServerNode::ChannelServerNode(lcm::LCM& lcm, bus::NodeIdentity identity, WaterModel water,
                                     const ConfiguredModems& modems, const ServerRules& rules,
                                     std::vector<scenario_info_t> scenario, VehicleEquipment equipment)
    : Node(lcm, std::move(identity)),
      rules_(rules),
      pool_(rules.threads),
      water_(std::move(water)),
      vehicles_(rules.position, modems, std::move(equipment)),
      reach_(water_.waters, *water_.propagation, rules.reach),
      medium_(vehicles_, *water_.propagation, rules.medium, &reach_, pool_.sharing_out()),
      sounds_(vehicles_, *water_.propagation, &reach_, rules.medium.fading, rules.medium.noise,
              rules.medium.seed),
      noise_(sounds_),
      predictor_(make_predictor(rules)),
      echoes_(rules.echoes.reuse_distance_m),
      rays_(rules.ray_queries),
      queries_(vehicles_, *water_.propagation, predictor_, noise_, echoes_, rays_,
               {rules.bottom_points, rules.ray_queries.answer_deadline}),
      places_(vehicles_, *water_.propagation, predictor_, noise_, rules.ray_queries.answer_deadline,
              pool_.sharing_out()),
      publisher_(bus()),
      journal_(bus(), publisher_),
      inbox_(bus(), rules.medium.shard, vehicles_.equipment()),
      seabed_(bus(), {rays_, queries_, echoes_, *water_.seabed, *water_.propagation}, rules.bottom_points,
              rules.echoes, rules.medium.shard),
      exchange_(bus(), publisher_, rules.medium.shard, rules.ray_queries.answer_deadline, hash_of(scenario)),
      packets_(bus(), journal_),
      tables_(publisher_, bus().log(), {vehicles_, *water_.propagation, predictor_, echoes_, noise_},
              pool_.sharing_out()),
      processor_(bus(), vehicles_, *water_.waters, *water_.propagation, medium_, packets_),
      scenario_(std::move(scenario)),
      scenario_period_(scenario_period(scenario_)),
      next_tick_(kBeforeAll),
      next_environment_(kBeforeAll),
      next_scenario_(kBeforeAll),
      next_forgetting_(kBeforeAll) {
  for (const scenario_info_t& part : scenario_) {
    for (const scenario_vehicle_t& vehicle : part.vehicles)
      vehicles_.reserve(vehicle.vehicle_name, vehicle.vehicle_id);
  }
  if (rules.medium.shard.index != 0) scenario_.clear();
  shares_searches_ = !rules.medium.shard.is_alone() && water_.propagation->share_searches(exchange_);
}

void ChannelServerNode::open_journal(const std::string& path, std::uint64_t digest) {
  recovery_ = std::make_unique<ServerRecovery>(journal_, inbox_, path, digest);
  if (!recovery_->has_history()) recovery_.reset();
  note_due_changed();
}

bus::Due ChannelServerNode::on_due() const {
  if (recovery_ && !recovery_->has_begun()) return {.sim = kBeforeAll};
  if (recovery_) return {.steady = std::min(seabed_.due(), recovery_->due())};
  const SimTime instant = table_waits_ ? SimTime::never() : next_instant();
  return {.sim = std::min({instant, medium_.next_event(), inbox_.due()}),
          .steady = std::min({seabed_.due(), queries_.due(), places_.due(), exchange_.due()})};
}

// Between ticks the node publishes outcomes of packets and answers of modems; other servers receive only the
// answers.
SimTime ChannelServerNode::on_lookahead(const ChannelTest& matters) const {
  if (exchange_.will_tell_of_terrain()) return SimTime::at_once();
  for (const bus::Family& family : {channels::kReceipt, channels::kReceive, channels::kModemEvent,
                                    channels::kLinkReply, channels::kBestPlaceReply}) {
    if (matters(family.of("any"))) return SimTime::at_once();
  }
  for (const std::string_view channel : {channels::kOutcome, channels::kEnvironment, channels::kRayQuery}) {
    if (matters(channel)) return SimTime::at_once();
  }
  return matters(channels::kModemReply)
             ? std::min({next_instant(), medium_.next_answerable(), inbox_.next_answerable()})
             : next_instant();
}

void ChannelServerNode::on_step(const bus::Now& now) {
  if (seabed_.take_replies()) {
    next_environment_ = kBeforeAll;
    exchange_.set_terrain(seabed_.terrain_version(), now.sim, /*tells=*/!recovery_);
    tables_in_work_.reset();
  }
  if (exchange_.take_news_of_terrain()) seabed_.ask_for_terrain();
  if (recovery_ && !(now.sim_known && recover(now))) return seabed_.publish_queries(now);
  if (now.sim_known) {
    journal_.write_inputs(now.sim);
    apply(inbox_.take_inputs(), now.sim, now.latest());
    set_first_instants(now.sim);
    table_waits_ = false;
    while (next_instant() <= now.sim && !table_waits_)
      table_waits_ = !run_instant(next_instant(), now.steady);
    advance_medium(now.sim);
    forget_old(now.sim);
  }
  answer_queries(now);
}

void ChannelServerNode::apply(StepInputs inputs, SimTime now, SimTime latest) {
  next_environment_ = std::min(next_environment_, processor_.apply(std::move(inputs), now, latest));
}

void ChannelServerNode::set_first_instants(SimTime now) {
  if (next_scenario_ == kBeforeAll) publish_scenario(now);
  next_scenario_ = std::max(next_scenario_, on_grid_from(now - scenario_period_, scenario_period_));
  if (next_environment_ == kBeforeAll) publish_environment(now);
  const SimTime earliest = next_tick_ == kBeforeAll ? now : now - rules_.link_period * kMaxTicksBehind;
  if (next_tick_ < earliest) next_tick_ = on_grid_from(earliest, rules_.link_period);
}

// The environment from an instant on applies to sound that leaves at that instant, so it is published before
// the medium advances.
bool ChannelServerNode::run_instant(SimTime instant, SimTime steady) {
  if (instant == next_scenario_) publish_scenario(instant);
  if (instant == next_environment_) publish_environment(instant);
  advance_medium(instant);
  if (instant != next_tick_) return true;
  if (!run_tick(instant, steady)) return false;
  next_tick_ = next_on_grid(instant, rules_.link_period);
  return true;
}

// During recovery no tables are published: their ticks passed while the server was down.
bool ChannelServerNode::run_tick(SimTime tick, SimTime steady) {
  if (recovery_) return true;
  if (!tables_in_work_ || tables_in_work_->tick != tick) tables_in_work_ = begin_tables(tick);
  Tables& tables = *tables_in_work_;
  if (!tables.is_prepared && !prepare(tables, steady)) return false;
  if (shares_searches_ && exchange_.must_wait(steady)) return false;
  tables_.publish(tick, tables.present, tables.rows);
  seabed_.begin_tick(tables.present, tables.all_links());
  tables_in_work_.reset();
  return true;
}

ChannelServerNode::Tables ChannelServerNode::begin_tables(SimTime tick) {
  Tables tables;
  tables.tick = tick;
  tables.present = place_all(vehicles_, tick);
  std::map<const VehicleModem*, const VehicleModem*> kept;
  for (PlacedVehicle& vehicle : tables.present) {
    const VehicleModem*& modem = kept[vehicle.modem];
    if (modem == nullptr)
      modem = tables.modems.emplace_back(std::make_unique<const VehicleModem>(*vehicle.modem)).get();
    vehicle.modem = modem;
  }
  tables.ranges_m = reach_.reception_ranges_m(
      tick, vehicles_, tables.present,
      [this](const acoustics::Modem& modem) { return predictor_.least_sinr_db(modem); });
  tables.rows = table_rows(tables.present, tables.ranges_m, rules_.medium.shard);
  if (!rules_.medium.shard.is_alone())
    tables.links_of_all = table_rows(tables.present, tables.ranges_m).links;
  return tables;
}

bool ChannelServerNode::prepare(Tables& tables, SimTime steady) {
  Propagation& propagation = *water_.propagation;
  const SimTime tick = tables.tick;
  const std::vector<EndPair>& links = tables.rows.links;
  // Asked first, so that all missing data are requested at once.
  const bool is_noise_ready = tables_.is_noise_ready(tick, links);
  if (!propagation.are_ready(tick, links) || !is_noise_ready) return false;
  if (propagation.plans_ticks()) propagation.begin_tick(tick, tables.all_links());
  if (shares_searches_) {
    propagation.prepare_tables(tick, links, pool_.sharing_out());
    exchange_.end_tick(tick, steady);
  }
  tables.is_prepared = true;
  return true;
}

void ChannelServerNode::advance_medium(SimTime time) {
  for (const MediumEvent& event : medium_.advance_to(time)) packets_.publish(event);
}

void ChannelServerNode::publish_environment(SimTime instant) {
  echoes_.forget_verdicts();
  if (rules_.medium.shard.index == 0 && !recovery_) {
    publisher_.publish(channels::kEnvironment,
                       to_message(water_.propagation->environment(instant), water_.description, instant,
                                  seabed_.terrain_version()));
  }
  next_environment_ =
      std::min(next_on_grid(instant, kEnvironmentPeriod), water_.waters->next_change_after(instant));
}

// The scenario is repeated for programs that have joined since the last time.
void ChannelServerNode::publish_scenario(SimTime instant) {
  next_scenario_ = scenario_.empty() ? SimTime::never() : next_on_grid(instant, scenario_period_);
  if (recovery_) return;
  for (scenario_info_t part : scenario_) {
    part.utime = instant.to_utime();
    publisher_.publish(channels::kScenario, std::move(part));
  }
}

// The earliest instant that may be evaluated is the start of a SEND received late, whose sender may have
// timed out before. Forgetting visits all vehicles and receivers, so it is done once a second.
void ChannelServerNode::forget_old(SimTime now) {
  if (now < next_forgetting_) return;
  next_forgetting_ = next_on_grid(now, kForgettingPeriod);
  const SimTime horizon = now - rules_.medium.max_lateness - kKeptLonger;
  medium_.forget_before(horizon);
  water_.waters->forget_before(horizon - kLongestFlight);
  vehicles_.forget_before(horizon - rules_.position.state_timeout - rules_.position.state_lag);
}

void ChannelServerNode::answer_queries(const bus::Now& now) {
  const auto sim = now.sim_known ? std::optional(now.sim) : std::nullopt;
  for (const link_query_t& query : inbox_.take_queries()) queries_.submit(to_query(query), sim, now.steady);
  for (const best_place_query_t& query : inbox_.take_place_queries())
    places_.submit(to_query(query), sim, now.steady);
  const auto places = places_.take_replies(now.steady);  // requests the seabed that the places need
  seabed_.publish_queries(now);
  const auto publish = [&](const auto& replies, const bus::Family& family) {
    for (const auto& reply : replies) {
      auto message = to_message(reply);
      message.session = bus().identity().session;
      bus().publish(family.of(reply.client), message);
    }
  };
  publish(queries_.take_replies(now.steady), channels::kLinkReply);
  publish(places, channels::kBestPlaceReply);
}

bool ChannelServerNode::recover(const bus::Now& now) {
  if (!recovery_->has_begun() && !recovery_->begin(now)) {
    recovery_.reset();
    return true;
  }
  for (;;) {
    const SimTime reached = recovery_->reached();
    set_first_instants(reached);
    const bool is_instant = next_instant() <= reached;
    if (is_instant) {
      table_waits_ = !run_instant(next_instant(), now.steady);
    } else {
      advance_medium(reached);
    }
    if (medium_.is_waiting()) return false;
    if (is_instant) continue;
    if (recovery_->is_done()) {
      bus().log().info("resumed", "late=" + std::to_string(packets_.published_late()));
      recovery_.reset();
      journal_.end_recovery();
      return true;
    }
    auto inputs = recovery_->next_step(now);
    if (!inputs) return false;
    apply(std::move(*inputs), recovery_->reached(), std::max(recovery_->reached(), now.latest()));
  }
}

void ChannelServerNode::on_restart(const bus::Now& now) {
  vehicles_.clear();
  medium_.clear();
  water_.waters->clear();
  seabed_.clear();
  queries_.clear();
  places_.clear();
  tables_.clear();
  exchange_.clear();
  tables_in_work_.reset();
  journal_.clear();
  recovery_.reset();
  inbox_.forget_after(now.sim + InputProcessor::kMaxAhead);
  next_tick_ = next_environment_ = next_scenario_ = next_forgetting_ = kBeforeAll;
  table_waits_ = false;
}

std::string ChannelServerNode::status_text() const {
  return std::to_string(tables_.vehicles_present()) + " vehicles, " +
         std::to_string(tables_.links_published()) + " links published, " +
         std::to_string(medium_.packets_in_flight()) + " packets in flight, " + seabed_.status_text();
}

std::unique_ptr<ChannelServerNode> make_channel_server(lcm::LCM& lcm, const bus::NodeIdentity& identity,
                                                       const ChannelServerConfig& config,
                                                       const bus::Scenario& scenario) {
  const Shard& shard = config.rules.medium.shard;
  require(shard.index < shard.count, "channel_server.shard is " + std::to_string(shard.index) +
                                         "; allowed is 0 to shards - 1, " + std::to_string(shard.count - 1));
  ServerRules rules = make_rules(config, scenario);
  if (!shard.is_alone()) {
    std::vector<StartPlace> places;
    for (const bus::VehicleEntry& vehicle : scenario.vehicles)
      places.push_back({vehicle.id, vehicle.start_ned_m});
    rules.medium.shard.servers = servers_by_place(std::move(places), shard.count);
  }
  const ConfiguredModems modems = make_modems(config);
  return std::make_unique<ChannelServerNode>(lcm, identity, make_water_model(config, scenario), modems, rules,
                                             to_messages(scenario, modems), make_equipment(config, scenario));
}

}  // namespace halocline::channel_server
