// SPDX-License-Identifier: BSD-3-Clause
// Where the monitor's messages come from: a bus or a log. Used by one thread; a bus is received by another
// behind it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bus/message_codec.h"
#include "clients/mission/mission_store.h"
#include "clients/mission/node_health.h"
#include "clients/monitor/sources/handover.h"
#include "clients/monitor/sources/modems.h"
#include "core/sim_time.h"

namespace halocline::monitor {

enum class BusCondition { kLive, kSilent, kReconnecting, kNone };

struct SourceState {
  BusCondition bus = BusCondition::kNone;
  double silent_s = 0;                              // of kSilent, wall time
  bool bathymetry = false, channel_server = false;  // answer requests now
  std::optional<double> real_time_factor = {};
  std::int64_t messages_dropped = 0;  // that the monitor was too slow for
};

class Source {
 public:
  virtual ~Source() = default;

  // Takes up what came since the last call; hands over answers.
  virtual void update() = 0;
  virtual const clients::MissionStore& mission() const = 0;
  // The terrain, where no TERRAIN was received.
  virtual void set_terrain(const terrain_tile_t& overview) = 0;
  // Grows when another run has begun: mission() holds nothing of the one before.
  virtual int run() const = 0;

  virtual bool is_log() const = 0;
  virtual std::string name() const = 0;  // the log's path or the bus' URL
  // Sentences: what it cannot show, why, and what to do.
  virtual std::vector<std::string> limits() const = 0;
  virtual SourceState state() const = 0;
  // Publishes a query, or a command; on the bus, or to the nodes that answer for a log.
  virtual void post(const std::string& channel, bus::Bytes bytes) = 0;
  // What was received since the last call on channels whose messages are for this program alone
  // (set_replies).
  virtual std::vector<BusMessage> take_replies() = 0;
  virtual void set_replies(std::function<bool(std::string_view channel)> is_reply) = 0;
  // Whether queries are answered for the present alone, by name.
  virtual bool names_stand_for_now() const = 0;
  // The newest instant; before the first message that of mission().begin() - anything.
  virtual SimTime now() const = 0;
  // Of a modem, dB (modems.h).
  std::optional<double> threshold_db(const modem_config_t& modem) const { return thresholds_.of(modem); }
  // Of a node's last sign of life, seconds: wall time on a bus, simulation time in a log.
  virtual double age_s(const clients::NodeRecord& node, SimTime at) const = 0;

 private:
  mutable ModemThresholds thresholds_;
};

}  // namespace halocline::monitor
