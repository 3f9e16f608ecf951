// SPDX-License-Identifier: BSD-3-Clause
// Vehicle steps per second: the right-hand side, a Runge-Kutta step, a step in the ODE world, free and
// grounded, and a fleet's step in each kind of moving water; what each sensor costs.
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include <benchmark/benchmark.h>

#include "core/sim_time.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/dynamics/waves.h"
#include "vehicle_sim/fleet.h"
#include "vehicle_sim/model_library.h"
#include "vehicle_sim/sensor_station.h"
#include "vehicle_sim/sensors/sensor_settings.h"
#include "vehicle_sim/sensors/sensors.h"
#include "vehicle_sim/world/seabed.h"
#include "vehicle_sim/world/vehicle_world.h"

namespace halocline::vehicle_sim {
namespace {

constexpr double kStep = 0.01;
constexpr ActuatorValues kCommand{0.1, -0.05, 20};

class Flat : public Seabed {
 public:
  std::optional<SeabedPlane> plane_at(double, double) const override {
    return SeabedPlane{100, -Vec3::UnitZ()};
  }
};

std::shared_ptr<const Model> model_with(double buoyancy_ratio, const char* name = "torpedo") {
  ModelParameters p = programmed_model(name).value();
  p.buoyancy_n *= buoyancy_ratio;
  return std::make_shared<const Model>(p);
}

VehicleState under_way(double north, double depth) {
  VehicleState s;
  s.position_ned_m = {north, 0, depth};
  s.velocity_body << 2, 0.1, 0.05, 0.01, 0.02, 0.1;
  return s;
}

void right_hand_side(benchmark::State& state, const char* name) {
  const auto model = model_with(1, name);
  VehicleState s = under_way(0, 50);
  s.actuators = kCommand;
  const Water water{.current_ned_mps = {0.3, 0.1, 0}, .sea_surface_z_m = 0};
  for (auto _ : state) {
    benchmark::DoNotOptimize(s);
    benchmark::DoNotOptimize(rate_of_change(*model, s, kCommand, water));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(right_hand_side, torpedo, "torpedo");
BENCHMARK_CAPTURE(right_hand_side, hover, "hover");
BENCHMARK_CAPTURE(right_hand_side, remus100_pvs, "remus100-pvs");

void runge_kutta_step(benchmark::State& state, const char* name) {
  const auto model = model_with(1, name);
  VehicleState s = under_way(0, 50);
  for (auto _ : state) s = rk4_step(*model, s, kCommand, {}, kStep);
  benchmark::DoNotOptimize(s);
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(runge_kutta_step, torpedo, "torpedo");
BENCHMARK_CAPTURE(runge_kutta_step, hover, "hover");
BENCHMARK_CAPTURE(runge_kutta_step, remus100_pvs, "remus100-pvs");

void step_all(benchmark::State& state, std::shared_ptr<const Seabed> seabed, double buoyancy_ratio,
              double depth, const ActuatorValues& command, const char* name = "torpedo") {
  VehicleWorld world(std::move(seabed));
  const auto model = model_with(buoyancy_ratio, name);
  const auto vehicles = static_cast<std::size_t>(state.range(0));
  for (std::size_t i = 0; i < vehicles; ++i) {
    world.add(model, under_way(static_cast<double>(i) * 10, depth));
    world.set_command(i, command);
    world.set_water(i, {.current_ned_mps = {0.3, 0.1, 0}, .sea_surface_z_m = 0});
  }
  for (int i = 0; i < 1000; ++i) world.step(kStep);  // the heavy ones have settled
  for (auto _ : state) world.step(kStep);
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

void world_step_free(benchmark::State& state) { step_all(state, nullptr, 1, 20, kCommand); }
BENCHMARK(world_step_free)->Arg(1)->Arg(100)->Arg(1000)->Arg(10000);

void world_step_free_remus100_pvs(benchmark::State& state) {
  step_all(state, nullptr, 1, 20, kCommand, "remus100-pvs");
}
BENCHMARK(world_step_free_remus100_pvs)->Arg(1000);

void world_step_above_seabed(benchmark::State& state) {
  step_all(state, std::make_shared<Flat>(), 1, 20, {0.1, 0, 20});
}
BENCHMARK(world_step_above_seabed)->Arg(1)->Arg(1000);

void world_step_on_seabed(benchmark::State& state) {
  step_all(state, std::make_shared<Flat>(), 0.95, 99.8, {});
}
BENCHMARK(world_step_on_seabed)->Arg(1)->Arg(1000);

// Steps of a whole fleet, with what its water costs.
void fleet_step(benchmark::State& state, const FleetSettings& settings) {
  const auto model = model_with(1);
  std::vector<FleetMember> members;
  for (int i = 0; i < state.range(0); ++i) members.push_back({"v", model, under_way(i * 10, 20)});
  Fleet fleet(settings, std::move(members), nullptr, SimTime());
  for (auto _ : state) fleet.advance(fleet.time() + settings.step);
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

FleetSettings in_uniform() {
  FleetSettings s;
  s.current.uniform_ned_mps = {0.3, 0.1, 0};
  return s;
}
FleetSettings in_depth_table() {
  FleetSettings s;
  for (int i = 0; i < 20; ++i) s.current.by_depth.push_back({10.0 * i, 0.5 - 0.02 * i, 0.1});
  return s;
}
FleetSettings in_tide() {
  FleetSettings s;
  s.current.tide.amplitude_mps = 0.4;
  return s;
}
FleetSettings in_gauss_markov() {
  FleetSettings s;
  s.current.random = {0.1, 600};
  return s;
}
FleetSettings in_waves(SeaKind kind) {
  FleetSettings s;
  s.waves.kind = kind;
  return s;
}
#define HALOCLINE_FLEET(name, settings) BENCHMARK_CAPTURE(fleet_step, name, settings)->Arg(1)->Arg(1000)
HALOCLINE_FLEET(still, FleetSettings());
HALOCLINE_FLEET(uniform, in_uniform());
HALOCLINE_FLEET(depth_table, in_depth_table());
HALOCLINE_FLEET(tide, in_tide());
HALOCLINE_FLEET(gauss_markov, in_gauss_markov());
HALOCLINE_FLEET(regular_waves, in_waves(SeaKind::kRegular));
HALOCLINE_FLEET(jonswap_of_30, in_waves(SeaKind::kJonswap));
#undef HALOCLINE_FLEET

// One measurement of each of 1000 vehicles, its echoes answered for nothing.
void measure(benchmark::State& state, const SensorSettings& settings) {
  const auto model = model_with(1);
  std::vector<FleetMember> members;
  std::vector<SensorStation::Vehicle> carriers;
  for (int i = 0; i < 1000; ++i) {
    members.push_back({"v", model, under_way(i * 10, 20)});
    carriers.push_back({i + 1, settings});
  }
  const FleetSettings fleet_settings;
  SensorStation station(std::move(carriers), 1, fleet_settings.step, 100);
  Fleet fleet(fleet_settings, std::move(members), nullptr, SimTime());
  for (auto _ : state) {
    state.PauseTiming();
    fleet.advance(station.next());
    state.ResumeTiming();
    for (SensorTick& tick : station.take(fleet, 4096)) {
      for (Echo& echo : tick.echoes) echo = {AltitudeStatus::kMeasured, 30};
      for (const SensorJob& job : tick.jobs) {
        if (const auto* noted = std::get_if<SensorReading>(&job.sample))
          benchmark::DoNotOptimize(station.finish(tick, job, *noted));
        if (const auto* ping = std::get_if<DvlPing>(&job.sample))
          benchmark::DoNotOptimize(station.finish(tick, job, *ping));
        if (const auto* fan = std::get_if<SonarPing>(&job.sample))
          benchmark::DoNotOptimize(station.finish(tick, job, *fan));
      }
    }
  }
  state.SetItemsProcessed(state.iterations() * 1000);
}

SensorSettings with_noise() {
  SensorSettings s;
  for (BasicSensor* sensor : {&s.depth, &s.altimeter, &s.log, &s.compass, &s.gyro})
    sensor->errors.noise = 0.01;
  return s;
}
SensorSettings with_dvl() {
  SensorSettings s;
  s.dvl.period = FleetSettings().step;
  s.dvl.errors.noise = 0.01;
  return s;
}
SensorSettings with_sonar() {
  SensorSettings s;
  s.sonar.period = FleetSettings().step;
  s.sonar.errors.noise = 0.01;
  return s;
}
BENCHMARK_CAPTURE(measure, sensors_without_errors, SensorSettings());
BENCHMARK_CAPTURE(measure, sensors_with_noise, with_noise());
BENCHMARK_CAPTURE(measure, and_doppler_log, with_dvl());
BENCHMARK_CAPTURE(measure, and_sonar_of_32_rays, with_sonar());

}  // namespace
}  // namespace halocline::vehicle_sim
