// SPDX-License-Identifier: BSD-3-Clause
// Node that sends packets for the vehicles of a scenario on a time grid, by the modem library, and counts
// their outcomes.
//
// Packets start at start + k period. A payload begins with the packet's number (8 bytes, little-endian), as
// far as it is long enough, and continues with a pattern made from it, so that a receiver can check what it
// received. A packet whose time passed while the program was not running is not sent late. Packets with hops
// above 1, and packets that a vehicle relays, go through its Relay (relay.h); the status counts them from end
// to end.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bus/runtime/node.h"
#include "bus/transport/node_identity.h"
#include "clients/modem/modem_client.h"
#include "clients/onboard/clocks/vehicle_time.h"
#include "clients/onboard/traffic/relay.h"
#include "clients/onboard/traffic/traffic_config.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::clients {

// Returns the payload of a packet: `size` bytes determined by its number.
std::vector<std::uint8_t> traffic_payload(std::int64_t number, std::int32_t size);
// Returns the payload of a packet of any kind: a mini-packet and JANUS application data contain the lowest
// bits of the number.
std::vector<std::uint8_t> payload_of(const VehicleTraffic& traffic, std::int64_t number);

class TrafficNode : public bus::Node {
 public:
  // Throws InvalidArgument for a destination that the scenario does not have.
  TrafficNode(lcm::LCM& lcm, bus::NodeIdentity identity, const TrafficConfig& config);

 protected:
  bus::Due on_due() const override;
  void on_step(const bus::Now& now) override;
  void on_restart(const bus::Now& now) override;
  void on_archive(Archive& a) override;
  std::string status_text() const override;

 private:
  struct Sender {
    VehicleTraffic traffic;
    std::int32_t destination;
    ModemClient modem;
    Relay relay;  // uses the vehicle's time, like next_packet
    SimTime next_packet;
    std::uint64_t moves = 0;  // number of changes of next_packet

    void set_next_packet(SimTime to) {
      next_packet = to;
      ++moves;
    }
    std::uint64_t changes() const { return modem.changes() + relay.changes() + moves; }
    void archive(Archive& a) { a(modem, relay, next_packet); }
  };

  void add_sender(const TrafficConfig& config, const VehicleTraffic& traffic);
  void on_packet(Sender& sender, const modem_receive_t& packet);
  void on_receipt(Sender& sender, const modem_receipt_t& receipt);
  void send_due(Sender& sender, const bus::Now& now);
  void transmit_due(Sender& sender, const bus::Now& now);
  std::string relay_text() const;

  SimTime shown(const Sender& sender, SimTime at) const {
    return clocks_.shown(sender.traffic.vehicle_id, at);
  }

  bool uses_relays_;
  VehicleTime clocks_;
  std::vector<std::unique_ptr<Sender>> senders_;
};

}  // namespace halocline::clients
