// SPDX-License-Identifier: BSD-3-Clause
// State that all parts of an EvoLogics modem share (settings, clock, addresses), and its messages to hosts.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "bus/messages/messages.h"
#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

// Kinds of the modem's packets. The bus carries them as data at two rates; the number in the packet's header
// holds the kind (2 bits), the protocol id (3 bits) and the number of the message (3 bits).
enum class S2cKind { kPlain = 0, kSynchronous = 1, kPiggyBack = 2, kForced = 3 };
inline constexpr S2cKind kS2cStream = S2cKind::kSynchronous;  // kind of a stream's burst

struct S2cPayload {
  S2cKind kind = S2cKind::kPlain;
  int protocol = 0;
  std::vector<std::uint8_t> bytes;
  int number = 0;  // 1 to 7 for a message that may be repeated, to recognise repetitions; 0: none

  std::int32_t header_number() const { return static_cast<int>(kind) | protocol << 2 | number << 5; }
};
S2cPayload s2c_payload(const modem_receive_t& packet);

inline constexpr std::int32_t kS2cImRate = 0, kS2cBurstRate = 1;

class S2cCore {
 public:
  // Sends a message to all hosts, each in its own mode.
  using Tell = std::function<void(const std::string& body)>;

  S2cCore(ProtocolContext& context, Tell tell);

  ProtocolPort& port() const { return port_; }
  SimTime now() const { return port_.now(); }
  std::int32_t vehicle_id() const { return vehicle_id_; }
  std::int32_t own_address() const { return addresses_.address_of(vehicle_id_).value_or(0); }
  void take_address(std::int32_t address) { addresses_.assign(vehicle_id_, address); }
  // Broadcast address: the highest address (!AM) plus one, 255 for 254. 255 is a broadcast address in any
  // case.
  std::int32_t broadcast() const { return static_cast<std::int32_t>(setting("!AM")) + 1; }
  bool is_broadcast(std::int64_t address) const { return address == broadcast() || address == kAll; }
  // Convert between vehicle id and address; kBroadcastId corresponds to broadcast().
  std::int32_t vehicle_of(std::int64_t address) const;
  std::int32_t address_of(std::int32_t vehicle_id) const;

  // Returns a setting by its sign and letters (!RI, @ZX).
  std::int64_t setting(std::string_view name) const { return setting_in(settings_, name); }
  void set(std::string_view name, std::int64_t value) { settings_[std::string(name)] = value; }
  const std::map<std::string, std::int64_t, std::less<>>& settings() const { return settings_; }
  // Settings together with the own address: reset_settings() restores the factory state and clears the
  // non-volatile memory, store_settings() saves them to that memory, recall_settings() loads them from it.
  void reset_settings();
  void store_settings();
  void recall_settings();
  bool is_stored(std::string_view name) const { return setting(name) == setting_in(stored_.settings, name); }
  bool is_address_stored() const { return own_address() == stored_.address; }
  void archive(Archive& a);

  // Returns the reading of the vehicle's clock, which is the modem's clock.
  SimTime reading() const { return port_.clock_at(now()); }
  // Returns a reading as messages contain it: the low 32 bits of its microseconds.
  static std::uint32_t clock_us(SimTime reading) { return static_cast<std::uint32_t>(reading.to_utime()); }
  // Returns the simulation time nearest to now at which the clock shows that.
  SimTime time_of(std::uint32_t clock_us) const;

  void tell(const std::string& body) const { tell_(body); }
  // Sends a message to all hosts when extended notifications are on (@ZX1).
  void tell_more(const std::string& body) const {
    if (setting("@ZX") != 0) tell_(body);
  }

 private:
  static constexpr std::int64_t kAll = 255;
  using Settings = std::map<std::string, std::int64_t, std::less<>>;
  struct Memory {
    Settings settings;
    std::int32_t address = 0;
    void archive(Archive& a) { a(settings, address); }
  };

  static std::int64_t setting_in(const Settings& settings, std::string_view name);

  ProtocolPort& port_;
  AddressBook& addresses_;
  std::int32_t vehicle_id_;
  Tell tell_;
  Settings settings_;
  Memory delivered_, stored_;
};

}  // namespace halocline::modem_gateway
