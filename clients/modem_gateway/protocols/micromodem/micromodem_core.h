// SPDX-License-Identifier: BSD-3-Clause
// What all parts of a Micromodem share: its address, settings, clock and generation, and how it writes to
// hosts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/door_options.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_receptions.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_reports.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_settings.h"
#include "clients/modem_gateway/protocols/micromodem/modem_clock.h"
#include "clients/modem_gateway/protocols/micromodem/nmea.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

// Numbers of CAERR,...,NMEA.
enum class NmeaError { kChecksum = 1, kUnknown = 2, kArgument = 3, kBusy = 4 };

class MicromodemCore {
 public:
  static constexpr std::int64_t kHighestAddress = 127;

  // Takes the options revision, pps, broadcast and newer_lines. `on_stored`: the modem's non-volatile memory
  // has changed.
  MicromodemCore(ProtocolContext& context, std::function<void()> on_stored);

  ProtocolPort& port() const { return port_; }
  SimTime now() const { return port_.now(); }
  // What the vehicle's clock shows, by which the modem's goes.
  SimTime reading() const { return port_.clock_at(now()); }
  std::int32_t vehicle_id() const { return vehicle_id_; }
  MicromodemSettings& settings() { return settings_; }
  const MicromodemSettings& settings() const { return settings_; }
  ModemClock& clock() { return clock_; }
  const ModemClock& clock() const { return clock_; }
  const std::string& revision() const { return revision_; }
  bool is_second_generation() const { return generation_ >= 2; }

  std::int32_t own_address() const { return addresses_.address_of(vehicle_id_).value_or(0); }
  void take_address(std::int32_t address) { addresses_.assign(vehicle_id_, address); }
  // Settings, address and clock are in non-volatile memory: to be called after each change of them.
  void note_stored() const { on_stored_(); }
  // All as the modem was delivered, but for the clock.
  void reset_settings();
  void archive(Archive& a);
  // kBroadcastId for the addresses of all.
  std::int32_t vehicle_of(std::int64_t address) const;
  Listener listener() const;
  ReporterState state() const;
  // Start of a transmission whose turn has come: on a whole second where the modem is synchronised.
  SimTime start_of_transmission() const;
  // True while one more packet can wait to be sent.
  bool can_send() const { return port_.unsent() < ProtocolPort::kMaxUnsent; }
  bool reports_transmissions() const { return is_second_generation() || settings_.is_on("XST"); }

  // A sentence to one host, or to all.
  void say(ClientId client, const std::string& body) const { port_.write(client, nmea_line(body)); }
  void say_all(const std::string& body) const { say(kAllClients, body); }
  void say_all(const std::vector<std::string>& bodies) const;
  void refuse(ClientId client, NmeaError error, std::string_view text) const;
  void refuse_argument(ClientId client, const NmeaSentence& sentence) const;
  // The same sentence from the modem: CA, or as it begins, and all fields.
  void echo(ClientId client, const NmeaSentence& sentence, std::string_view talker = "CA") const;

 private:
  ProtocolPort& port_;
  AddressBook& addresses_;
  std::int32_t vehicle_id_, delivered_address_;
  std::function<void()> on_stored_;
  MicromodemSettings settings_;
  ModemClock clock_;
  std::string revision_;
  int generation_ = 2;             // the first number of the revision
  bool has_clock_sources_ = true;  // from 2.0.26038 on
  bool has_newer_lines_ = false;
  std::int32_t broadcast_ = 0;
};

}  // namespace halocline::modem_gateway
