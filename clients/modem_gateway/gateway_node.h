// SPDX-License-Identifier: BSD-3-Clause
// Modem gateway: lets simulated modems answer over TCP and serial lines as real modems do.
//
// Each modem interface has a modem of the scenario, a place where hosts connect, and the protocol of its kind
// (protocols/). One thread serves all of them. In a process of its own the node is stepped when a host has
// written or the bus has a message. In lockstep it polls its hosts every `look_period` of simulation time,
// because there time advances only by steps. Hosts have time-outs in wall time, so runs with modem interfaces
// are meant for rate 1.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bus/runtime/node.h"
#include "bus/transport/node_identity.h"
#include "clients/modem_gateway/connections.h"
#include "clients/modem_gateway/door.h"
#include "clients/modem_gateway/gateway_config.h"
#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "clients/modem_gateway/protocols/sound_field.h"
#include "clients/modem_gateway/trace_log.h"
#include "clients/onboard/clocks/vehicle_time.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

class GatewayNode : public bus::Node {
 public:
  // Period at which hosts are polled in lockstep, simulation time.
  static constexpr SimDuration kLockstepPeriod = SimDuration::from_milliseconds(5);

  // Opens all modem interfaces of `config`.
  // - `look_period`: kLockstepPeriod in lockstep; 0 when the runner watches ready_file().
  // - `trace_path`: file of the trace (trace_log.h); empty for none.
  // - `make_sound`: makes the field of waveforms for the kinds that need one; when it is empty, these are
  //   refused.
  //
  // Throws InvalidArgument for a place that cannot be opened and for an unknown vehicle.
  GatewayNode(lcm::LCM& lcm, bus::NodeIdentity identity, const GatewayConfig& config, SimDuration look_period,
              const std::string& trace_path = {}, const SoundFieldMaker& make_sound = {});

  // Returns the place of the i-th modem interface, with the actual port where its configuration left it open.
  std::string place_of(std::size_t door) const { return connections_.place_of(door); }
  const Door& door(std::size_t i) const { return *doors_.at(i); }

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

  // Bytes for a host, written once the state that they report is committed to disk.
  struct Written {
    std::size_t door;
    ClientId client;
    std::string bytes;
  };

  GatewayConfig config_;
  clients::VehicleTime clocks_;
  SimDuration look_period_;
  SimTime next_look_;  // next poll of hosts in lockstep, simulation time; never() without a look_period
  Connections connections_;
  std::unique_ptr<TraceLog> trace_;
  SimTime now_;
  std::vector<Written> written_;
  std::map<std::string, AddressBook> addresses_;  // key: kind of modem
  std::unique_ptr<SoundField> sound_;             // null unless a kind needs waveforms
  std::vector<std::unique_ptr<Door>> doors_;
};

}  // namespace halocline::modem_gateway
