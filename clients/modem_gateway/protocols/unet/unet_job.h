// SPDX-License-Identifier: BSD-3-Clause
// Job of a UnetStack gateway: a frame or a ping that a host asked for, from its acceptance to its
// notification.
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
  SimTime ends = SimTime::never(), until = SimTime::never();  // ends of transmission and of the wait

  bool has_begun() const { return sequence != kNotSent; }
  bool is_sending() const { return has_begun() && until == SimTime::never(); }
};

// Returns true for a protocol number that UnetStack itself uses or that is free for users.
inline bool is_unet_protocol(std::int64_t number) {
  return (number >= 0 && number <= 7) || (number >= 32 && number <= 63);
}

}  // namespace halocline::modem_gateway
