// Rays, profiles, pyramid and loading on 4096 x 4096 posts of rugged bottom, 10 m apart, about 300 m deep.
//
// Rays start 5 to 250 m above the bottom at random places: V near-vertical to 500 m, S slanted 45 degrees to 10 km,
// G grazing (within 2 degrees of level) to 1..20 km, mix a third each. Targets a core: mix 2.2 million rays/s, a
// profile sample 15 ns, a 4096 x 4096 GeoTIFF with its pyramid 0.2 s; two threads 1.9 times one.
#include <cmath>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>

#include "bathymetry/rasters/raster_loader.h"
#include "bathymetry/terrain/height_grid.h"
#include "bathymetry/terrain/profile.h"
#include "bathymetry/terrain/shallowest_pyramid.h"
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

void trace_rays(benchmark::State& state) {
  static std::vector<Ray> rays[4];
  static std::once_flag drawn;
  std::call_once(drawn, [] {
    for (std::int64_t kind = 0; kind < 4; ++kind) {
      for (std::uint64_t n = 0; n < kRays; ++n) rays[kind].push_back(draw_ray(kind, n));
    }
  });
  const std::vector<Ray>& batch = rays[state.range(0)];
  std::size_t n = static_cast<std::size_t>(state.thread_index()) * kRays / 2;
  for (auto _ : state) {
    benchmark::DoNotOptimize(rugged_terrain().closest_hit(batch[n]));
    n = (n + 1) % kRays;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(trace_rays)->ArgName("V0_S1_G2_mix3")->DenseRange(0, 3)->UseRealTime();
BENCHMARK(trace_rays)->ArgName("V0_S1_G2_mix3")->Arg(kMix)->Threads(2)->UseRealTime();

// Lines of 10 km, a sample every 10 m.
void sample_profile(benchmark::State& state) {
  constexpr std::size_t kSamples = 1001;
  std::uint64_t n = 0;
  for (auto _ : state) {
    const double x = kExtentM * 0.5 * uniform_at({.seed = 2, .which = n}),
                 y = 0.3 * kExtentM + 10 * static_cast<double>(n % 100);
    benchmark::DoNotOptimize(uniform_profile(rugged_terrain(), {x, y}, {x + 6000, y + 8000}, kSamples));
    ++n;
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kSamples));
}
BENCHMARK(sample_profile);

void exact_profile_of_10_km(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(exact_profile(rugged_terrain(), {5000, 5000}, {11'000, 13'000}));
  }
}
BENCHMARK(exact_profile_of_10_km)->Unit(benchmark::kMicrosecond);

void build_pyramid(benchmark::State& state) {
  const HeightGrid& grid = rugged_terrain().grid(0);
  for (auto _ : state) benchmark::DoNotOptimize(ShallowestPyramid(grid));
}
BENCHMARK(build_pyramid)->Unit(benchmark::kMillisecond);

// An uncompressed GeoTIFF in local metres, as files are, read from memory: decoding, checks, pyramid, version.
void load_geotiff(benchmark::State& state) {
  GDALAllRegister();
  const char* path = "/vsimem/bench.tif";
  const HeightGrid& grid = rugged_terrain().grid(0);
  {
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    GDALDataset* file = driver->Create(path, kPosts, kPosts, 1, GDT_Float32, nullptr);
    double geotransform[6] = {-5, 10, 0, kExtentM + 5, 0, -10};
    file->SetGeoTransform(geotransform);
    std::vector<float> heights = grid.posts();
    for (float& height : heights) height = -height;
    if (file->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, kPosts, kPosts, heights.data(), kPosts, kPosts,
                                         GDT_Float32, 0, 0, nullptr) != CE_None) {
      state.SkipWithError("cannot write the raster");
    }
    GDALClose(file);
  }
  for (auto _ : state) {
    LoadedRaster loaded = load_local_raster({.path = path, .coordinate_system = "local"});
    benchmark::DoNotOptimize(Terrain(std::move(loaded.grid)));
  }
  VSIUnlink(path);
}
BENCHMARK(load_geotiff)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace halocline::bathymetry
