// SPDX-License-Identifier: BSD-3-Clause
// Sections [[modem_interface]] of a scenario file: the modems that have an emulated interface, its kind, and
// its place.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bus/config/config.h"
#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/onboard/clocks/clock_set_config.h"

namespace halocline::modem_gateway {

// Endpoint at which a modem interface listens: TCP on an address of this host, or a pseudo-terminal with a
// symbolic link to it.
struct Endpoint {
  bool is_tcp = true;
  std::string host = "127.0.0.1";  // an IPv4 address
  std::uint16_t port = 0;          // 0: any free port, which the log names
  std::string path;                // path of the symbolic link

  std::string text() const;
  bool operator==(const Endpoint&) const = default;
};

// Parses "tcp:PORT", "tcp:ADDRESS:PORT" or "pty:PATH". For any other text it throws InvalidArgument, which
// names these forms.
Endpoint place_of(std::string_view text);

struct ModemInterfaceConfig {
  std::string vehicle;
  std::int32_t vehicle_id = 0;
  std::string kind;
  Endpoint place;
  std::string addresses;  // syntax: address_book.h
  std::string options;    // syntax: interface_options.h
};

struct GatewayConfig {
  std::vector<NamedVehicle> vehicles;  // the vehicles of the scenario
  std::vector<ModemInterfaceConfig> interfaces;
  // The caller copies these from the scenario; they are not keys of the section.
  double rate = 1;                                           // simulated seconds per wall second
  double origin_latitude_deg = 0, origin_longitude_deg = 0;  // origin of the world frame
  clients::ClockSetConfig clocks;
};

void visit(bus::ConfigVisitor& v, GatewayConfig& config);

// Adds a modem interface given on the command line as "VEHICLE=KIND:PLACE". Throws InvalidArgument for any
// other text.
void add_interface(GatewayConfig& config, std::string_view text);

}  // namespace halocline::modem_gateway
