// SPDX-License-Identifier: BSD-3-Clause
// Timeline of a run, built from its messages: the one source of numbers for reports and monitors.
//
//   RunTimeline store;
//   while (log.next(event)) store.add(event.stamp_us, event.channel, event.data);
//   const auto place = state_at(store.vehicles()[0].track, SimTime::from_seconds(60));
//
// The store accepts the messages of a bus or a log in any order and of any kind. A message on an unknown
// channel, or one that does not decode or is not valid, is counted and left out. Times are simulation time,
// taken from each message (run_time_base.h); a message without a time takes the latest time that was reached.
// The store reads no file, opens no socket and reads no clock. Not thread-safe.
//
// Memory is bounded by TimelineLimits: the series of vehicles are thinned together (timed_series.h), and the
// oldest packets are dropped while the ledger keeps counting all of them. limit_history() drops old data, for
// a bus that never ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "bus/messages/messages.h"
#include "core/sim_time.h"
#include "runs/timeline/link_history.h"
#include "runs/timeline/node_health.h"
#include "runs/timeline/outcome_ledger.h"
#include "runs/timeline/packet_book.h"
#include "runs/timeline/run_time_base.h"
#include "runs/timeline/terrain_overview.h"
#include "runs/timeline/timed_series.h"
#include "runs/timeline/vehicle_record.h"

namespace halocline::clients {

// Bounds of memory, as numbers of entries.
struct TimelineLimits {
  std::size_t samples = 3'000'000;    // entries in all series of vehicles, about 200 bytes each
  std::size_t link_rows = 1'000'000;  // about 200 bytes each
  std::size_t outcomes = 1'000'000;   // about 300 bytes each
};

struct RunOrigin {
  double latitude_deg = 0, longitude_deg = 0;  // origin of the world frame, WGS 84
};

// Description of the scenario; texts are empty and numbers 0 where it is not known.
struct RunScenario {
  std::string name, description;
  std::string toml;  // the effective configuration
  std::int64_t seed = 0;
  std::optional<RunOrigin> origin;  // empty: stated neither in the log nor in its scenario
  double sea_surface_z_m = 0;
  double duration_s = 0;
};

struct TimelineCounts {
  std::int64_t messages = 0;      // passed to add()
  std::int64_t unknown = 0;       // on a channel that is none of Halocline's
  std::int64_t undecodable = 0;   // not a valid message of their channel's type
  std::int64_t without_time = 0;  // their utime is 0 or from another clock (run_time_base.h)
};

class RunTimeline {
 public:
  explicit RunTimeline(RunTimeBase time = {}, TimelineLimits limits = {});

  // Adds a message. `stamp_us` is the time at which the recorder or receiver got it, us.
  void add(std::int64_t stamp_us, std::string_view channel, std::span<const std::uint8_t> bytes);

  // Drops from now on what is older than the latest message by more than `history`, which must be above 0.
  void limit_history(SimDuration history);

  // Returns the vehicles in the order of their first message. Indices and addresses stay valid while vehicles
  // are added.
  const std::deque<VehicleRecord>& vehicles() const { return vehicles_; }
  const VehicleRecord* find(std::string_view name) const;  // null when there is none
  const VehicleRecord* find(std::int32_t id) const;
  std::string name(std::int32_t id) const;  // the id as text when no vehicle has it

  const PacketBook& packets() const { return packets_; }
  // Returns the counts of all outcomes ever added, in windows of a minute.
  const OutcomeLedger& ledger() const { return ledger_; }
  std::int64_t repeated_outcomes() const { return repeated_outcomes_; }
  const LinkHistory& links() const { return links_; }
  const TimedSeries<environment_t>& water() const { return water_; }
  const NodeHealth& health() const { return health_; }
  const TimelineCounts& counts() const { return counts_; }

  const RunScenario& scenario() const { return scenario_; }
  void set_scenario(RunScenario scenario) { scenario_ = std::move(scenario); }
  const std::optional<TerrainOverview>& terrain() const { return terrain_; }
  void set_terrain(TerrainOverview terrain) { terrain_ = std::move(terrain); }
  // Returns z of the seabed below a place, m; NaN where it is not known.
  double seabed_m(double north_m, double east_m) const;

  // Instants of the first and the last message with a time. begin() > end() before there is one.
  SimTime begin() const { return begin_; }
  SimTime end() const { return end_; }

 private:
  // Envelope of a message that is being processed.
  struct Received {
    std::int64_t stamp_us;
    std::string name;  // the channel without its family: the vehicle's or node's name
    SimTime at;
  };
  template <class Message>
  void decode_and_take(std::int64_t stamp_us, std::string_view channel, std::span<const std::uint8_t> bytes);
  void take(const Received& received, const vehicle_state_t& state);
  void take(const Received& received, const vehicle_sensors_t& sensors);
  void take(const Received& received, const vehicle_command_t& command);
  void take(const Received& received, const vehicle_fault_t& fault);
  void take(const Received& received, const vehicle_gps_t& fix);
  void take(const Received& received, const position_estimate_t& estimate);
  void take(const Received& received, const modem_config_t& modem);
  void take(const Received& received, modem_send_t send);
  void take(const Received& received, modem_receipt_t receipt);
  void take(const Received& received, packet_outcome_t outcome);
  void take(const Received& received, const link_table_t& table);
  void take(const Received& received, const environment_t& water);
  void take(const Received& received, const scenario_info_t& part);
  void take(const Received& received, const terrain_tile_t& tile);
  void take(const Received& received, const vehicle_plan_t& plan);
  void take(const Received& received, const autopilot_status_t& status);
  void take(const Received& received, const node_status_t& status);
  void take(const Received& received, const flow_heartbeat_t& heartbeat);
  void take(const Received& received, const sim_clock_t& clock);

  // Returns the vehicle of that name, which is added when it is not known yet. `id` 0 means: not known.
  VehicleRecord& vehicle(const std::string& name, std::int32_t id);
  VehicleRecord& vehicle(std::int32_t id);
  void give_id(VehicleRecord& vehicle, std::int32_t id);
  template <class Value>
  void keep(TimedSeries<Value>& series, SimTime at, const Value& value);
  // Thins the series of all vehicles when they exceed TimelineLimits::samples.
  void keep_limits();
  void drop_old();

  RunTimeBase time_;
  TimelineLimits limits_;
  SimDuration history_;  // 0: unlimited
  SimTime begin_ = SimTime::never(), end_ = SimTime::at_once(), dropped_before_ = SimTime::at_once();
  std::deque<VehicleRecord> vehicles_;
  std::map<std::string, std::size_t, std::less<>> by_name_;
  std::map<std::int32_t, std::size_t> by_id_;
  std::size_t samples_ = 0;
  PacketBook packets_;
  OutcomeLedger ledger_{60'000'000};
  std::int64_t repeated_outcomes_ = 0;
  LinkHistory links_;
  TimedSeries<environment_t> water_;
  NodeHealth health_;
  TimelineCounts counts_;
  RunScenario scenario_, scenario_parts_;  // complete; assembled so far
  std::int32_t next_part_ = 0;
  std::optional<TerrainOverview> terrain_;
};

}  // namespace halocline::clients
