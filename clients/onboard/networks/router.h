// SPDX-License-Identifier: BSD-3-Clause
// Routing: decides to which neighbours a packet goes on its way to the destination.
//
// A router is called with packets and times, like a MAC (mac.h), which transmits the frames that the router
// hands down. Times are those of the vehicle's clock.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "clients/onboard/networks/network_config.h"
#include "clients/onboard/networks/network_packet.h"
#include "core/sim_time.h"

namespace halocline::networks {

struct RouterPort {
  std::function<void(SimTime at, MacFrame)> hand_down;  // to the MAC
  std::function<void(SimTime at, const NetworkPacket&)> deliver;
  std::function<void(SimTime at, const NetworkPacket&)> drop;
};

class Router {
 public:
  explicit Router(RouterPort port) : port_(std::move(port)) {}
  virtual ~Router() = default;
  Router(const Router&) = delete;
  Router& operator=(const Router&) = delete;

  virtual void offer(const NetworkPacket& packet, SimTime now) = 0;
  // Handles a frame that the MAC received for this vehicle, or for all.
  virtual void take(const MacFrame& frame, SimTime at) = 0;
  // Returns the packet in a frame of this router; nothing when it contains none.
  virtual std::optional<NetworkPacket> packet_in(const MacFrame& frame) const = 0;
  // Moves all that the router waits for by `by`, as a MAC does.
  virtual void on_clock_set(SimDuration /*by*/) {}
  virtual SimTime next() const { return SimTime::never(); }
  virtual void step(SimTime /*now*/) {}

 protected:
  RouterPort port_;
};

// Makes a static router of the vehicle `own_id`. `next_hop`: the neighbour to which all packets go; 0: they
// go to their destinations directly.
std::unique_ptr<Router> make_static_router(RouterPort port, std::int32_t own_id, std::int32_t next_hop);
std::unique_ptr<Router> make_flooding_router(RouterPort port, std::int32_t own_id, const NetworkRules& rules,
                                             std::uint64_t seed);

}  // namespace halocline::networks
