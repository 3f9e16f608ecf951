// SPDX-License-Identifier: BSD-3-Clause
// The channel server as a node on the bus. It receives states, modems and transmissions of vehicles;
// publishes the scenario, the water, the link tables and the outcome of every packet; and answers queries of
// links and of best places. --interface lists its channels.
//
// From a STATE to LINKS the walk is Inbox, InputProcessor, VehicleRegistry, TableTick, links/link_table.h,
// link_messages.h; ServerRun calls them in this order.
//
// Several servers may share the water (rules.medium.shard). Each receives what all others receive and
// publishes its share; the first one also publishes ENVIRONMENT and SCENARIO; a query is answered by the
// server given by its request_id. MODEM_REPLY passes on answers to pings, FOUND_PATHS the eigenrays that two
// servers need. With a journal, a server that was killed resumes where it was (server_recovery.h).
#pragma once

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
#include "channel_server/seabed_client.h"
#include "channel_server/server_recovery.h"
#include "channel_server/server_run.h"
#include "channel_server/shards/shard_exchange.h"
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
  // Constructs the run, in place of an earlier one.
  void begin_run();
  // Redoes recorded steps; returns true when the present is reached.
  [[nodiscard]] bool recover(const bus::Now& now);

  // What lasts from run to run.
  ServerSetup setup_;
  bus::ThreadPool pool_;
  WaterModel water_;
  bus::NumberedPublisher publisher_;
  bus::CrashJournal journal_;
  Inbox inbox_;
  SeabedClient seabed_;
  ShardExchange exchange_;
  bool shares_searches_;

  std::unique_ptr<ServerRecovery> recovery_;
  std::optional<ServerRun> run_;  // never empty
};

// Returns the node of a scenario. Throws InvalidArgument when the water or a modem is impossible.
std::unique_ptr<ChannelServerNode> make_channel_server(lcm::LCM& lcm, const bus::NodeIdentity& identity,
                                                       const ChannelServerConfig& config,
                                                       const bus::Scenario& scenario);

}  // namespace halocline::channel_server
