// SPDX-License-Identifier: BSD-3-Clause
// State that all parts of a Micromodem share (address, settings, clock, generation), and its output to hosts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/interface_options.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_receptions.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_reports.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_settings.h"
#include "clients/modem_gateway/protocols/micromodem/modem_clock.h"
#include "clients/modem_gateway/protocols/micromodem/nmea.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

// Error numbers of CAERR,...,NMEA.
enum class NmeaError { kChecksum = 1, kUnknown = 2, kArgument = 3, kBusy = 4 };

class MicromodemCore {
 public:
  static constexpr std::int64_t kHighestAddress = 127;

  // Takes the options revision, pps, broadcast and newer_lines. `on_stored` is called when the modem's
  // non-volatile memory has changed.
  MicromodemCore(ProtocolContext& context, std::function<void()> on_stored);

  ProtocolPort& port() const { return port_; }
  SimTime now() const { return port_.now(); }
  // Returns the reading of the vehicle's clock, which drives the modem's clock.
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
  // Must be called after each change of the settings, the address or the clock, which are in non-volatile
  // memory.
  void note_stored() const { on_stored_(); }
  // Restores the factory state, except for the clock.
  void reset_settings();
  void archive(Archive& a);
  // Returns the vehicle at an address; kBroadcastId for the broadcast addresses.
  std::int32_t vehicle_of(std::int64_t address) const;
  Listener listener() const;
  ReporterState state() const;
  // Returns the start of a transmission whose turn has come: the next whole second when the modem transmits
  // synchronously (setting SNV), else now.
  SimTime start_of_transmission() const;
  // Returns true while the transmit queue has room for one more packet.
  bool can_send() const { return port_.unsent() < ProtocolPort::kMaxUnsent; }
  bool reports_transmissions() const { return is_second_generation() || settings_.is_on("XST"); }

  // Sends an NMEA sentence to one host, or to all.
  void say(ClientId client, const std::string& body) const { port_.write(client, nmea_line(body)); }
  void say_all(const std::string& body) const { say(kAllClients, body); }
  void say_all(const std::vector<std::string>& bodies) const;
  void refuse(ClientId client, NmeaError error, std::string_view text) const;
  void refuse_argument(ClientId client, const NmeaSentence& sentence) const;
  // Repeats the host's sentence with all its fields, with talker CA instead of CC unless another is given.
  void echo(ClientId client, const NmeaSentence& sentence, std::string_view talker = "CA") const;

 private:
  ProtocolPort& port_;
  AddressBook& addresses_;
  std::int32_t vehicle_id_, delivered_address_;
  std::function<void()> on_stored_;
  MicromodemSettings settings_;
  ModemClock clock_;
  std::string revision_;
  int generation_ = 2;             // first number of the revision
  bool has_clock_sources_ = true;  // true from revision 2.0.26038 on
  bool has_newer_lines_ = false;
  std::int32_t broadcast_ = 0;
};

}  // namespace halocline::modem_gateway
