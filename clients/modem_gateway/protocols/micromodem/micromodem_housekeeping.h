// SPDX-License-Identifier: BSD-3-Clause
// The commands of a Micromodem that touch no sound: settings, clock, revision, reboot, noise, and sounds for
// tests, which are refused.
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

  // False for a command that is none of these.
  bool obey(ClientId client, const NmeaSentence& sentence);
  // Hears nothing for so long, and then reboots; 0: reboots.
  void sleep(std::int64_t minutes);
  // The noise over the band of the latest packet, dB re 1 uPa.
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
