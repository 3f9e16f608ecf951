// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/node_health.h"

#include <algorithm>

namespace halocline::clients {
namespace {

constexpr std::int64_t kRatedOver_us = 10'000'000;

}  // namespace

NodeRecord& NodeHealth::alive(std::int64_t stamp_us, const std::string& node) {
  NodeRecord& record = nodes_[node];
  if (record.last_stamp_us > 0)
    record.longest_silence_us = std::max(record.longest_silence_us, stamp_us - record.last_stamp_us);
  record.last_stamp_us = std::max(record.last_stamp_us, stamp_us);
  return record;
}

void NodeHealth::add_status(std::int64_t stamp_us, const std::string& node, const node_status_t& status) {
  NodeRecord& record = alive(stamp_us, node);
  if (record.statuses == 0 || record.status.session != status.session) ++record.incarnations;
  record.status = status;
  record.lateness_max_s = std::max(record.lateness_max_s, status.lateness_max_s);
  ++record.statuses;
}

void NodeHealth::add_heartbeat(std::int64_t stamp_us, const std::string& node) { alive(stamp_us, node); }

void NodeHealth::add_clock(std::int64_t stamp_us, const sim_clock_t& clock) {
  if (!ticks_.empty() && (stamp_us <= ticks_.back().stamp_us || clock.utime < ticks_.back().utime))
    ticks_.clear();
  ticks_.push_back({stamp_us, clock.utime});
  while (ticks_.front().stamp_us < stamp_us - kRatedOver_us) ticks_.pop_front();
}

std::optional<double> NodeHealth::real_time_factor() const {
  const auto is_simulated = [](const Tick& tick) { return tick.stamp_us == tick.utime; };
  if (ticks_.size() < 2 || std::all_of(ticks_.begin(), ticks_.end(), is_simulated)) return std::nullopt;
  return static_cast<double>(ticks_.back().utime - ticks_.front().utime) /
         static_cast<double>(ticks_.back().stamp_us - ticks_.front().stamp_us);
}

}  // namespace halocline::clients
