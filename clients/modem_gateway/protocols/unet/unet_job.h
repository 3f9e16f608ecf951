// SPDX-License-Identifier: BSD-3-Clause
// A frame, or a ping, that a host of a UnetStack gateway asked for, on its way to the water and back.
#pragma once

#include <cstdint>
#include <vector>

#include "clients/modem_gateway/protocols/protocol.h"
#include "clients/modem_gateway/protocols/unet/unet_json.h"
#include "clients/modem_gateway/protocols/unet/unet_parameters.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

struct UnetJob {
  UnetRequest request;
  bool is_ping = false;
  int channel = kUnetData;
  std::int32_t address = 0;
  std::int32_t protocol = 0;
  std::vector<std::uint8_t> data;
  bool wants_ack = false;
  SimTime start;
  int tries_left = 1;
  std::int64_t sequence = kNotSent, began_us = 0;
  SimTime ends = SimTime::never(), until = SimTime::never();  // end of its sound, of the wait for its answer

  bool has_begun() const { return sequence != kNotSent; }
  bool is_sending() const { return has_begun() && until == SimTime::never(); }
};

// The protocols that UnetStack has itself, and those of users.
inline bool is_unet_protocol(std::int64_t number) {
  return (number >= 0 && number <= 7) || (number >= 32 && number <= 63);
}

}  // namespace halocline::modem_gateway
