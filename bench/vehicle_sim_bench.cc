// Vehicle steps per second: the right-hand side, a Runge-Kutta step, and a step in the ODE world, free and
// grounded.
#include <memory>

#include <benchmark/benchmark.h>

#include "vehicle_sim/equations_of_motion.h"
#include "vehicle_sim/remus100_pvs.h"
#include "vehicle_sim/vehicle_world.h"

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

std::shared_ptr<const Model> model_with(double buoyancy_ratio) {
  ModelParameters p = remus100_pvs_parameters(CurrentTreatment::kGalilean);
  p.buoyancy_n *= buoyancy_ratio;
  return std::make_shared<const Model>(p);
}

VehicleState under_way(double north, double depth) {
  VehicleState s;
  s.position_ned_m = {north, 0, depth};
  s.velocity_body << 2, 0.1, 0.05, 0.01, 0.02, 0.1;
  return s;
}

void right_hand_side(benchmark::State& state) {
  const auto model = model_with(1);
  VehicleState s = under_way(0, 50);
  s.actuators = kCommand;
  const Water water{.current_ned_mps = {0.3, 0.1, 0}, .sea_surface_z_m = 0};
  for (auto _ : state) {
    benchmark::DoNotOptimize(s);
    benchmark::DoNotOptimize(rate_of_change(*model, s, kCommand, water));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(right_hand_side);

void runge_kutta_step(benchmark::State& state) {
  const auto model = model_with(1);
  VehicleState s = under_way(0, 50);
  for (auto _ : state) s = rk4_step(*model, s, kCommand, {}, kStep);
  benchmark::DoNotOptimize(s);
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(runge_kutta_step);

void step_all(benchmark::State& state, std::shared_ptr<const Seabed> seabed, double buoyancy_ratio,
              double depth, const ActuatorValues& command) {
  VehicleWorld world(std::move(seabed));
  const auto model = model_with(buoyancy_ratio);
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

void world_step_over_ground(benchmark::State& state) {
  step_all(state, std::make_shared<Flat>(), 1, 20, {0.1, 0, 20});
}
BENCHMARK(world_step_over_ground)->Arg(1)->Arg(1000);

void world_step_on_ground(benchmark::State& state) {
  step_all(state, std::make_shared<Flat>(), 0.95, 99.8, {});
}
BENCHMARK(world_step_on_ground)->Arg(1)->Arg(1000);

}  // namespace
}  // namespace halocline::vehicle_sim
