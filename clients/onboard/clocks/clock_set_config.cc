// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/clocks/clock_set_config.h"

#include <cstddef>

#include "channel_server/modems/clock_config.h"

namespace halocline::clients {
namespace {

void visit_vehicle(bus::ConfigVisitor& v, std::vector<channel_server::ClockOf>& clocks) {
  v.shared_with_others();
  channel_server::ClockOf clock;
  v.text("name", clock.vehicle, {}, "");
  bus::integer_as(v, "id", clock.id, {1, 2147483647, "", ""});
  if (!v.given("clock")) return;
  v.section("clock", "",
            [&](bus::ConfigVisitor& section) { channel_server::visit_clock(section, clock.settings); });
  clocks.push_back(clock);
}

}  // namespace

void visit(bus::ConfigVisitor& v, ClockSetConfig& config) {
  if (v.writing()) return;
  std::size_t vehicles = 0;
  config.clocks.clear();
  v.list(
      "vehicle", "", 0, [&](std::size_t n) { vehicles = n; },
      [&](bus::ConfigVisitor& item, std::size_t) { visit_vehicle(item, config.clocks); });
  v.section("scenario", "", [&](bus::ConfigVisitor& section) {
    section.shared_with_others();
    bus::integer_as(section, "seed", config.seed, {0, 9e15, "", ""});
  });
  v.section("channel_server", "", [&](bus::ConfigVisitor& section) {
    section.shared_with_others();
    bus::seconds(section, "state_lag_s", config.fix_lag, {0, 10, "s", ""});
  });
}

}  // namespace halocline::clients
