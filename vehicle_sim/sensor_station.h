// SPDX-License-Identifier: BSD-3-Clause
// Sensor station: samples all sensors of all vehicles, and computes their readings once the echoes are known.
//
// Each sensor measures at multiples of its period since time 0. take() records the vehicles' states at the
// next of these instants and lists the beams to be traced; finish() computes readings from the echoes.
// Nothing that happens between the two changes what was recorded. Threads: one at a time.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "core/archive.h"
#include "core/sim_time.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/fleet.h"
#include "vehicle_sim/sensors/doppler_log.h"
#include "vehicle_sim/sensors/sensor_errors.h"
#include "vehicle_sim/sensors/sensor_settings.h"
#include "vehicle_sim/sensors/sensors.h"

namespace halocline::vehicle_sim {

struct GpsFix {
  Eigen::Vector2d north_east_m = Eigen::Vector2d::Zero();
};
// Pings that wait for their echoes, with the vehicle's state at transmission.
struct DvlPing {
  VehicleState state;
};
struct SonarPing {
  VehicleState state;
};

// One measurement of one vehicle. Its beams are the `beams` elements from `first_beam` on in the list of its
// tick.
struct SensorJob {
  std::size_t vehicle = 0;  // index
  std::variant<SensorReading, GpsFix, DvlPing, SonarPing> sample;
  std::size_t first_beam = 0, beams = 0;
};

// Measurements of one instant.
struct SensorTick {
  SimTime when;
  std::vector<SensorJob> jobs;
  std::vector<EchoBeam> beams;  // to be traced
  std::vector<Echo> echoes;     // one for each beam; unavailable until answered

  std::span<const Echo> echoes_of(const SensorJob& job) const {
    return std::span(echoes).subspan(job.first_beam, job.beams);
  }
};

class SensorStation {
 public:
  struct Vehicle {
    std::int32_t id = 1;
    SensorSettings settings;
  };

  // `period`: interval between SENSORS messages, above 0. `altimeter_range_m`: above 0.
  SensorStation(std::vector<Vehicle> vehicles, std::uint64_t seed, SimDuration period,
                double altimeter_range_m);

  // Discards all measurements and starts at `start`, which is included when it is an instant of the grid.
  void begin(SimTime start);
  SimTime next() const { return next_; }

  // Takes the measurements of next(), which the fleet must have reached, and proceeds to the next instant.
  // They are divided into ticks of at most `max_beams` beams. Vehicles that wait for no echo are in the first
  // tick, so that they need not wait for the echoes of others.
  std::vector<SensorTick> take(const Fleet& fleet, std::size_t max_beams);

  void archive(Archive& a);

  const SensorSettings& settings(std::size_t vehicle) const { return vehicles_[vehicle].settings; }

  // Returns the readings computed from a tick's record and its echoes.
  SensorReading finish(const SensorTick& tick, const SensorJob& job, const SensorReading& noted);
  DvlReading finish(const SensorTick& tick, const SensorJob& job, const DvlPing& ping);
  std::vector<Echo> finish(const SensorTick& tick, const SensorJob& job, const SonarPing& ping) const;

 private:
  struct Times {
    SimTime dvl, gps, sonar;
  };
  using Job = std::pair<SensorJob, std::vector<EchoBeam>>;

  SensorIdentity identity(std::size_t vehicle, SensorKind kind) const {
    return {seed_, vehicles_[vehicle].id, kind};
  }
  void find_next();
  void measure(const Fleet& fleet, std::size_t vehicle, bool all_due, std::vector<Job>& jobs);

  std::vector<Vehicle> vehicles_;
  std::uint64_t seed_;
  SimDuration period_;
  double altimeter_range_m_;
  std::vector<SensorSuite> suites_;
  std::vector<BiasWalk> dvl_walks_;
  std::vector<Times> times_;  // next instants, by vehicle
  SimTime next_all_, next_;
};

}  // namespace halocline::vehicle_sim
