// SPDX-License-Identifier: BSD-3-Clause
// A small timeline, and a source that shows it, for tests of what pages are shown.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/sim_time.h"
#include "runs/timeline/node_health.h"
#include "runs/timeline/run_timeline.h"
#include "tests/runs/timeline/timeline_fixtures.h"
#include "viewer/sources/handover.h"
#include "viewer/sources/source.h"

namespace halocline::monitor::testing {

using clients::testing::add;
using clients::testing::kSecond;

// auv-1 goes north at 1 m/s from 0 to 100 s, auv-2 rests 1500 m east; packets of auv-1 depart at 10, 50 and
// 90 s: the first is received, the second lost, the third refused.
inline clients::RunTimeline small_run() {
  namespace ct = clients::testing;
  clients::RunTimeline timeline;
  for (int s = 0; s <= 100; ++s) {
    add(timeline, "STATE.auv-1", ct::state(4, s * kSecond, s, 0, 20));
    add(timeline, "STATE.auv-2", ct::state(9, s * kSecond, 0, 1500, 50));
  }
  add(timeline, "SEND.auv-1", ct::send(4, 0, 10 * kSecond));
  add(timeline, "RECEIPT.auv-1", ct::receipt(0, 10 * kSecond));
  add(timeline, "OUTCOME", ct::outcome(4, 9, 0, 10 * kSecond));
  add(timeline, "SEND.auv-1", ct::send(4, 1, 50 * kSecond));
  add(timeline, "RECEIPT.auv-1", ct::receipt(1, 50 * kSecond));
  add(timeline, "OUTCOME", ct::outcome(4, 9, 1, 50 * kSecond, packet_outcome_t::BELOW_CUTOFF));
  add(timeline, "SEND.auv-1", ct::send(4, 2, 90 * kSecond));
  add(timeline, "RECEIPT.auv-1", ct::receipt(2, 90 * kSecond, modem_receipt_t::REFUSED_BUSY));
  link_table_t table{};
  table.utime = 60 * kSecond;
  table.vehicle_id = 4;
  table.num_peers = 1;
  link_t row{};
  row.transmitter_id = 4;
  row.receiver_id = 9;
  row.range_m = 1500;
  row.snr_db = 12;
  row.sinr_db = 11;
  row.delay_spread_s = 0.004;
  row.first_path_doppler_factor = 1.0002;
  row.delivery_probability = 0.25;
  row.num_paths = 3;
  table.peers = {row};
  add(timeline, "LINKS.auv-1", table);
  return timeline;
}

// Shows a timeline as a log or as a bus.
class FixedSource : public Source {
 public:
  explicit FixedSource(bool is_log, clients::RunTimeline timeline = small_run())
      : is_log_(is_log), timeline_(std::move(timeline)) {}

  void update() override {}
  const clients::RunTimeline& timeline() const override { return timeline_; }
  clients::RunTimeline& timeline() { return timeline_; }
  void set_terrain(const terrain_tile_t&) override {}
  int run() const override { return 0; }
  bool is_log() const override { return is_log_; }
  std::string name() const override { return "test"; }
  std::vector<std::string> limits() const override { return {}; }
  SourceState state() const override { return state_; }
  void post(const std::string&, bus::Bytes) override {}
  std::vector<BusMessage> take_replies() override { return {}; }
  void set_replies(std::function<bool(std::string_view channel)>) override {}
  bool names_stand_for_now() const override { return !is_log_; }
  SimTime now() const override { return timeline_.end(); }
  double age_s(const clients::NodeRecord&, SimTime) const override { return 0; }

  SourceState state_;

 private:
  bool is_log_;
  clients::RunTimeline timeline_;
};

}  // namespace halocline::monitor::testing
