// SPDX-License-Identifier: BSD-3-Clause
// Commands of a Micromodem that transmit nothing: settings, clock, revision, reboot and noise, and test
// sounds, which are refused.
#pragma once

#include <cstdint>

#include "clients/modem_gateway/protocols/micromodem/micromodem_core.h"
#include "clients/modem_gateway/protocols/micromodem/nmea.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

class MicromodemHousekeeping {
 public:
  explicit MicromodemHousekeeping(MicromodemCore& core) : core_(core) {}

  // Returns false for a command that belongs to another part.
  bool obey(ClientId client, const NmeaSentence& sentence);
  // Receives nothing for that many minutes and then reboots; 0 reboots at once.
  void sleep(std::int64_t minutes);
  // Stores the noise level over the band of the latest packet, dB re 1 uPa, for CCCFR.
  void note_noise(double level_db) { last_noise_db_ = level_db; }

  SimTime next() const;
  void step();

 private:
  void configure(ClientId client, const NmeaSentence& sentence);
  void query(ClientId client, const NmeaSentence& sentence) const;
  void set_clock(ClientId client, const NmeaSentence& sentence);
  void set_time(ClientId client, const NmeaSentence& sentence);
  void query_time(ClientId client) const;
  void query_level(ClientId client) const;
  void query_noise(ClientId client, const NmeaSentence& sentence);
  void report_noise();
  void say_revision(const char* who) const;

  MicromodemCore& core_;
  SimTime next_revision_, reboots_ = SimTime::never(), noise_due_ = SimTime::never();
  bool is_asleep_ = false;
  double last_noise_db_ = 0;
};

}  // namespace halocline::modem_gateway
