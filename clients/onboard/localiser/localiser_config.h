// SPDX-License-Identifier: BSD-3-Clause
// Configuration of the localiser: the sections [vehicle.localiser] of a scenario file, which name the
// vehicles that are localised, their beacons and the rules of the estimator.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bus/config/config.h"
#include "clients/onboard/clocks/clock_set_config.h"
#include "clients/onboard/localiser/position_estimator.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::clients {

// Localiser of one vehicle. A beacon is a vehicle of the scenario that does not move: its position is where
// it starts.
struct VehicleLocaliser {
  std::string vehicle = {};
  std::int32_t vehicle_id = 0;
  Vec3 start_ned_m = Vec3::Zero();
  std::string beacons = {};          // names, separated by spaces; empty: this vehicle is not localised
  SimDuration ping_period = {};      // between pings, which go to the beacons in turn; 0: no pings
  SimTime ping_start = {};           // time of the first ping, by the vehicle's clock
  bool use_stamps = false;           // also take ranges from stamped packets that the beacons send
  double start_sigma_m = 0;          // standard deviation of the known start; 0: the start is unknown
  double timing_sigma_s = 0.0005;    // error of a travel time, standard deviation
  double sound_speed_sigma = 0.001;  // relative error of the mean sound speed, standard deviation
  EstimatorRules rules = {};
  bool has_modem = true;  // without one, it is not localised
};

struct LocaliserConfig {
  SimDuration estimate_period = SimDuration::from_milliseconds(1000);
  std::vector<VehicleLocaliser> vehicles;  // one entry for each vehicle of the scenario, localised or not
  ClockSetConfig clocks = {};
};

void visit(bus::ConfigVisitor& v, LocaliserConfig& config);

struct Beacon {
  std::string name;
  std::int32_t id = 0;
  Vec3 position_ned_m = Vec3::Zero();
};

// Returns the beacons of one vehicle. Throws InvalidArgument when a name is not that of another vehicle of
// the scenario.
std::vector<Beacon> beacons_of(const LocaliserConfig& config, const VehicleLocaliser& vehicle);

}  // namespace halocline::clients
