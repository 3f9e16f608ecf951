// SPDX-License-Identifier: BSD-3-Clause
// Health of the programs of a run: their counters, how long they were silent, and how fast simulation time
// passes.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "bus/messages/messages.h"

namespace halocline::clients {

struct NodeRecord {
  node_status_t status{};               // last STATUS; its counters start at 0 with the node
  std::int64_t statuses = 0;            // number of STATUS messages received
  std::int64_t last_stamp_us = 0;       // stamp of the last STATUS or HEARTBEAT, by the recorder's clock
  std::int64_t longest_silence_us = 0;  // longest time between two of these
  std::int64_t incarnations = 0;        // number of sessions; above 1 the node was restarted
  double lateness_max_s = 0;            // greatest lateness of its results in any STATUS (node_status_t)

  bool held_real_time() const {
    return status.lateness_limit_s == 0 || lateness_max_s <= status.lateness_limit_s;
  }
};

// Records of all programs, and the rate of simulation time.
class NodeHealth {
 public:
  // Stamps are times of the recorder or receiver: wall time, but simulation time in the log of a lockstep
  // run.
  void add_status(std::int64_t stamp_us, const std::string& node, const node_status_t& status);
  void add_heartbeat(std::int64_t stamp_us, const std::string& node);
  void add_clock(std::int64_t stamp_us, const sim_clock_t& clock);

  const std::map<std::string, NodeRecord>& nodes() const { return nodes_; }
  // Returns the simulated seconds per second of the stamps, over the last ten seconds of these. Empty before
  // the second CLOCK, and when the stamps are simulation time themselves.
  std::optional<double> real_time_factor() const;

 private:
  NodeRecord& alive(std::int64_t stamp_us, const std::string& node);

  struct Tick {
    std::int64_t stamp_us, utime;
  };
  std::map<std::string, NodeRecord> nodes_;
  std::deque<Tick> ticks_;
};

}  // namespace halocline::clients
