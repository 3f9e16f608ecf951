// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/channel_server_node.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "bus/messages/channels.h"
#include "channel_server/input_processor.h"
#include "channel_server/links/ray_query_client.h"
#include "channel_server/messages/scenario_messages.h"
#include "channel_server/vehicles/shard.h"
#include "core/check.h"
#include "core/hash.h"

namespace halocline::channel_server {
namespace {

namespace channels = bus::channels;

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

}  // namespace

ChannelServerNode::ChannelServerNode(lcm::LCM& lcm, bus::NodeIdentity identity, WaterModel water,
                                     const ConfiguredModems& modems, const ServerRules& rules,
                                     std::vector<scenario_info_t> scenario, VehicleEquipment equipment)
    : Node(lcm, std::move(identity)),
      setup_{rules, modems, std::move(equipment), std::move(scenario)},
      pool_(rules.threads),
      water_(std::move(water)),
      publisher_(bus()),
      journal_(bus(), publisher_),
      inbox_(bus(), rules.medium.shard, setup_.equipment),
      seabed_(bus(), *water_.seabed, *water_.propagation),
      exchange_(bus(), publisher_, rules.medium.shard, RayQueryClient::kAnswerDeadline,
                hash_of(setup_.scenario)),
      shares_searches_(!rules.medium.shard.is_alone() && water_.propagation->share_searches(exchange_)) {
  begin_run();
}

void ChannelServerNode::begin_run() {
  run_.emplace(ServerRun::Parts{setup_, water_, seabed_, shares_searches_ ? &exchange_ : nullptr, bus(),
                                publisher_, journal_, pool_.sharing_out()});
}

void ChannelServerNode::open_journal(const std::string& path, std::uint64_t digest) {
  recovery_ = std::make_unique<ServerRecovery>(journal_, inbox_, path, digest);
  if (!recovery_->has_history()) recovery_.reset();
  note_due_changed();
}

bus::Due ChannelServerNode::on_due() const {
  if (recovery_ && !recovery_->has_begun()) return {.sim = kBeforeAll};
  if (recovery_) return {.steady = std::min(seabed_.due(), recovery_->due())};
  return {.sim = std::min(run_->due(), inbox_.due()),
          .steady = std::min({seabed_.due(), run_->queries_due(), exchange_.due()})};
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
             ? std::min({run_->next_instant(), run_->next_answerable(), inbox_.next_answerable()})
             : run_->next_instant();
}

void ChannelServerNode::on_step(const bus::Now& now) {
  if (seabed_.take_replies()) {
    exchange_.set_terrain(seabed_.terrain_version(), now.sim, /*tells=*/!recovery_);
    run_->take_terrain();
  }
  if (exchange_.take_news_of_terrain()) seabed_.ask_for_terrain();
  if (recovery_ && !(now.sim_known && recover(now))) return seabed_.publish_queries(now);
  if (now.sim_known) {
    journal_.write_inputs(now.sim);
    run_->apply(inbox_.take_inputs(), now.sim, now.latest());
    run_->advance_to(now.sim, now.steady);
    run_->forget_old(now.sim);
  }
  run_->answer_queries(inbox_, now);
}

bool ChannelServerNode::recover(const bus::Now& now) {
  if (!recovery_->has_begun() && !recovery_->begin(now)) {
    recovery_.reset();
    return true;
  }
  for (;;) {
    run_->advance_to(recovery_->reached(), now.steady);
    if (run_->is_waiting()) return false;
    if (recovery_->is_done()) break;
    auto inputs = recovery_->next_step(now);
    if (!inputs) return false;
    run_->apply(std::move(*inputs), recovery_->reached(), std::max(recovery_->reached(), now.latest()));
  }
  bus().log().info("resumed", "late=" + std::to_string(run_->packets().published_late()));
  recovery_.reset();
  journal_.end_recovery();
  return true;
}

// Clients and subscriptions go on, without what the earlier run has told them.
void ChannelServerNode::on_restart(const bus::Now& now) {
  inbox_.forget_after(now.sim + InputProcessor::kMaxAhead);
  journal_.clear();
  recovery_.reset();
  water_.waters->clear();
  seabed_.clear();
  exchange_.clear();
  begin_run();
}

std::string ChannelServerNode::status_text() const {
  return run_->status_text() + ", " + seabed_.status_text();
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
