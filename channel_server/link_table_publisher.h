// SPDX-License-Identifier: BSD-3-Clause
// The publisher of the link tables of a tick as LINKS.<vehicle>. It also reports in the log which vehicles
// appear and vanish.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bus/numbered_publisher.h"
#include "bus/transport/event_log.h"
#include "channel_server/links/link_predictor.h"
#include "channel_server/links/link_table.h"
#include "channel_server/links/receiver_noise.h"
#include "channel_server/packets/platform_noise.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/for_each.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {

// The noise of vehicles at the receivers of links.
class PlatformReceiverNoise final : public ReceiverNoise {
 public:
  explicit PlatformReceiverNoise(PlatformNoise& sounds) : sounds_(sounds) {}  // must outlive it

  bool differ() const override { return sounds_.differ(); }
  bool may_wait() const override { return sounds_.any_is_heard(); }
  Decibels above_ambient(const EndPair& link, SimTime at, VehicleId silent) override;
  bool is_ready(const EndPair& link, SimTime at, VehicleId silent) override;

 private:
  PlatformNoise& sounds_;
};

class LinkTablePublisher {
 public:
  // The parts from which tables are computed; all must outlive the publisher.
  struct Models {
    const VehicleRegistry& vehicles;
    Propagation& propagation;
    LinkPredictor& predictor;
    ReceiverNoise& noise;
  };
  LinkTablePublisher(bus::NumberedPublisher& publisher, bus::EventLog& log, Models models, ForEach for_each)
      : publisher_(publisher), log_(log), models_(models), for_each_(std::move(for_each)) {}

  // True when everything is known that publish() needs about the noise of vehicles for these links.
  bool is_noise_ready(SimTime tick, const std::vector<EndPair>& links);
  // Publishes the tables of a tick. `vehicles` are those present at `tick`; `rows` are those of vehicles that
  // this server serves, ready to be computed.
  void publish(SimTime tick, const std::vector<PlacedVehicle>& vehicles, const TableRows& rows);

  std::size_t vehicles_present() const { return present_.size(); }
  std::int64_t links_published() const { return links_published_; }

 private:
  void report_presence(const std::vector<PlacedVehicle>& vehicles);

  bus::NumberedPublisher& publisher_;
  bus::EventLog& log_;
  Models models_;
  ForEach for_each_;
  std::set<std::string> present_;
  std::int64_t links_published_ = 0;
};

}  // namespace halocline::channel_server
