// SPDX-License-Identifier: BSD-3-Clause
// Cost of sound that boundaries turn: a transport, an end with its table, and the windows of a link.
#include <cstddef>
#include <cstdint>

#include <benchmark/benchmark.h>

#include "acoustics/fading/path_fading.h"
#include "acoustics/scattering/angle_transport.h"
#include "acoustics/scattering/transport_end.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/ray_water.h"
#include "channel_server/propagation/turned_seas.h"

namespace halocline::channel_server {
namespace {

using acoustics::AngleTransport;
using acoustics::RayWater;
using acoustics::TransportEnd;

const acoustics::RaySurface kSurface{acoustics::SurfaceModel::kAplBubbles, 5};
constexpr double kFrequencyHz = 25'000, kDepthM = 100;

RayWater summer() {
  return RayWater({{0, 1525}, {15, 1525}, {30, 1508}, {50, 1502}, {200, 1504}}, [](double) { return 5.0; });
}

AngleTransport transport_of(const RayWater& water, std::size_t bins) {
  const acoustics::FluidBottom bottom = *acoustics::sediment("MediumSand");
  acoustics::TransportSea sea{water, kDepthM, kFrequencyHz, scattering_surface(kSurface, kFrequencyHz),
                              rough_bottom(bottom, water.speed_at(kDepthM), 0.03, 0.04)};
  sea.bins = bins;
  return AngleTransport(sea);
}

void transport(benchmark::State& state) {
  const RayWater water = summer();
  for (auto _ : state)
    benchmark::DoNotOptimize(transport_of(water, static_cast<std::size_t>(state.range(0))));
}
BENCHMARK(transport)->ArgName("bins")->Arg(48)->Arg(96)->Unit(benchmark::kMillisecond);

// `table` 0: as links over several stretches of depth use it.
void end_of_transport(benchmark::State& state) {
  const RayWater water = summer();
  const AngleTransport sea = transport_of(water, static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(TransportEnd(sea, 42, state.range(1) != 0));
}
BENCHMARK(end_of_transport)
    ->ArgNames({"bins", "table"})
    ->Args({48, 1})
    ->Args({96, 1})
    ->Args({48, 0})
    ->Unit(benchmark::kMicrosecond);

// Windows of a link of known transports, over depths that differ by `rise_m` between its ends.
void windows_of_link(benchmark::State& state) {
  const RayWater water = summer();
  acoustics::FadingModel fading;
  fading.enabled = fading.turns = true;
  const TurnedSeas seas;
  TurnedLink link{water, *acoustics::sediment("MediumSand"), kSurface, fading, kFrequencyHz, {42, 57, 1500}};
  for (std::size_t i = 0; i < link.depths_m.size(); ++i)
    link.depths_m[i] = kDepthM + static_cast<double>(state.range(0)) * static_cast<double>(i) / 16;
  for (auto _ : state) {
    link.link.range_m += 1e-3;
    benchmark::DoNotOptimize(seas.windows_alone(link));
  }
}
BENCHMARK(windows_of_link)
    ->ArgName("rise_m")
    ->Arg(0)
    ->Arg(5)
    ->Arg(30)
    ->Arg(80)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace halocline::channel_server
