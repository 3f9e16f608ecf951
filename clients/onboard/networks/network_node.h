// SPDX-License-Identifier: BSD-3-Clause
// Node of the example networks: runs the protocols for all vehicles of a scenario, on top of the modem
// library. Each vehicle offers packets at random times, a router decides to whom they go, and a MAC when they
// are transmitted.
//
// Protocols run in the vehicle's own time (clients/onboard/clocks/vehicle_time.h): messages of the modem are
// passed to them with times of the vehicle's clock, and their deadlines are converted to simulation time.
// Packets are offered as a Poisson process in simulation time: the time between two is exponentially
// distributed, drawn from seed, vehicle and packet number. The fate of packets is published as NETWORK_EVENT.
// The modems are told to report events, and to be promiscuous when the MAC overhears packets of others
// (LISTEN).
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bus/runtime/node.h"
#include "bus/transport/node_identity.h"
#include "clients/modem/modem_client.h"
#include "clients/onboard/clocks/vehicle_time.h"
#include "clients/onboard/networks/mac.h"
#include "clients/onboard/networks/network_config.h"
#include "clients/onboard/networks/network_packet.h"
#include "clients/onboard/networks/router.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::networks {

class NetworkNode : public bus::Node {
 public:
  // `seed` determines all draws. Throws InvalidArgument for a vehicle that is not in the scenario, and
  // without a MAC.
  NetworkNode(lcm::LCM& lcm, bus::NodeIdentity identity, const NetworkConfig& config, std::uint64_t seed);

 protected:
  bus::Due on_due() const override;
  void on_step(const bus::Now& now) override;
  std::string status_text() const override;

 private:
  struct Station {
    NetworkMember member;
    std::int32_t destination = 0;
    clients::ModemClient modem;
    std::unique_ptr<Mac> mac = {};
    std::unique_ptr<Router> router = {};
    SimTime next_offer = {};
    std::uint32_t offered = 0;
    std::uint64_t draws = 0;
    std::int64_t events = 0;
    std::int64_t sent = -1;  // packet_sequence of the latest SEND
    SimTime instant = {};    // simulation time at which its protocols are called
  };

  void add_station(const NetworkConfig& config, std::size_t i);
  void make_protocols(Station& station, const NetworkConfig& config, std::size_t i);
  std::unique_ptr<Mac> make_mac(MacPort port, std::size_t i, std::size_t count) const;
  void take_packet(Station& station, const modem_receive_t& packet);
  void take_event(Station& station, const modem_event_t& event);
  // Sets the simulation time at which the station's protocols are called next, tells them when the vehicle's
  // clock was set since the last one, and returns the time by that clock.
  SimTime enter(Station& station, SimTime instant) const;
  bool overhears_packets() const;
  SimDuration travel_time(std::int32_t from, std::int32_t to) const;  // from the positions at the start
  double draw(std::string_view purpose, const Station& station, std::uint64_t which) const;
  SimTime offer_after(const Station& station, SimTime before) const;
  void offer_due(Station& station, SimTime now);
  void report(Station& station, std::int8_t event, const NetworkPacket& packet);
  void publish_reports();

  NetworkRules rules_;
  std::uint64_t seed_;
  clients::VehicleTime clocks_;
  std::map<std::int32_t, Vec3> starts_;  // position at the start; key: vehicle
  std::vector<std::unique_ptr<Station>> stations_;
  std::vector<std::pair<std::string, network_event_t>> reports_;  // vehicle and event, for the next step
  SimTime next_listen_;
  SimTime steady_;  // steady time of the step
  std::int64_t offered_ = 0, delivered_ = 0, dropped_ = 0;
};

}  // namespace halocline::networks
