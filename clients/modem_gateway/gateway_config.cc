// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/gateway_config.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include <arpa/inet.h>

#include "clients/modem/modem_client.h"
#include "clients/modem_gateway/protocols/fields.h"
#include "clients/modem_gateway/protocols/interface_options.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "clients/modem_gateway/protocols/protocols.h"
#include "core/check.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {
namespace {

using bus::ConfigVisitor;

constexpr std::string_view kTcp = "tcp:", kPty = "pty:";

// Port for checking the options of a configuration: a protocol does nothing with its port while it is
// constructed.
class NoPort : public ProtocolPort {
 public:
  SimTime now() const override { return {}; }
  SimTime clock_at(SimTime time) const override { return time; }
  void sleep_until(SimTime) override {}
  void write(ClientId, std::string_view) override {}
  void disconnect(ClientId) override {}
  std::int64_t send(StartRule, std::int32_t, std::span<const std::uint8_t>, clients::SendOptions) override {
    return 0;
  }
  std::size_t unsent() const override { return 0; }
  bool is_own(std::int64_t) const override { return false; }
  const vehicle_sensors_t* sensors() const override { return nullptr; }
  const vehicle_state_t* state() const override { return nullptr; }
  const vehicle_battery_t* battery() const override { return nullptr; }
  bool ask_paths(std::int32_t) override { return false; }
  void note(std::string_view, std::string_view) override {}
};

AddressBook book_of(const GatewayConfig& config, const ModemInterfaceConfig& interface) {
  AddressBook book;
  assign_addresses(book, interface.addresses, config.vehicles);
  return book;
}

// Throws InvalidArgument for options that the kind does not know, or that name a vehicle as a transponder
// which is not one. `book` holds the addresses of the modem interface's kind.
void check_options(const GatewayConfig& config, const ModemInterfaceConfig& interface, AddressBook book) {
  NoPort port;
  const auto protocol =
      make_protocol(interface.kind, {port, book, interface.vehicle_id, InterfaceOptions(interface.options)});
  const std::vector<std::int32_t> transponders = protocol->transponders();
  for (const NamedVehicle& vehicle : config.vehicles) {
    require(
        vehicle.is_transponder ||
            std::find(transponders.begin(), transponders.end(), vehicle.id) == transponders.end(),
        "they name " + vehicle.name +
            " as a transponder, which answers no ping to all; allowed is a vehicle with transponder = true");
  }
}

std::int32_t id_of(const GatewayConfig& config, const std::string& name) {
  const auto found = std::find_if(config.vehicles.begin(), config.vehicles.end(),
                                  [&](const auto& vehicle) { return vehicle.name == name; });
  require(found != config.vehicles.end(),
          "there is no vehicle '" + name + "'; allowed is the name of a vehicle of the scenario");
  return found->id;
}

std::string kinds_text() {
  std::string text;
  for (const std::string& kind : protocol_kinds()) text += (text.empty() ? "" : ", ") + kind;
  return text;
}

void visit_interface(ConfigVisitor& v, ModemInterfaceConfig& interface) {
  v.text("vehicle", interface.vehicle, {}, "name of the vehicle whose modem it is");
  v.text("kind", interface.kind, protocol_kinds(), "whose protocol it speaks");
  std::string place = interface.place.text();
  v.text("place", place, {}, "tcp:PORT on this host alone, tcp:ADDRESS:PORT, or pty:PATH of a serial line");
  bus::report_refusal(v, "place", [&] { interface.place = place_of(place); });
  v.text(
      "addresses", interface.addresses, {},
      "addresses of modems of this kind, VEHICLE=ADDRESS with blanks between; others have the vehicle's id");
  v.text("options", interface.options, {}, "NAME=VALUE with blanks between (docs/interfaces.md)");
}

void check_interface(ConfigVisitor& v, const GatewayConfig& config, std::size_t i) {
  const ModemInterfaceConfig& interface = config.interfaces[i];
  bus::report_refusal(v, "vehicle", [&] { id_of(config, interface.vehicle); });
  if (interface.kind.empty()) return v.problem("kind", "it must be given: one of " + kinds_text());
  std::optional<AddressBook> book;
  bus::report_refusal(v, "addresses", [&] { book = book_of(config, interface); });
  bus::report_refusal(v, "options", [&] { check_options(config, interface, book.value_or(AddressBook())); });
  for (std::size_t other = 0; other < i; ++other) {
    if (config.interfaces[other].place == interface.place && interface.place.text() != "tcp:0")
      v.problem("place", "another modem interface has this place; allowed is one of its own");
  }
}

}  // namespace

