// SPDX-License-Identifier: BSD-3-Clause
// Rays on 4096 x 4096 posts of rugged bottom, 10 m apart, about 300 m deep: one by one, in batches, and by
// Embree's robust grid (where CMake finds Embree: ./scripts/setup peers).
//
// Rays start 5 to 250 m above the bottom at random places: V near-vertical to 500 m, S slanted 45 degrees to
// 10 km, G grazing (within 2 degrees of level) to 1..20 km, mix a third each. Targets a core: batches of the
// mix three times as fast as Embree; two threads 1.9 times one.
#include <cmath>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include <benchmark/benchmark.h>

#ifdef HALOCLINE_EMBREE
#include "bench/bathymetry/embree_grid.h"
#endif
#include "bathymetry/terrain/terrain.h"
#include "core/random.h"
#include "tests/bathymetry/terrain/terrain_fixtures.h"

namespace halocline::bathymetry {
namespace {

constexpr int kPosts = 4096;
constexpr double kExtentM = 10.0 * (kPosts - 1);
constexpr std::size_t kRays = 1 << 18;  // drawn before the clock runs

const Terrain& rugged_terrain() {
  static const Terrain terrain(testing::rugged_grid(kPosts));
  return terrain;
}

enum Kind : std::int64_t { kVertical, kSlanted, kGrazing, kMix };

Ray draw_ray(std::int64_t kind, std::uint64_t n) {
  const auto draw = [&](std::uint32_t what, double low, double high) {
    return low +
           (high - low) * uniform_at({.seed = 1, .purpose = purpose_of("bench"), .who = what, .which = n});
  };
  if (kind == kMix) kind = static_cast<std::int64_t>(n % 3);
  const double x = draw(0, 0, kExtentM), y = draw(1, 0, kExtentM), azimuth = draw(2, -3.1416, 3.1416);
  const double down = kind == kVertical  ? draw(3, 1.4, 1.5708)
                      : kind == kSlanted ? 0.7854
                                         : draw(3, -0.035, 0.035);
  const double range = kind == kVertical ? 500 : kind == kSlanted ? 10'000 : draw(4, 1000, 20'000);
  return {{x, y, rugged_terrain().depth_at(x, y).z_m - draw(5, 5, 250)},
          {std::cos(azimuth) * std::cos(down), std::sin(azimuth) * std::cos(down), std::sin(down)},
          range};
}

std::span<const Ray> drawn_rays(std::int64_t kind) {
  static std::vector<Ray> rays[4];
  static std::once_flag drawn;
  std::call_once(drawn, [] {
    for (std::int64_t k = 0; k < 4; ++k) {
      for (std::uint64_t n = 0; n < kRays; ++n) rays[k].push_back(draw_ray(k, n));
    }
  });
  return rays[kind];
}

void trace_rays(benchmark::State& state) {
  const std::span<const Ray> batch = drawn_rays(state.range(0));
  std::size_t n = static_cast<std::size_t>(state.thread_index()) * kRays / 2;
  for (auto _ : state) {
    benchmark::DoNotOptimize(rugged_terrain().closest_hit(batch[n]));
    n = (n + 1) % kRays;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(trace_rays)->ArgName("V0_S1_G2_mix3")->DenseRange(0, 3)->UseRealTime();
BENCHMARK(trace_rays)->ArgName("V0_S1_G2_mix3")->Arg(kMix)->Threads(2)->UseRealTime();

// 0: all rays in one batch.
void trace_rays_in_batches(benchmark::State& state) {
  const std::span<const Ray> rays = drawn_rays(state.range(0));
  const std::size_t size = state.range(1) == 0 ? kRays : static_cast<std::size_t>(state.range(1));
  std::size_t n = static_cast<std::size_t>(state.thread_index()) * kRays / 2;
  for (auto _ : state) {
    benchmark::DoNotOptimize(rugged_terrain().closest_hits(rays.subspan(n, size)));
    n = (n + size) % kRays;
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(size));
}
BENCHMARK(trace_rays_in_batches)
    ->ArgNames({"V0_S1_G2_mix3", "batch"})
    ->ArgsProduct({{0, 1, 2}, {4096}})
    ->ArgsProduct({{kMix}, {32, 256, 1024, 4096, 0}})
    ->UseRealTime();
BENCHMARK(trace_rays_in_batches)
    ->ArgNames({"V0_S1_G2_mix3", "batch"})
    ->Args({kMix, 4096})
    ->Threads(2)
    ->UseRealTime();

#ifdef HALOCLINE_EMBREE
void trace_rays_with_embree(benchmark::State& state) {
  static const EmbreeGrid grid(rugged_terrain().grid(0));
  const std::span<const Ray> rays = drawn_rays(state.range(0));
  std::size_t n = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(grid.range_of_hit(rays[n]));
    n = (n + 1) % kRays;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(trace_rays_with_embree)->ArgName("V0_S1_G2_mix3")->DenseRange(0, 3)->UseRealTime();
#endif

}  // namespace
}  // namespace halocline::bathymetry
