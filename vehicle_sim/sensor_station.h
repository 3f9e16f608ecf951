// SPDX-License-Identifier: BSD-3-Clause
// All sensors of all vehicles: sampling times, rays to the seabed, and readings once their echoes are known.
//
// Each sensor measures at multiples of its period since time 0. take() notes what holds at the next of these
// instants and lists the beams to be traced; finish() makes readings of what came back. What was noted is
// not touched by anything that happens between the two. Threads: one at a time.
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
// Pings that wait for their echoes: the state when they went out.
struct DvlPing {
  VehicleState state;
};
struct SonarPing {
  VehicleState state;
};

// One measurement of one vehicle; its beams lie at first_beam of its tick's list, as many as it has.
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
  std::vector<Echo> echoes;     // of the beams, unavailable until answered

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

  // `period`: between SENSORS, above 0. `altimeter_range_m` above 0.
  SensorStation(std::vector<Vehicle> vehicles, std::uint64_t seed, SimDuration period,
                double altimeter_range_m);

  // Forgets what was measured; measures from `start` on (an instant of its grid included).
  void begin(SimTime start);
  // When the next measurement is due.
  SimTime next() const { return next_; }

  // The measurements of next(), which the fleet must have reached; moves on. In ticks of `max_beams` beams at
  // most. The first is of the vehicles that wait for no echo, if there are any: nobody waits for the echoes
  // of others alone.
  std::vector<SensorTick> take(const Fleet& fleet, std::size_t max_beams);

  void archive(Archive& a);

  const SensorSettings& settings(std::size_t vehicle) const { return vehicles_[vehicle].settings; }

  // Readings from what a tick noted and the echoes that came.
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
  std::vector<Times> times_;  // of each vehicle, the next
  SimTime next_all_, next_;
};

}  // namespace halocline::vehicle_sim
