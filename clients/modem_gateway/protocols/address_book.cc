// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/address_book.h"

#include <algorithm>
#include <set>

#include "clients/modem_gateway/protocols/fields.h"
#include "core/check.h"

namespace halocline::modem_gateway {

void AddressBook::assign(std::int32_t vehicle_id, std::int32_t address) {
  if (const auto old = addresses_.find(vehicle_id); old != addresses_.end()) vehicles_.erase(old->second);
  if (const auto other = vehicles_.find(address); other != vehicles_.end()) addresses_.erase(other->second);
  addresses_[vehicle_id] = address;
  vehicles_[address] = vehicle_id;
}

std::int32_t AddressBook::vehicle_of(std::int32_t address) const {
  if (const auto given = vehicles_.find(address); given != vehicles_.end()) return given->second;
  return address < 1 || addresses_.contains(address) ? kNobody : address;  // vehicle ids begin at 1
}

std::optional<std::int32_t> AddressBook::address_of(std::int32_t vehicle_id) const {
  if (const auto given = addresses_.find(vehicle_id); given != addresses_.end()) return given->second;
  return vehicles_.contains(vehicle_id) ? std::nullopt : std::optional(vehicle_id);
}

void assign_addresses(AddressBook& book, std::string_view text, const std::vector<NamedVehicle>& vehicles) {
  std::set<std::int64_t> taken;
  for (const std::string_view entry : words_of(text)) {
    const auto equals = entry.find('=');
    const std::string_view name = entry.substr(0, equals);
    const auto vehicle =
        std::find_if(vehicles.begin(), vehicles.end(), [&](const NamedVehicle& v) { return v.name == name; });
    const auto address =
        equals == std::string_view::npos ? std::nullopt : integer_in(entry.substr(equals + 1), 0, 65535);
    require(
        vehicle != vehicles.end() && address && taken.insert(*address).second,
        "'" + std::string(entry) +
            "' is no address; allowed is VEHICLE=ADDRESS with the name of a vehicle and a number from 0 to "
            "65535 that no other has");
    book.assign(vehicle->id, static_cast<std::int32_t>(*address));
  }
}

}  // namespace halocline::modem_gateway
