// SPDX-License-Identifier: BSD-3-Clause
// What is known of modems beyond the messages: those that a configuration gives the vehicles, and what SINR a
// modem needs.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bus/message_codec.h"
#include "bus/messages.h"
#include "clients/monitor/sources/handover.h"
#include "core/sim_time.h"

namespace halocline::channel_server {
struct VehicleModem;
}

namespace halocline::monitor {

// MODEM of a vehicle from `from` on. A modem of a file of its own, which the message cannot name, is shown as
// a generic one of its levels, band and rate: its framing is left out.
modem_config_t modem_message(const channel_server::VehicleModem& modem, SimTime from);

// MODEM of each of these vehicles, as a configuration (TOML, as SCENARIO has it) gives it. None of one that
// cannot be read.
std::vector<BusMessage> modems_in(const std::string& configuration, std::span<const std::string> vehicles,
                                  SimTime from);

// Of modems, the SINR at which half of their packets arrive without fading, dB:
// acoustics/modem/half_delivery.h, for 32 bytes as in link_t.delivery_probability, or the modem's most. Each
// is computed once.
class ModemThresholds {
 public:
  // None for a modem without one, or that cannot be.
  std::optional<double> of(const modem_config_t& modem);

 private:
  std::map<bus::Bytes, std::optional<double>> known_;  // by the message's bytes
};

}  // namespace halocline::monitor
