// SPDX-License-Identifier: BSD-3-Clause
// The channel server as a node on the bus. It receives states, modems and transmissions of vehicles;
// publishes the scenario, the water, the link tables and the outcome of every packet; and answers queries of
// links and of best places. --interface lists its channels.
//
// Several servers may share the water (rules.medium.shard). Each receives what all others receive and
// publishes its share; the first one also publishes ENVIRONMENT and SCENARIO; a query is answered by the
// server given by its request_id. MODEM_REPLY passes on answers to pings, FOUND_PATHS the eigenrays that two
// servers need. With a journal, a server that was killed resumes where it was (server_recovery.h).
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/config/scenario.h"
#include "bus/messages/messages.h"
#include "bus/numbered_publisher.h"
#include "bus/recovery/crash_journal.h"
#include "bus/runtime/node.h"
#include "bus/runtime/thread_pool.h"
#include "bus/transport/node_identity.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/inbox.h"
#include "channel_server/input_processor.h"
#include "channel_server/link_table_publisher.h"
#include "channel_server/links/best_place_service.h"
#include "channel_server/links/link_predictor.h"
#include "channel_server/links/link_query_service.h"
#include "channel_server/links/link_table.h"
#include "channel_server/links/multipath_cache.h"
#include "channel_server/links/ray_query_client.h"
#include "channel_server/packet_publisher.h"
#include "channel_server/packets/packet_medium.h"
#include "channel_server/packets/platform_noise.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/reach.h"
#include "channel_server/seabed_client.h"
#include "channel_server/server_recovery.h"
#include "channel_server/shards/shard_exchange.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/vehicle_equipment.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "channel_server/water_model.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class ChannelServerNode : public bus::Node {
 public:
  // `scenario` is the contents of SCENARIO (scenario_messages.h); when it is empty SCENARIO is not published.
  ChannelServerNode(lcm::LCM& lcm, bus::NodeIdentity identity, WaterModel water,
                    const ConfiguredModems& modems, const ServerRules& rules,
                    std::vector<scenario_info_t> scenario = {}, VehicleEquipment equipment = {});

  // Keeps a journal at `path`, and resumes from what an earlier incarnation with the same `digest` of the
  // configuration left there. To be called once, before anything is dispatched, and not in lockstep, where
  // the conductor replays. Throws InvalidArgument when the file cannot be written.
  void open_journal(const std::string& path, std::uint64_t digest = 0);
  bool waits_for_repair() const override { return true; }

 protected:
  bus::Due on_due() const override;
  SimTime on_lookahead(const ChannelTest& matters) const override;
  void on_step(const bus::Now& now) override;
  void on_restart(const bus::Now& now) override;
  std::string status_text() const override;

 private:
  // Returns the next instant at which something is published without being asked for: tables, the scenario,
  // and the environment, periodically and when it changes.
  SimTime next_instant() const { return std::min({next_tick_, next_environment_, next_scenario_}); }
  void set_first_instants(SimTime now);
  // Publishes what is due at the instant; returns false when a table waits for the seabed or for another
  // server.
  [[nodiscard]] bool run_instant(SimTime instant, SimTime steady);
  [[nodiscard]] bool run_tick(SimTime tick, SimTime steady);
  // The link tables of a tick in preparation. Vehicles and links stay as they were at the tick, however long
  // the tables wait.
  struct Tables {
    SimTime tick;
    std::vector<std::unique_ptr<const VehicleModem>> modems;
    std::vector<PlacedVehicle> present;
    std::vector<double> ranges_m;
    TableRows rows;
    std::vector<EndPair> links_of_all;  // links of all servers; empty when this server is alone
    const std::vector<EndPair>& all_links() const { return links_of_all.empty() ? rows.links : links_of_all; }
    bool is_prepared = false;  // this server's eigenray searches are done
  };
  Tables begin_tables(SimTime tick);
  // Returns false when the seabed under the links is not known yet.
  [[nodiscard]] bool prepare(Tables& tables, SimTime steady);
  void advance_medium(SimTime time);
  // Applies the inputs of a step. `latest` is the time by CLOCK, which `now` may lag behind.
  void apply(StepInputs inputs, SimTime now, SimTime latest);
  void publish_environment(SimTime instant);
  void publish_scenario(SimTime instant);
  void forget_old(SimTime now);
  void answer_queries(const bus::Now& now);
  // Redoes recorded steps; returns true when the present is reached.
  [[nodiscard]] bool recover(const bus::Now& now);

  ServerRules rules_;
  bus::ThreadPool pool_;
  WaterModel water_;
  VehicleRegistry vehicles_;
  ReachModel reach_;
  PacketMedium medium_;
  PlatformNoise sounds_;
  PlatformReceiverNoise noise_;  // noise in link tables and in answers to queries
  LinkPredictor predictor_;
  MultipathCache echoes_;
  RayQueryClient rays_;
  LinkQueryService queries_;
  BestPlaceService places_;

  bus::NumberedPublisher publisher_;
  bus::CrashJournal journal_;
  Inbox inbox_;
  SeabedClient seabed_;
  ShardExchange exchange_;
  PacketPublisher packets_;
  LinkTablePublisher tables_;
  InputProcessor processor_;
  std::unique_ptr<ServerRecovery> recovery_;

  std::vector<scenario_info_t> scenario_;
  SimDuration scenario_period_;
  SimTime next_tick_, next_environment_, next_scenario_, next_forgetting_;
  std::optional<Tables> tables_in_work_;
  bool table_waits_ = false;
  bool shares_searches_ = false;
};

// Returns the node of a scenario. Throws InvalidArgument when the water or a modem is impossible.
std::unique_ptr<ChannelServerNode> make_channel_server(lcm::LCM& lcm, const bus::NodeIdentity& identity,
                                                       const ChannelServerConfig& config,
                                                       const bus::Scenario& scenario);

}  // namespace halocline::channel_server
