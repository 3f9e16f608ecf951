// SPDX-License-Identifier: BSD-3-Clause
// Properties of modems beyond their messages: the modems that a configuration gives the vehicles, and the
// SINR that a modem needs.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bus/messages/message_codec.h"
#include "bus/messages/messages.h"
#include "core/sim_time.h"
#include "viewer/sources/handover.h"

namespace halocline::channel_server {
struct VehicleModem;
}

namespace halocline::monitor {

// Makes the MODEM message of a vehicle, valid from `from` on. A modem defined in a file of its own, which the
// message cannot name, is represented by a generic one with its levels, band and rate, without its framing.
modem_config_t modem_message(const channel_server::VehicleModem& modem, SimTime from);

// Makes the MODEM message of each of these vehicles from a configuration (TOML, as in SCENARIO). Returns
// nothing for a configuration that cannot be read.
std::vector<BusMessage> modems_in(const std::string& configuration, std::span<const std::string> vehicles,
                                  SimTime from);

// Cache of the SINR at which half of a modem's packets are received without fading, dB
// (acoustics/modem/half_delivery.h). The payload is 32 bytes, as in link_t.delivery_probability, or the
// modem's maximum if that is less.
class ModemThresholds {
 public:
  // Returns nothing for a modem without such a threshold, and for an invalid one.
  std::optional<double> of(const modem_config_t& modem);

 private:
  std::map<bus::Bytes, std::optional<double>> known_;  // key: bytes of the message
};

}  // namespace halocline::monitor
