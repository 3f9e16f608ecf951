// SPDX-License-Identifier: BSD-3-Clause
// How the programs of a mission fare: what they count, how long they were silent, how fast simulation time
// passes.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "bus/messages.h"

namespace halocline::clients {

struct NodeRecord {
  node_status_t status{};               // the last one; its counters are since the node's start
  std::int64_t statuses = 0;            // that were received
  std::int64_t last_stamp_us = 0;       // of the last STATUS or HEARTBEAT, by the recorder's clock
  std::int64_t longest_silence_us = 0;  // between two of them
  std::int64_t incarnations = 0;        // sessions: more than one, and it was started again
  double lateness_max_s = 0;            // its results' greatest, over all statuses (node_status_t)

  bool held_real_time() const {
    return status.lateness_limit_s == 0 || lateness_max_s <= status.lateness_limit_s;
  }
};

class NodeHealth {
 public:
  // Stamps are those of the recorder or receiver: wall time, but simulation time in the log of a lockstep
  // run.
  void add_status(std::int64_t stamp_us, const std::string& node, const node_status_t& status);
  void add_heartbeat(std::int64_t stamp_us, const std::string& node);
  void add_clock(std::int64_t stamp_us, const sim_clock_t& clock);

  const std::map<std::string, NodeRecord>& nodes() const { return nodes_; }
  // Simulated seconds per second of the stamps, over the last ten of these; empty before the second CLOCK,
  // and where stamps are simulation time.
  std::optional<double> real_time_factor() const;
  // Over all nodes, of their last statuses.
  std::int64_t total(std::int64_t node_status_t::*counter) const;

 private:
  NodeRecord& alive(std::int64_t stamp_us, const std::string& node);

  struct Tick {
    std::int64_t stamp_us, utime;
  };
  std::map<std::string, NodeRecord> nodes_;
  std::deque<Tick> ticks_;
};

}  // namespace halocline::clients
