// Claims about the acoustics' speed: docs/performance.md holds the table.
#include <vector>

#include <benchmark/benchmark.h>

#include "acoustics/link/link_budget.h"
#include "acoustics/link/multipath.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "core/frames.h"

namespace halocline::acoustics {
namespace {

LinkModel default_model() { return LinkModel(Environment{}, Modem{}, Modem{}); }

// A node that moves a little from call to call, so that nothing is the same twice.
Vec3 moving_node(int i, double depth_m) {
  return {1000.0 + i % 997, 0.5 * (i % 89), depth_m + 0.1 * (i % 101)};
}

// The whole budget of a link, capacity included. Argument: depth of the far node; the near one is at 100 m.
void straight_link(benchmark::State& state) {
  const LinkModel model = default_model();
  const double depth_m = static_cast<double>(state.range(0));
  int i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(model.budget({0, 0, 100}, moving_node(++i, depth_m)));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(straight_link)->Arg(100)->Arg(150)->Arg(1000)->Arg(4000);

// Both ends at one depth: no integral over depth.
void level_link(benchmark::State& state) {
  const LinkModel model = default_model();
  int i = 0;
  for (auto _ : state) {
    Vec3 to = moving_node(++i, 100);
    to.z() = 100;
    benchmark::DoNotOptimize(model.budget({0, 0, 100}, to));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(level_link);

void travel_time(benchmark::State& state) {
  const LinkModel model = default_model();
  int i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(model.delay_s({0, 0, 100}, moving_node(++i, 1000)));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(travel_time);

void nine_echoes(benchmark::State& state) {
  const LinkModel model = default_model();
  std::vector<BottomPoint> points;
  for (const double fraction : bottom_point_fractions(9))
    points.push_back({{1000 * fraction, 0, 900}, false, false});
  for (auto _ : state) benchmark::DoNotOptimize(assess_echoes(model, {0, 0, 100}, {1000, 0, 300}, points));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(nine_echoes);

void make_link_model(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(default_model());
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(make_link_model)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace halocline::acoustics
