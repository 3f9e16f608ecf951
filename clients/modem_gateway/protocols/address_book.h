// SPDX-License-Identifier: BSD-3-Clause
// Address book: the addresses of all modems of one kind, as their protocol numbers them, and their vehicles.
//
// Packets of the simulation carry vehicle ids, while hosts use addresses, which a host may set for its own
// modem. One book serves all modem interfaces of a kind in a gateway, so that a changed address holds at once
// for those who send to it. A vehicle without a given address has its id as its address.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace halocline::modem_gateway {

struct NamedVehicle {
  std::string name;
  std::int32_t id = 0;
  bool is_transponder = false;  // answers pings to the broadcast address
};

class AddressBook {
 public:
  // Destination of packets to an address that no modem has: an id that no vehicle has.
  static constexpr std::int32_t kNobody = 2'000'000'000;

  // Gives this address to `vehicle_id` alone, which loses any earlier address.
  void assign(std::int32_t vehicle_id, std::int32_t address);

  bool is_given(std::int32_t address) const { return vehicles_.contains(address); }
  // Returns the id of the vehicle at the address; kNobody when no modem has it.
  std::int32_t vehicle_of(std::int32_t address) const;
  // Returns the address of a vehicle; nothing when another vehicle has been given this one's id as its
  // address.
  std::optional<std::int32_t> address_of(std::int32_t vehicle_id) const;

 private:
  std::map<std::int32_t, std::int32_t> addresses_;  // address by vehicle id
  std::map<std::int32_t, std::int32_t> vehicles_;   // vehicle id by address
};

// Adds the entries of "name=address name=address" to the book. Throws InvalidArgument for a malformed text,
// for a vehicle that is not among `vehicles`, and for an address that two entries share.
void assign_addresses(AddressBook& book, std::string_view text, const std::vector<NamedVehicle>& vehicles);

}  // namespace halocline::modem_gateway
