// SPDX-License-Identifier: BSD-3-Clause
// The acoustic side of a formation: a leader's reports out on a time grid, those of the leaders it follows
// in.
//
// Reports start at start + k period; one whose instant passed while nothing ran is not sent late. The
// position in a report is the latest situation's, stamped with its own time.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "bus/runtime/node.h"
#include "clients/autopilot/autopilot_config.h"
#include "clients/autopilot/formation.h"
#include "clients/autopilot/vehicle_pilot.h"
#include "clients/modem/modem_client.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::clients {

class FormationLink {
 public:
  using Listener = std::function<void(const std::string& leader, const LeaderReport& report)>;

  // `leaders`: id to name of those whose reports are passed on. Bus and listener must outlive the link.
  FormationLink(bus::Bus& bus, const PilotConfig& pilot, std::map<std::int32_t, std::string> leaders,
                Listener listener);

  // Sends the report that is due, and repeats what the bus may have lost.
  void step(const bus::Now& now, const std::optional<Situation>& situation);
  bus::Due due() const { return {.sim = next_report_, .steady = modem_.next_resend()}; }
  void restart(SimTime now);
  void archive(Archive& a) { a(modem_, next_report_); }

 private:
  void take(const modem_receive_t& packet) const;

  Broadcast broadcast_;
  std::map<std::int32_t, std::string> leaders_;
  Listener listener_;
  ModemClient modem_;
  SimTime next_report_;
};

}  // namespace halocline::clients
