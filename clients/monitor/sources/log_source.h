// SPDX-License-Identifier: BSD-3-Clause
// A whole log as a source. What its configuration gives is computed by the nodes of log_nodes.h.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bus/messages.h"
#include "clients/halocline/analysis/mission_log.h"
#include "clients/mission/mission_store.h"
#include "clients/mission/node_health.h"
#include "clients/monitor/sources/handover.h"
#include "clients/monitor/sources/log_nodes.h"
#include "clients/monitor/sources/source.h"
#include "core/sim_time.h"

namespace halocline::monitor {

class LogSource : public Source {
 public:
  // Reads the log, or its parts in order. `scenario`: its configuration; empty: what it holds, or the file
  // beside it. Throws InvalidArgument when the log cannot be read, or holds nothing.
  LogSource(const std::vector<std::string>& logs, const std::string& scenario);

  void update() override;
  const clients::MissionStore& mission() const override { return mission_; }
  void set_terrain(const terrain_tile_t&) override {}  // update() takes that of the nodes
  int run() const override { return 0; }
  bool is_log() const override { return true; }
  std::string name() const override { return name_; }
  std::vector<std::string> limits() const override;
  SourceState state() const override;
  void post(const std::string& channel, bus::Bytes bytes) override;
  std::vector<BusMessage> take_replies() override { return std::exchange(replies_, {}); }
  void set_replies(std::function<bool(std::string_view channel)> is_reply) override {
    is_reply_ = std::move(is_reply);
  }
  bool names_stand_for_now() const override { return false; }
  SimTime now() const override { return mission_.end(); }
  double age_s(const clients::NodeRecord& node, SimTime at) const override;

 private:
  LogSource(const std::vector<std::string>& logs, clients::MissionLog log, const std::string& scenario);
  bool lacks_modem(std::string_view channel) const;
  // The nodes compute in the water that the log had at an instant.
  void set_water(SimTime at);

  std::string name_;
  std::vector<std::string> limits_;  // what of the log could not be read; empty for a whole one
  clients::MissionStore mission_;
  std::function<bool(std::string_view channel)> is_reply_;
  std::vector<BusMessage> replies_;
  std::optional<environment_t> nodes_water_;
  std::int64_t water_changes_ = 0;
  std::unique_ptr<LogNodes> nodes_;  // null without a configuration
};

}  // namespace halocline::monitor
