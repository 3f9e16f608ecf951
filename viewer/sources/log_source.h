// SPDX-License-Identifier: BSD-3-Clause
// Log of a whole run as a source. The nodes of log_nodes.h compute what can be derived from its
// configuration.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bus/messages/messages.h"
#include "core/sim_time.h"
#include "runs/analysis/read_timeline.h"
#include "runs/timeline/node_health.h"
#include "runs/timeline/run_timeline.h"
#include "viewer/sources/handover.h"
#include "viewer/sources/log_nodes.h"
#include "viewer/sources/source.h"

namespace halocline::monitor {

class LogSource : public Source {
 public:
  // Reads the log, or its parts in order. `scenario`: file of its configuration; empty: the one in the log,
  // or the file beside it. Throws InvalidArgument when the log cannot be read, or is empty.
  LogSource(const std::vector<std::string>& logs, const std::string& scenario);

  void update() override;
  const clients::RunTimeline& timeline() const override { return timeline_; }
  void set_terrain(const terrain_tile_t&) override {}  // update() adds that of the nodes
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
  SimTime now() const override { return timeline_.end(); }
  double age_s(const clients::NodeRecord& node, SimTime at) const override;

 private:
  LogSource(const std::vector<std::string>& logs, clients::LoggedTimeline log, const std::string& scenario);
  bool lacks_modem(std::string_view channel) const;
  // Changes the water in which the nodes compute to that which the log had at one time.
  void set_water(SimTime at);

  std::string name_;
  std::vector<std::string> limits_;  // sentences on unreadable parts; empty for a whole log
  clients::RunTimeline timeline_;
  std::function<bool(std::string_view channel)> is_reply_;
  std::vector<BusMessage> replies_;
  std::optional<environment_t> nodes_water_;
  std::int64_t water_changes_ = 0;
  std::unique_ptr<LogNodes> nodes_;  // null without a configuration
};

}  // namespace halocline::monitor
