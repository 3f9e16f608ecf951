// SPDX-License-Identifier: BSD-3-Clause
// Static routing: each vehicle hands all packets to one neighbour, as in a tree towards a sink, or directly
// to their destinations if it has none.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>

#include "clients/onboard/networks/network_packet.h"
#include "clients/onboard/networks/router.h"
#include "core/names.h"
#include "core/sim_time.h"

namespace halocline::networks {
namespace {

constexpr std::uint8_t kMaxHops = 16;  // ends a loop in the tree

class StaticRouter : public Router {
 public:
  StaticRouter(RouterPort port, std::int32_t own_id, std::int32_t next_hop)
      : Router(std::move(port)), own_id_(own_id), next_hop_(next_hop) {}

  void offer(const NetworkPacket& packet, SimTime now) override {
    const bool is_direct = next_hop_ == 0 || packet.destination == kBroadcastId;
    port_.hand_down(now, {is_direct ? packet.destination : next_hop_, encode(packet)});
  }

  void take(const MacFrame& frame, SimTime at) override {
    auto packet = decode_network_packet(frame.bytes);
    if (!packet) return;
    ++packet->hops;
    if (packet->destination == own_id_ || packet->destination == kBroadcastId)
      return port_.deliver(at, *packet);
    if (packet->hops >= kMaxHops) return port_.drop(at, *packet);
    offer(*packet, at);
  }

  std::optional<NetworkPacket> packet_in(const MacFrame& frame) const override {
    return decode_network_packet(frame.bytes);
  }

 private:
  std::int32_t own_id_, next_hop_;
};

}  // namespace

std::unique_ptr<Router> make_static_router(RouterPort port, std::int32_t own_id, std::int32_t next_hop) {
  return std::make_unique<StaticRouter>(std::move(port), own_id, next_hop);
}

}  // namespace halocline::networks
