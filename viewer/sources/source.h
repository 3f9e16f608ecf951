// SPDX-License-Identifier: BSD-3-Clause
// Source of the monitor's messages: a bus or a log. It is used by one thread; a bus is received by another
// thread behind it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bus/messages/message_codec.h"
#include "core/sim_time.h"
#include "runs/timeline/node_health.h"
#include "runs/timeline/run_timeline.h"
#include "viewer/sources/handover.h"
#include "viewer/sources/modems.h"

namespace halocline::monitor {

enum class BusCondition { kLive, kSilent, kReconnecting, kNone };

struct SourceState {
  BusCondition bus = BusCondition::kNone;
  double silent_s = 0;                              // time since the last message when kSilent, wall time, s
  bool bathymetry = false, channel_server = false;  // true: answers requests now
  std::optional<double> real_time_factor = {};      // simulated seconds per wall second; none on a log
  std::int64_t messages_dropped = 0;                // messages for which the monitor was too slow
};

class Source {
 public:
  virtual ~Source() = default;

  // Adds the messages since the last call to timeline(), and collects replies.
  virtual void update() = 0;
  virtual const clients::RunTimeline& timeline() const = 0;
  // Sets the terrain when no TERRAIN was received.
  virtual void set_terrain(const terrain_tile_t& overview) = 0;
  // Returns a number that increases when another run begins; timeline() then contains nothing of the previous
  // one.
  virtual int run() const = 0;

  virtual bool is_log() const = 0;
  virtual std::string name() const = 0;  // path of the log or URL of the bus
  // Returns sentences on what cannot be shown, why, and what to do.
  virtual std::vector<std::string> limits() const = 0;
  virtual SourceState state() const = 0;
  // Publishes a query or a command, on the bus or to the nodes that answer for a log.
  virtual void post(const std::string& channel, bus::Bytes bytes) = 0;
  // Returns the replies since the last call: messages on the channels of this program alone, which
  // set_replies() defines.
  virtual std::vector<BusMessage> take_replies() = 0;
  virtual void set_replies(std::function<bool(std::string_view channel)> is_reply) = 0;
  // Returns true when queries by name are answered for the present only.
  virtual bool names_stand_for_now() const = 0;
  // Returns the newest time; before the first message, a time earlier than timeline().begin().
  virtual SimTime now() const = 0;
  // Returns the SINR threshold of a modem, dB (modems.h).
  std::optional<double> threshold_db(const modem_config_t& modem) const { return thresholds_.of(modem); }
  // Returns the age of a node's last STATUS, s: in wall time on a bus, in simulation time in a log.
  virtual double age_s(const clients::NodeRecord& node, SimTime at) const = 0;

 private:
  mutable ModemThresholds thresholds_;
};

}  // namespace halocline::monitor
