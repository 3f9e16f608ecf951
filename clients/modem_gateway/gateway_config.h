// SPDX-License-Identifier: BSD-3-Clause
// The sections [[door]] of a scenario file: which modems have a front door, of what kind, and where.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bus/config/config.h"
#include "clients/clocks/clock_set_config.h"
#include "clients/modem_gateway/protocols/address_book.h"

namespace halocline::modem_gateway {

// Where a door listens: TCP on an address of this host, or a pseudo-terminal with a symbolic link to it.
struct Place {
  bool is_tcp = true;
  std::string host = "127.0.0.1";  // an IPv4 address
  std::uint16_t port = 0;          // 0: any that is free, which the log names
  std::string path;                // of the link

  std::string text() const;
  bool operator==(const Place&) const = default;
};

// "tcp:PORT", "tcp:ADDRESS:PORT" or "pty:PATH". Throws InvalidArgument that names these for another text.
Place place_of(std::string_view text);

struct DoorConfig {
  std::string vehicle;
  std::int32_t vehicle_id = 0;
  std::string kind;
  Place place;
  std::string addresses;  // address_book.h
  std::string options;    // door_options.h
};

struct GatewayConfig {
  std::vector<NamedVehicle> vehicles;  // of the scenario
  std::vector<DoorConfig> doors;
  // Not among its keys: of the scenario, for the caller to fill in.
  double rate = 1;                                           // simulated seconds per wall second
  double origin_latitude_deg = 0, origin_longitude_deg = 0;  // of the world frame
  clients::ClockSetConfig clocks;
};

void visit(bus::ConfigVisitor& v, GatewayConfig& config);

// Takes a door of the command line, "VEHICLE=KIND:PLACE", into the configuration. Throws InvalidArgument.
void add_door(GatewayConfig& config, std::string_view text);

}  // namespace halocline::modem_gateway
