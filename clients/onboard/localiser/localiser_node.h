// SPDX-License-Identifier: BSD-3-Clause
// Node that estimates the positions of vehicles from acoustic ranges to beacons, and publishes them as
// ESTIMATE.<vehicle>.
//
// Its inputs are those that the vehicle itself has: its SENSORS (depth, heading, pitch, speed through the
// water) and the packets that its modem receives. The node sends pings in the vehicle's name, to the beacons
// in turn, and computes ranges from the travel times of the replies; with `use_stamps` also from stamped
// packets of the beacons. A range is the travel time multiplied by the mean sound speed between the two
// depths, from the profile in ENVIRONMENT, which assumes a straight path. Where the water refracts sound, the
// range is short, since by Fermat's principle the bent ray is faster. For a sound-speed gradient g, a
// horizontal range r and a sound speed c, the relative error is
//
//   (g r)^2 / (24 c^2)    5 cm in 1 km at 0.05 1/s, 4 m at 0.45 1/s
//
// No range is used before the first ENVIRONMENT (the channel server repeats it once a minute). STATE serves
// only to compute the error of the estimate.
//
// Estimates are published on the time grid and use data stamped at least 0.1 s earlier. That is longer than a
// message takes, so that a run of separate processes gives the same results as one in lockstep. The range of
// a ping holds at the instants when its packets left and arrived, so it loses nothing by being used later.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "acoustics/sea/sound_speed_profile.h"
#include "bus/runtime/node.h"
#include "bus/transport/node_identity.h"
#include "clients/modem/modem_client.h"
#include "clients/onboard/clocks/vehicle_time.h"
#include "clients/onboard/localiser/localiser_config.h"
#include "clients/onboard/localiser/position_estimator.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::clients {

class LocaliserNode : public bus::Node {
 public:
  // Localises the vehicles of `config` that have beacons. Throws InvalidArgument when a beacon is not another
  // vehicle of the scenario.
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
    std::deque<vehicle_sensors_t> sensors;  // received, not yet used; so are the next three
    std::deque<vehicle_state_t> states;
    std::deque<modem_receive_t> packets;
    std::deque<vehicle_gps_t> fixes;
    std::optional<vehicle_state_t> truth;  // latest true state
    position_estimate_t last{};            // latest estimate published
    std::int64_t pings = 0, used = 0, refused = 0;
    SimTime next_ping;  // instant of the next ping, by the vehicle's clock

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
  std::optional<environment_t> environment_;  // latest message, from which water_ is computed
  std::optional<Water> water_;
  std::vector<std::unique_ptr<Vehicle>> vehicles_;  // message handlers hold pointers to the vehicles
};

}  // namespace halocline::clients
