// SPDX-License-Identifier: BSD-3-Clause
#include "tests/integration/bus_monitor.h"

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace halocline::testing {

BusMonitor::BusMonitor() : lcm_(bus::open_transport(bus::effective_url(""))), bus_(*lcm_, {"monitor", 0}) {
  lcm_->subscribe(".*", &BusMonitor::on_any, this)->setQueueCapacity(100'000);
  bus_.subscribe<link_table_t>(bus::channels::kLinks, [this](std::string_view, const link_table_t& table) {
    tables.push_back(table);
  });
  bus_.subscribe<packet_outcome_t>(bus::channels::kOutcome,
                                   [this](const packet_outcome_t& outcome) { outcomes.push_back(outcome); });
  bus_.subscribe<node_status_t>(bus::channels::kStatus,
                                [this](std::string_view node, const node_status_t& status) {
                                  node_status_t& last = last_status[std::string(node)];
                                  // An old status that another node requested again is not the last one.
                                  if (status.session == last.session && status.sequence < last.sequence)
                                    return;
                                  last = status;
                                });
  bus_.subscribe<sim_clock_t>(bus::channels::kClock,
                              [this](const sim_clock_t& clock) { last_clock_utime = clock.utime; });
}

void BusMonitor::dispatch_for(double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  while (Clock::now() < end) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    lcm_->handleTimeout(static_cast<int>(left < 1 ? 1 : left));
  }
}

std::int64_t BusMonitor::received(const std::string& channel) const {
  const auto found = counts_.find(channel);
  return found == counts_.end() ? 0 : found->second;
}

}  // namespace halocline::testing