std::string Endpoint::text() const {
  if (!is_tcp) return std::string(kPty) + path;
  const std::string address = host == Endpoint().host ? "" : host + ":";
  return std::string(kTcp) + address + std::to_string(port);
}

Endpoint place_of(std::string_view text) {
  Endpoint place;
  std::string_view rest = text.substr(std::min(kTcp.size(), text.size()));
  const bool is_pty = text.starts_with(kPty) && !rest.empty();
  bool is_tcp = text.starts_with(kTcp);
  if (is_pty) {
    place.is_tcp = false;
    place.path = rest;
  } else if (is_tcp) {
    if (const auto colon = rest.find(':'); colon != std::string_view::npos) {
      place.host = rest.substr(0, colon);
      rest.remove_prefix(colon + 1);
    }
    in_addr address{};
    const auto port = integer_in(rest, 0, 65535);
    is_tcp = port.has_value() && inet_pton(AF_INET, place.host.c_str(), &address) == 1;
    if (is_tcp) place.port = static_cast<std::uint16_t>(*port);
  }
  require(is_pty || is_tcp,
          "'" + std::string(text) +
              "' is no place; allowed are tcp:PORT (0 to 65535), tcp:ADDRESS:PORT with an IPv4 "
              "address, and pty:PATH");
  return place;
}

void visit(ConfigVisitor& v, GatewayConfig& config) {
  v.list(
      "vehicle", "A vehicle", config.vehicles.size(), [&](std::size_t n) { config.vehicles.resize(n); },
      [&](ConfigVisitor& item, std::size_t i) {
        item.shared_with_others();
        item.text("name", config.vehicles[i].name, {}, "");
        bus::integer_as(item, "id", config.vehicles[i].id, {1, 2147483647, "", ""});
        item.boolean("transponder", config.vehicles[i].is_transponder, "");
      });
  visit(v, config.clocks);
  v.list(
      "modem_interface",
      "Emulated interface of a vehicle's modem, for hosts that speak the protocol of a real one",
      config.interfaces.size(), [&](std::size_t n) { config.interfaces.resize(n); },
      [&](ConfigVisitor& item, std::size_t i) { visit_interface(item, config.interfaces[i]); });
  if (v.writing()) return;
  // The second pass checks references to vehicles, once all their names are known.
  v.list(
      "modem_interface", "", config.interfaces.size(), [](std::size_t) {},
      [&](ConfigVisitor& item, std::size_t i) {
        check_interface(item, config, i);
        for (const auto& vehicle : config.vehicles) {
          if (vehicle.name == config.interfaces[i].vehicle) config.interfaces[i].vehicle_id = vehicle.id;
        }
      });
}

void add_interface(GatewayConfig& config, std::string_view text) {
  const auto equals = text.find('='), colon = text.find(':', equals);
  require(equals != std::string_view::npos && colon != std::string_view::npos,
          "--modem-interface '" + std::string(text) +
              "'; allowed is VEHICLE=KIND:PLACE, such as auv-1=nm3:tcp:9600");
  ModemInterfaceConfig interface;
  interface.vehicle = text.substr(0, equals);
  interface.vehicle_id = id_of(config, interface.vehicle);
  interface.kind = text.substr(equals + 1, colon - equals - 1);
  interface.place = place_of(text.substr(colon + 1));
  check_options(config, interface, book_of(config, interface));
  config.interfaces.push_back(std::move(interface));
}

}  // namespace halocline::modem_gateway
