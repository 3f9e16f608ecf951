// SPDX-License-Identifier: BSD-3-Clause
// Flooding: every vehicle forwards every packet once, after a random wait (clients/onboard/traffic/relay.h
// has the model).
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>

#include "clients/onboard/networks/network_packet.h"
#include "clients/onboard/networks/router.h"
#include "clients/onboard/traffic/relay.h"
#include "clients/onboard/traffic/relay_packet.h"
#include "core/names.h"
#include "core/sim_time.h"

namespace halocline::networks {
namespace {

using clients::Relay;
using clients::RelayPacket;

class FloodingRouter : public Router {
 public:
  FloodingRouter(RouterPort port, std::int32_t own_id, const NetworkRules& rules, std::uint64_t seed)
      : Router(std::move(port)),
        relay_(own_id,
               {.passes_on = true, .hops = rules.hops, .confirmed = false, .longest_wait = rules.relay_wait},
               seed) {
    relay_.on_delivery([this](const RelayPacket& relayed, SimTime at) {
      auto packet = decode_network_packet(relayed.payload);
      if (!packet) return;
      packet->hops = static_cast<std::uint8_t>(relayed.hops_allowed - relayed.hops_left);
      port_.deliver(at, *packet);
    });
  }

  void offer(const NetworkPacket& packet, SimTime now) override {
    relay_.originate(packet.destination, encode(packet), now);
  }

  void take(const MacFrame& frame, SimTime at) override { relay_.take(frame.bytes, at); }

  std::optional<NetworkPacket> packet_in(const MacFrame& frame) const override {
    const auto relayed = clients::decode_relay_packet(frame.bytes);
    return relayed ? decode_network_packet(relayed->payload) : std::nullopt;
  }

  void on_clock_set(SimDuration by) override { relay_.move(by); }

  SimTime next() const override { return relay_.next(); }

  // The relay is told at once that the packet was accepted, because the MAC is responsible for it from here
  // on.
  void step(SimTime now) override {
    while (auto transmission = relay_.transmit_due(now)) {
      relay_.on_sent(0);
      relay_.on_receipt(0, Relay::Verdict::kAccepted, now);
      port_.hand_down(now, {kBroadcastId, std::move(transmission->bytes)});
    }
  }

 private:
  Relay relay_;
};

}  // namespace

std::unique_ptr<Router> make_flooding_router(RouterPort port, std::int32_t own_id, const NetworkRules& rules,
                                             std::uint64_t seed) {
  return std::make_unique<FloodingRouter>(std::move(port), own_id, rules, seed);
}

}  // namespace halocline::networks
