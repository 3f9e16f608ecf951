// SPDX-License-Identifier: BSD-3-Clause
// Commands of a Micromodem's host that another modem may obey: a line of its connector (CCMEC), sleep
// (CCMSC).
//
// For this modem they are obeyed at once; to another they go as a mini-packet. It sets the line, which
// nothing is connected to, and answers with a mini-packet, of which CAMER tells the host that asked; a modem
// that is told to sleep does not answer.
#pragma once

#include <cstdint>
#include <vector>

#include "bus/messages.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_core.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_housekeeping.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_receptions.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_transmitter.h"
#include "clients/modem_gateway/protocols/micromodem/nmea.h"
#include "clients/modem_gateway/protocols/protocol.h"

namespace halocline::modem_gateway {

class MicromodemRemote {
 public:
  // All must outlive it.
  MicromodemRemote(MicromodemCore& core, MicromodemTransmitter& transmitter,
                   MicromodemHousekeeping& housekeeping)
      : core_(core), transmitter_(transmitter), housekeeping_(housekeeping) {}

  // False for a command that is none of these.
  bool obey(ClientId client, const NmeaSentence& sentence);
  // A mini-packet to this modem that has been reported.
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
