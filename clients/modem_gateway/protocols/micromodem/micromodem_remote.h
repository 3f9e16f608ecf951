// SPDX-License-Identifier: BSD-3-Clause
// Commands of a Micromodem's host that may be addressed to another modem: setting a line of the connector
// (CCMEC) and sleeping (CCMSC).
//
// A command for this modem is executed at once; for another modem it is transmitted as a mini-packet. That
// modem sets the line, to which nothing is connected, and answers with a mini-packet, which CAMER reports to
// the host that asked. A modem that is told to sleep does not answer.
#pragma once

#include <cstdint>
#include <vector>

#include "bus/messages/messages.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_core.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_housekeeping.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_receptions.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_transmitter.h"
#include "clients/modem_gateway/protocols/micromodem/nmea.h"
#include "clients/modem_gateway/protocols/protocol.h"

namespace halocline::modem_gateway {

class MicromodemRemote {
 public:
  // The arguments must outlive it.
  MicromodemRemote(MicromodemCore& core, MicromodemTransmitter& transmitter,
                   MicromodemHousekeeping& housekeeping)
      : core_(core), transmitter_(transmitter), housekeeping_(housekeeping) {}

  // Returns false for a command that belongs to another part.
  bool obey(ClientId client, const NmeaSentence& sentence);
  // Executes a mini-packet to this modem, which has already been reported.
  void follow(const modem_receive_t& packet);

 private:
  bool is_too_busy(ClientId client, std::int64_t destination) const;
  void set_line(ClientId client, const NmeaSentence& sentence);
  void sleep(ClientId client, const NmeaSentence& sentence);
  void send(MicromodemKind kind, std::int64_t address, std::vector<std::uint8_t> payload);

  MicromodemCore& core_;
  MicromodemTransmitter& transmitter_;
  MicromodemHousekeeping& housekeeping_;
};

}  // namespace halocline::modem_gateway
