// SPDX-License-Identifier: BSD-3-Clause
// Addresses of modems of one kind, as their protocol has them, and the vehicles that carry them.
//
// Packets of the simulation bear ids of vehicles; hosts know addresses, which a host may set for its own
// modem. One book serves all doors of a kind in a gateway, so that a new address holds for those who send to
// it. A vehicle without a given address has its id as its address.
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
  bool is_transponder = false;  // answers pings to all
};

class AddressBook {
 public:
  // The destination of packets for an address that nobody has: a vehicle that there is not.
  static constexpr std::int32_t kNobody = 2'000'000'000;

  // From now on `vehicle_id` alone has this address, and no other.
  void assign(std::int32_t vehicle_id, std::int32_t address);

  // Whether a vehicle has been given that address.
  bool is_given(std::int32_t address) const { return vehicles_.contains(address); }
  // The vehicle to send to; kNobody for an address that nobody has.
  std::int32_t vehicle_of(std::int32_t address) const;
  // None where another vehicle has been given this one's id as its address.
  std::optional<std::int32_t> address_of(std::int32_t vehicle_id) const;

 private:
  std::map<std::int32_t, std::int32_t> addresses_;  // by vehicle
  std::map<std::int32_t, std::int32_t> vehicles_;   // by address
};

// Takes "name=address name=address" into the book. Throws InvalidArgument for another text, for a vehicle
// that is not among `vehicles`, and for an address that two have.
void assign_addresses(AddressBook& book, std::string_view text, const std::vector<NamedVehicle>& vehicles);

}  // namespace halocline::modem_gateway
