// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/gateway_node.h"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>

#include "bus/messages/channels.h"
#include "bus/transport/subscription.h"
#include "clients/modem_gateway/protocols/protocols.h"
#include "core/check.h"

namespace halocline::modem_gateway {
GatewayNode::GatewayNode(lcm::LCM& lcm, bus::NodeIdentity identity, const GatewayConfig& config,
                         SimDuration poll_period, const std::string& trace_path,
                         const SoundFieldMaker& make_sound)
    : Node(lcm, std::move(identity)),
      config_(config),
      clocks_(bus(), config.clocks),
      poll_period_(poll_period),
      next_poll_(poll_period == SimDuration() ? SimTime::never() : SimTime()) {
  if (!trace_path.empty()) trace_ = std::make_unique<TraceLog>(trace_path);
  if (config.rate != 1)
    bus().log().warning("rate", "rate=" + std::to_string(config.rate) + ": hosts keep wall time");
  assign_all_addresses();
  for (const ModemInterfaceConfig& interface : config.interfaces) add_interface(interface, make_sound);
  const bool wants_outcomes = std::any_of(interfaces_.begin(), interfaces_.end(),
                                          [](const auto& interface) { return interface->wants_outcomes(); });
  if (!wants_outcomes) return;
  bus().subscribe<packet_outcome_t>(bus::channels::kOutcome,
                                    [this](const packet_outcome_t& outcome) { take_outcome(outcome); });
}

// Fills the address books in place: the modem interfaces keep references to them.
void GatewayNode::assign_all_addresses() {
  for (const ModemInterfaceConfig& interface : config_.interfaces) addresses_[interface.kind] = AddressBook();
  for (const ModemInterfaceConfig& interface : config_.interfaces)
    assign_addresses(addresses_[interface.kind], interface.addresses, config_.vehicles);
}

void GatewayNode::add_interface(const ModemInterfaceConfig& interface, const SoundFieldMaker& make_sound) {
  if (needs_sound(interface.kind) && !sound_) {
    require(make_sound != nullptr,
            "a modem interface of kind '" + interface.kind + "' needs the water of a scenario");
    sound_ = make_sound(bus());
  }
  const std::size_t number = connections_.add(interface.place);
  ModemInterface::Trace trace;
  if (trace_) {
    trace = [this, name = interface.vehicle + " " + interface.kind](char direction, std::string_view bytes) {
      trace_->write(now_, name, direction, bytes);
    };
  }
  interfaces_.push_back(std::make_unique<ModemInterface>(
      bus(), interface, config_, clocks_, addresses_[interface.kind], sound_.get(),
      [this, number](ClientId client, std::string_view bytes) {
        written_.push_back({number, client, std::string(bytes)});
      },
      [this](ClientId client, std::uint16_t port, std::string_view bytes) {
        connections_.send_datagram(client, port, bytes);
      },
      [this](ClientId client) { connections_.disconnect(client); }, std::move(trace)));
  bus().log().info("modem-interface",
                   "vehicle=" + interface.vehicle + " kind=" + interface.kind + " place=" + place_of(number));
}

void GatewayNode::take_outcome(const packet_outcome_t& outcome) {
  for (const auto& interface : interfaces_) {
    if (interface->vehicle_id() == outcome.receiver_id && interface->wants_outcomes())
      interface->store(outcome);
  }
}

bus::Due GatewayNode::on_due() const {
  bus::Due due{.sim = next_poll_};
  const bool watches_files = poll_period_ == SimDuration();
  if (watches_files) {
    due.steady = connections_.next_poll();
    if (connections_.is_ready()) due.sim = SimTime::at_once();
  }
  for (const auto& interface : interfaces_) {
    const bus::Due own = interface->due();
    due.sim = std::min(due.sim, own.sim);
    due.steady = std::min(due.steady, own.steady);
  }
  return due;
}

void GatewayNode::on_step(const bus::Now& now) {
  now_ = now.sim;
  for (const auto& interface : interfaces_) interface->begin_step(now);
  serve_hosts(now.steady);
  for (const auto& interface : interfaces_) interface->end_step();
  if (poll_period_ > SimDuration() && now.sim >= next_poll_) next_poll_ = next_on_grid(now.sim, poll_period_);
}

void GatewayNode::serve_hosts(SimTime steady) {
  for (const Connections::Input& input : connections_.take(steady)) {
    ModemInterface& interface = *interfaces_[input.interface];
    switch (input.change) {
      case Connections::Change::kOpened:
        interface.on_opened(input.client);
        break;
      case Connections::Change::kBytes:
        interface.on_bytes(input.client, input.bytes);
        break;
      case Connections::Change::kClosed:
        interface.on_closed(input.client);
        break;
    }
  }
}

void GatewayNode::on_restart(const bus::Now& now) {
  assign_all_addresses();
  for (const auto& interface : interfaces_) interface->restart();
  clocks_.restart(now.sim);
  if (poll_period_ > SimDuration()) next_poll_ = now.sim;
}

void GatewayNode::on_archive(Archive& a) {
  a(clocks_);
  for (const auto& interface : interfaces_) a(*interface);
}

bool GatewayNode::on_wants_commit() {
  bool wants = false;
  for (const auto& interface : interfaces_) wants = interface->take_stored() || wants;
  return wants;
}

void GatewayNode::on_committed() {
  for (const Written& written : std::exchange(written_, {}))
    connections_.write(written.interface, written.client, written.bytes);
}

std::string GatewayNode::status_text() const {
  std::int64_t sent = 0, received = 0, lost = 0;
  for (const auto& interface : interfaces_) {
    sent += interface->counters().sent;
    received += interface->counters().received;
    lost += interface->losses();
  }
  const ConnectionCounters& hosts = connections_.counters();
  return "interfaces " + std::to_string(interfaces_.size()) + ", hosts " +
         std::to_string(connections_.clients()) + ", opened " + std::to_string(hosts.opened) +
         ", turned away " + std::to_string(hosts.turned_away) + ", bytes in " +
         std::to_string(hosts.bytes_in) + ", out " + std::to_string(hosts.bytes_out) + ", writes dropped " +
         std::to_string(hosts.writes_dropped) + ", sent " + std::to_string(sent) + ", received " +
         std::to_string(received) + ", lost " + std::to_string(lost);
}

}  // namespace halocline::modem_gateway
