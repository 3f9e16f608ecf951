// SPDX-License-Identifier: BSD-3-Clause
// Bus as a source: its present messages and its recent past.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/sim_time.h"
#include "runs/timeline/node_health.h"
#include "runs/timeline/run_timeline.h"
#include "runs/timeline/terrain_overview.h"
#include "viewer/sources/bus_receiver.h"
#include "viewer/sources/handover.h"
#include "viewer/sources/source.h"

namespace halocline::monitor {

class BusSource : public Source {
 public:
  // `history`: the duration of the past that is kept.
  BusSource(const std::string& lcm_url, const std::string& accept, SimDuration history);

  void update() override;
  const clients::RunTimeline& timeline() const override { return timeline_; }
  void set_terrain(const terrain_tile_t& overview) override {
    timeline_.set_terrain(clients::TerrainOverview::from(overview));
  }
  int run() const override { return run_; }
  bool is_log() const override { return false; }
  std::string name() const override { return url_; }
  std::vector<std::string> limits() const override { return {}; }
  SourceState state() const override;
  void post(const std::string& channel, bus::Bytes bytes) override {
    receiver_.post(channel, std::move(bytes));
  }
  std::vector<BusMessage> take_replies() override { return std::exchange(replies_, {}); }
  void set_replies(std::function<bool(std::string_view channel)> is_reply) override {
    is_reply_ = std::move(is_reply);
  }
  bool names_stand_for_now() const override { return true; }
  SimTime now() const override;
  double age_s(const clients::NodeRecord& node, SimTime at) const override;

 private:
  void begin_run();
  // Adds MODEM messages, made from the recorded configuration, for vehicles that published none.
  void take_scenario_modems();
  bool is_alive(std::string_view prefix) const;

  std::string url_;
  SimDuration history_;
  clients::RunTimeline timeline_;
  BusReceiver receiver_;
  std::function<bool(std::string_view channel)> is_reply_;
  std::vector<BusMessage> replies_;
  std::string configuration_;  // configuration whose modems were added
  int run_ = 0;
  SimTime last_message_;  // steady time
  std::int64_t received_ = 0;
};

}  // namespace halocline::monitor
