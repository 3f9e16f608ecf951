// SPDX-License-Identifier: BSD-3-Clause
// One run of the simulation in the channel server: vehicles, packets, link tables and queries, from the first
// instant on. When simulation time jumps back another run begins, and the node constructs it again: no member
// keeps anything of the run before.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/messages/messages.h"
#include "bus/numbered_publisher.h"
#include "bus/recovery/crash_journal.h"
#include "bus/runtime/node.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/inbox.h"
#include "channel_server/input_processor.h"
#include "channel_server/link_table_publisher.h"
#include "channel_server/links/best_place_service.h"
#include "channel_server/links/link_predictor.h"
#include "channel_server/links/link_query_service.h"
#include "channel_server/packet_publisher.h"
#include "channel_server/packets/packet_medium.h"
#include "channel_server/packets/platform_noise.h"
#include "channel_server/propagation/reach.h"
#include "channel_server/seabed_client.h"
#include "channel_server/shards/shard_exchange.h"
#include "channel_server/table_tick.h"
#include "channel_server/vehicles/vehicle_equipment.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "channel_server/water_model.h"
#include "core/for_each.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

// An instant before every time that a message may hold: due as soon as simulation time is known.
inline constexpr SimTime kBeforeAll = SimTime::from_nanoseconds(-4'000'000'000'000'000'000);

// What the scenario and the configuration say of a server.
struct ServerSetup {
  ServerRules rules;
  ConfiguredModems modems;
  VehicleEquipment equipment;
  std::vector<scenario_info_t> scenario;  // contents of SCENARIO (scenario_messages.h); empty: not published
};

class ServerRun {
 public:
  // What lasts from run to run; all must outlive the run.
  struct Parts {
    const ServerSetup& setup;
    const WaterModel& water;
    SeabedClient& seabed;
    ShardExchange* exchange;  // null when this server shares no searches with others
    bus::Bus& bus;
    bus::NumberedPublisher& publisher;
    bus::CrashJournal& journal;
    ForEach for_each;
  };
  explicit ServerRun(const Parts& parts);
  ServerRun(const ServerRun&) = delete;
  ServerRun& operator=(const ServerRun&) = delete;

  // Returns the next instant at which something is published without being asked for: tables, the scenario,
  // and the environment, periodically and when it changes.
  SimTime next_instant() const { return std::min({next_tick_, next_environment_, next_scenario_}); }
  SimTime due() const;          // simulation time
  SimTime queries_due() const;  // steady time
  // Returns when an answer of a modem may be decided next (PacketMedium::next_answerable).
  SimTime next_answerable() const { return medium_.next_answerable(); }

  // Begins the tables of the tick again, and publishes the environment, because the terrain is another one.
  void take_terrain();
  // Applies the inputs of a step. `latest` is the time by CLOCK, which `now` may lag behind.
  void apply(StepInputs inputs, SimTime now, SimTime latest);
  // Publishes everything that is due up to `now`, except what waits for the seabed or for another server.
  void advance_to(SimTime now, SimTime steady);
  // True when packets wait for the seabed.
  bool is_waiting() const { return medium_.is_waiting(); }
  void forget_old(SimTime now);
  // Takes the queries of a step, and publishes the replies that are complete.
  void answer_queries(Inbox& inbox, const bus::Now& now);

  const PacketPublisher& packets() const { return packets_; }
  std::string status_text() const;

 private:
  void set_first_instants(SimTime now);
  // Publishes what is due at the instant; returns false when its tables wait.
  [[nodiscard]] bool run_instant(SimTime instant, SimTime steady);
  [[nodiscard]] bool run_tick(SimTime tick, SimTime steady);
  bool tables_wait() const { return tables_ && tables_->tick() == next_tick_; }
  void advance_medium(SimTime time);
  void publish_environment(SimTime instant);
  void publish_scenario(SimTime instant);

  Parts parts_;
  const ServerRules& rules_;
  SimDuration scenario_period_;
  VehicleRegistry vehicles_;
  ReachModel reach_;
  PacketMedium medium_;
  PlatformNoise sounds_;
  PlatformReceiverNoise noise_;  // noise in link tables and in answers to queries
  LinkPredictor predictor_;
  LinkQueryService queries_;
  BestPlaceService places_;
  PacketPublisher packets_;
  InputProcessor processor_;
  LinkTablePublisher table_publisher_;
  std::optional<TableTick> tables_;  // of the tick that waits
  SimTime next_tick_ = kBeforeAll, next_environment_ = kBeforeAll, next_scenario_ = kBeforeAll,
          next_forgetting_ = kBeforeAll;
};

}  // namespace halocline::channel_server
