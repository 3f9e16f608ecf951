// SPDX-License-Identifier: BSD-3-Clause
// Modem traffic of a formation: broadcasts a leader's reports on a time grid and receives those of the
// leaders that are followed.
//
// Reports are due at start + k period by the vehicle's clock; a report whose instant passed while the node
// was not running is not sent late. A report holds the position of the latest situation, with that
// situation's time by the sender's clock. The receiver reads the time as one of its own clock, so a
// difference between the two clocks misdates the report.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "bus/runtime/node.h"
#include "clients/modem/modem_client.h"
#include "clients/onboard/autopilot/autopilot_config.h"
#include "clients/onboard/autopilot/formation.h"
#include "clients/onboard/autopilot/vehicle_pilot.h"
#include "clients/onboard/clocks/vehicle_time.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::clients {

class FormationLink {
 public:
  using Listener = std::function<void(const std::string& leader, const LeaderReport& report)>;

  // `leaders`: id and name of each vehicle whose reports are passed on. Bus, listener and clocks must outlive
  // the link.
  FormationLink(bus::Bus& bus, const PilotConfig& pilot, std::map<std::int32_t, std::string> leaders,
                Listener listener, const VehicleTime& clocks);

  // Sends the report that is due, and resends packets that the bus may have lost.
  void step(const bus::Now& now, const std::optional<Situation>& situation);
  bus::Due due() const {
    return {.sim = clocks_.due(own_id(), next_report_), .steady = modem_.next_resend()};
  }
  void restart(SimTime now);
  void archive(Archive& a) { a(modem_, next_report_); }

 private:
  std::int32_t own_id() const { return modem_.address().vehicle_id; }
  // Returns how far the vehicle's clock is ahead of simulation time, s.
  double clock_error_s(double time_s) const;
  void take(const modem_receive_t& packet) const;
  void send(SimTime steady, SimTime at, LeaderReport report);

  Broadcast broadcast_;
  std::map<std::int32_t, std::string> leaders_;
  Listener listener_;
  ModemClient modem_;
  const VehicleTime& clocks_;
  SimTime next_report_;  // instant of the next report, by the vehicle's clock
};

}  // namespace halocline::clients
