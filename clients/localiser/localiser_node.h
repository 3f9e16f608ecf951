// SPDX-License-Identifier: BSD-3-Clause
// Estimates the positions of vehicles from acoustic ranges to beacons, and publishes them as
// ESTIMATE.<vehicle>.
//
// Inputs are those the vehicle itself has: its SENSORS (depth, heading, pitch, speed through the
// water) and the packets its modem receives. The node sends pings in its name, to one beacon after the other,
// and takes ranges from the travel times of the answers; with `use_stamps` also from stamped packets of
// beacons. A travel time becomes a length by the mean sound speed between the two depths, of the profile in
// ENVIRONMENT: a straight path; where the water bends sound, the range is off: by Fermat's principle
// the bent way is quicker, by (g r)^2 / (24 c^2) of the time for a gradient g (5 cm in 1 km at 0.05 1/s, 4 m
// at 0.45 1/s). Before the first ENVIRONMENT (the channel server repeats it once a minute) no range is used.
// STATE serves only to compute the error of the estimate.
//
// Estimates are published on the time grid, and know what was stamped 0.1 s before or earlier: longer than a
// message takes, so that a run in many processes gives what one in lockstep does. An answer is counted from
// the instants that the water gave it, so its lateness costs nothing.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "acoustics/sea/sound_speed_profile.h"
#include "bus/node_identity.h"
#include "bus/runtime/node.h"
#include "clients/clocks/vehicle_time.h"
#include "clients/localiser/localiser_config.h"
#include "clients/localiser/position_estimator.h"
#include "clients/modem/modem_client.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::clients {

class LocaliserNode : public bus::Node {
 public:
  // Localises the vehicles of `config` that have beacons. Throws InvalidArgument for a beacon that the
  // scenario does not have, or a vehicle that has two names for one.
  LocaliserNode(lcm::LCM& lcm, bus::NodeIdentity identity, const LocaliserConfig& config);

 protected:
  bus::Due on_due() const override;
  void on_step(const bus::Now& now) override;
  void on_restart(const bus::Now& now) override;
  void on_archive(Archive& a) override;
  std::string status_text() const override;

 private:
  struct Water {
    acoustics::SoundSpeedProfile profile;
    double sea_surface_z_m;
  };
  struct Vehicle {
    Vehicle(bus::Bus& bus, const ModemAddress& address, const VehicleLocaliser& settings,
            std::vector<Beacon> known_beacons, SimTime own_time);

    VehicleLocaliser config;
    std::vector<Beacon> beacons;
    ModemClient modem;
    PositionEstimator estimator;
    std::deque<vehicle_sensors_t> sensors;  // received, not used yet; likewise the next three
    std::deque<vehicle_state_t> states;
    std::deque<modem_receive_t> packets;
    std::deque<vehicle_gps_t> fixes;
    std::optional<vehicle_state_t> truth;
    position_estimate_t last{};  // published
    std::int64_t pings = 0, used = 0, refused = 0;
    SimTime next_ping;  // by the vehicle's clock

    void archive(Archive& a);
  };

  void add_vehicle(const LocaliserConfig& config, const VehicleLocaliser& settings);
  void take_environment(const environment_t& message);
  void ping(Vehicle& vehicle, const bus::Now& now);
  void estimate(Vehicle& vehicle, SimTime at);
  void take_packet(Vehicle& vehicle, const modem_receive_t& packet);
  static SimTime arrival_of(const Vehicle& vehicle, const modem_receive_t& packet);
  std::optional<RangeMeasurement> range_of(const Vehicle& vehicle, const modem_receive_t& packet) const;
  position_estimate_t message_of(const Vehicle& vehicle, SimTime at) const;
  void report(const Vehicle& vehicle, const position_estimate_t& message);

  SimDuration period_;
  VehicleTime clocks_;
  SimTime next_estimate_;
  std::optional<environment_t> environment_;  // the latest, from which water_ is made
  std::optional<Water> water_;
  std::vector<std::unique_ptr<Vehicle>> vehicles_;  // handlers hold their addresses
};

}  // namespace halocline::clients
