// SPDX-License-Identifier: BSD-3-Clause
// Claims about the acoustics' speed: docs/performance.md holds the table.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include <benchmark/benchmark.h>

#include "acoustics/link/band_capacity.h"
#include "acoustics/link/bottom_echo.h"
#include "acoustics/link/link_budget.h"
#include "acoustics/link/link_kernel.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "acoustics/waveform/analytic_signal.h"
#include "acoustics/waveform/moving_link.h"
#include "core/elementary.h"
#include "core/frames.h"

namespace halocline::acoustics {
namespace {

LinkKernel default_kernel(VectorInstructions instructions = vector_instructions().back()) {
  return LinkKernel(Environment{}, Modem{}, Modem{}, instructions);
}

// A node that moves a little from call to call, so that nothing is the same twice.
Vec3 moving_node(int i, double depth_m) {
  return {1000.0 + i % 997, 0.5 * (i % 89), depth_m + 0.1 * (i % 101)};
}

// Links of one node at 100 m with others at depths spread about `depth_m`. Arguments: that depth, and the
// vector instructions (-1: capacity left out).
void straight_link(benchmark::State& state) {
  const bool with_capacity = state.range(1) >= 0;
  const auto instructions = static_cast<VectorInstructions>(std::max<std::int64_t>(state.range(1), 0));
  const auto known = vector_instructions();
  if (std::find(known.begin(), known.end(), instructions) == known.end())
    return state.SkipWithError("not on this processor");
  const LinkKernel kernel = default_kernel(instructions);
  const double depth_m = static_cast<double>(state.range(0));
  const Capacity capacity = with_capacity ? Capacity::kComputed : Capacity::kLeftOut;
  int i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(kernel.budget({0, 0, 100}, moving_node(++i, depth_m), capacity));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(straight_link)->ArgsProduct({{95, 1000}, {-1, 0, 1, 2}});
BENCHMARK(straight_link)->Args({95, 2})->Threads(2)->UseRealTime();

// By the formulas as they stand.
void link_model(benchmark::State& state) {
  const LinkModel model(Environment{}, Modem{}, Modem{});
  int i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(model.budget({0, 0, 100}, moving_node(++i, 95)));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(link_model);

// All echoes of a link whose receiver is deaf to them.
void nine_echoes(benchmark::State& state) {
  Modem deaf;
  deaf.min_receivable_level = {200};
  const LinkKernel kernel(Environment{}, deaf, deaf);
  const std::vector<double> bottom_z_m(kBottomDepths, 900);
  for (auto _ : state)
    benchmark::DoNotOptimize(is_echo_likely(kernel, {0, 0, 100}, {1000, 0, 300}, bottom_z_m));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(nine_echoes);

void make_link_kernel(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(default_kernel());
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(make_link_kernel)->Unit(benchmark::kMicrosecond);

// A second of ten links of 20 paths each, which move, at 96 kHz.
void ten_waveform_links(benchmark::State& state) {
  constexpr double kRateHz = 96'000, kStep_s = 0.02;
  constexpr int kLinks = 10, kPaths = 20, kFrames = 52;
  std::vector<double> tone(static_cast<std::size_t>(kRateHz));
  for (std::size_t i = 0; i < tone.size(); ++i)
    tone[i] = elementary::sin(0.25 * std::numbers::pi * static_cast<double>(i % 8));
  const AnalyticSignal sent(kRateHz, tone);
  std::vector<std::vector<PathGain>> frames(kFrames);
  for (int k = 0; k < kFrames; ++k) {
    for (int path = 0; path < kPaths; ++path)
      frames[static_cast<std::size_t>(k)].push_back({static_cast<std::uint64_t>(path),
                                                     0.3 + 0.002 * path + 1e-6 * k * path,
                                                     {0.1 / (1 + path), 0.05},
                                                     1});
  }
  const MovingLink link(0, kStep_s, frames);
  for (auto _ : state) {
    Samples received{0, kRateHz, std::vector<double>(static_cast<std::size_t>(1.5 * kRateHz))};
    for (int i = 0; i < kLinks; ++i) link.add_received(sent, 0, received);
    benchmark::DoNotOptimize(received.values.data());
  }
  state.counters["of_real_time"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(ten_waveform_links)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace halocline::acoustics
