// SPDX-License-Identifier: BSD-3-Clause
// Messages of an EvoLogics modem on a reception, filled from the simulated packet. Quantities in them:
//
// - duration: duration of the packet, us
// - rssi: received level less 190 dB, that is dB re 1 V behind a hydrophone and preamplifier of -190 dB re 1
//   V/uPa
// - integrity: 100 + 3 SINR (in dB), clamped to 0 to 255; above 100 is good
// - velocity: c (f_rx / f_tx - 1), m/s, with c from the setting !CA
#pragma once

#include <cstdint>
#include <string>

#include "bus/messages/messages.h"
#include "clients/modem_gateway/protocols/s2c/s2c_core.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

struct S2cQuality {
  std::int64_t duration_us = 0;
  long rssi = 0, integrity = 0;
  double velocity_mps = 0;
};
S2cQuality quality_of(const S2cCore& core, const modem_receive_t& packet);
S2cQuality quality_of(const S2cCore& core, const packet_outcome_t& loss);

// Returns RECVIM, RECVIMS, RECVPBM or RECV, according to rate and kind of the packet.
std::string received_message(const S2cCore& core, const modem_receive_t& packet);
std::string receive_end(const S2cCore& core, const modem_receive_t& packet);    // RECVEND
std::string receive_failed(const S2cCore& core, const packet_outcome_t& loss);  // RECVFAILED

// Direction and distance from which a packet came, as measured by the USBL.
struct S2cFix {
  std::int32_t address = 0;
  double bearing_rad = 0, elevation_rad = 0, deviation_rad = 0;  // defined in vehicle_usbl_t
  SimTime measured;                                              // time of the vehicle's clock
  bool has_range = false;
  double travel_time_s = 0;  // one way
  long rssi = 0, integrity = 0;
};
// Message USBLLONG when the range is known, else USBLANGLES. Its own frame is x to starboard, y forward, z
// up, which equals east, north, up for an upright head that heads north. `position` is the position alone,
// "secs,addr,E,N,U", for ?UP.
struct S2cPosition {
  std::string message, position;
};
S2cPosition position_message(const S2cCore& core, const S2cFix& fix);

}  // namespace halocline::modem_gateway
