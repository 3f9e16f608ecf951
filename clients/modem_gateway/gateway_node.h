// SPDX-License-Identifier: BSD-3-Clause
// The modem gateway: simulated modems that answer as real ones do, over TCP and serial lines.
//
// Each door has a modem of the scenario, a place where hosts connect, and the protocol of its kind
// (protocols/). One thread serves all: in a process of its own the node is stepped when a host has written or
// the bus has a message; in lockstep it looks at its hosts every `look_period` of simulation time, because
// there time advances only by steps. Hosts have time-outs of wall time: runs with doors are meant for rate 1.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bus/node_identity.h"
#include "bus/runtime/node.h"
#include "clients/clocks/vehicle_time.h"
#include "clients/modem_gateway/connections.h"
#include "clients/modem_gateway/door.h"
#include "clients/modem_gateway/gateway_config.h"
#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "clients/modem_gateway/protocols/sound_field.h"
#include "clients/modem_gateway/trace_log.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

class GatewayNode : public bus::Node {
 public:
  // How often hosts are looked at in lockstep.
  static constexpr SimDuration kLockstepPeriod = SimDuration::from_milliseconds(5);

  // `look_period`: kLockstepPeriod in lockstep; 0 where the runner watches ready_file(). `trace_path`:
  // trace_log.h; empty: none. `make_sound`: for doors of waveforms; empty: there can be none.
  // Throws InvalidArgument for a place that cannot be opened, and for doors of vehicles that there are not.
  GatewayNode(lcm::LCM& lcm, bus::NodeIdentity identity, const GatewayConfig& config, SimDuration look_period,
              const std::string& trace_path = {}, const SoundFieldMaker& make_sound = {});

  // Of the i-th door, with the port that was free where its configuration left it open.
  std::string place_of(std::size_t door) const { return connections_.place_of(door); }
  const Door& door(std::size_t i) const { return *doors_.at(i); }
  const ConnectionCounters& connection_counters() const { return connections_.counters(); }

  int ready_file() const override { return connections_.ready_file(); }

 protected:
  bus::Due on_due() const override;
  void on_step(const bus::Now& now) override;
  void on_restart(const bus::Now& now) override;
  void on_archive(Archive& a) override;
  bool on_wants_commit() override;
  void on_committed() override;
  std::string status_text() const override;

 private:
  void add_door(const DoorConfig& door, const SoundFieldMaker& make_sound);
  void assign_all_addresses();
  void take_outcome(const packet_outcome_t& outcome);
  void serve_hosts(SimTime steady);

  // Bytes for hosts, which get them once what they tell of is on disk.
  struct Written {
    std::size_t door;
    ClientId client;
    std::string bytes;
  };

  GatewayConfig config_;
  clients::VehicleTime clocks_;
  SimDuration look_period_;
  SimTime next_look_;  // at hosts, simulation time; with a look_period
  Connections connections_;
  std::unique_ptr<TraceLog> trace_;
  SimTime now_;
  std::vector<Written> written_;
  std::map<std::string, AddressBook> addresses_;  // by kind
  std::unique_ptr<SoundField> sound_;             // where a door needs it
  std::vector<std::unique_ptr<Door>> doors_;
};

}  // namespace halocline::modem_gateway
