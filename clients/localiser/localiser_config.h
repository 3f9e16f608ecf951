// SPDX-License-Identifier: BSD-3-Clause
// The sections [vehicle.localiser] of a scenario file: which vehicle finds its place, by which beacons and
// how.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bus/config/config.h"
#include "clients/clocks/clock_set_config.h"
#include "clients/localiser/position_estimator.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::clients {

// A beacon is a vehicle of the scenario that does not move: it is where it starts.
struct VehicleLocaliser {
  std::string vehicle = {};
  std::int32_t vehicle_id = 0;
  Vec3 start_ned_m = Vec3::Zero();
  std::string beacons = {};      // names, with spaces between; empty: this vehicle is not localised
  SimDuration ping_period = {};  // between pings, to one beacon after the other; 0: none are sent
  SimTime ping_start = {};
  bool use_stamps = false;   // ranges by the stamped packets that beacons send, too
  double start_sigma_m = 0;  // standard deviation of the known start; 0: the start is unknown
  double timing_sigma_s = 0.0005;
  double sound_speed_sigma = 0.001;  // of one, relative
  EstimatorRules rules = {};
};

struct LocaliserConfig {
  SimDuration estimate_period = SimDuration::from_milliseconds(1000);
  std::vector<VehicleLocaliser> vehicles;  // one for each of the scenario, localised or not
  ClockSetConfig clocks = {};
};

void visit(bus::ConfigVisitor& v, LocaliserConfig& config);

struct Beacon {
  std::string name;
  std::int32_t id = 0;
  Vec3 position_ned_m = Vec3::Zero();
};

// The beacons of one vehicle. Throws InvalidArgument for a name that is no other vehicle of the scenario.
std::vector<Beacon> beacons_of(const LocaliserConfig& config, const VehicleLocaliser& vehicle);

}  // namespace halocline::clients
