// SPDX-License-Identifier: BSD-3-Clause
// Pyramid and loading of 4096 x 4096 posts of rugged bottom, 10 m apart, about 300 m deep (rays:
// terrain_rays_bench). Target: a 4096 x 4096 GeoTIFF with its pyramid 0.2 s.
#include <utility>

#include <benchmark/benchmark.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>

#include "bathymetry/rasters/raster_loader.h"
#include "bathymetry/terrain/height_grid.h"
#include "bathymetry/terrain/shallowest_pyramid.h"
#include "bathymetry/terrain/terrain.h"
#include "core/huge_page_vector.h"
#include "tests/bathymetry/terrain/terrain_fixtures.h"

namespace halocline::bathymetry {
namespace {

constexpr int kPosts = 4096;
constexpr double kExtentM = 10.0 * (kPosts - 1);

const Terrain& rugged_terrain() {
  static const Terrain terrain(testing::rugged_grid(kPosts));
  return terrain;
}

void build_pyramid(benchmark::State& state) {
  const HeightGrid& grid = rugged_terrain().grid(0);
  for (auto _ : state) benchmark::DoNotOptimize(ShallowestPyramid(grid));
}
BENCHMARK(build_pyramid)->Unit(benchmark::kMillisecond);

// An uncompressed GeoTIFF in local metres, as files are, read from memory: decoding, checks, pyramid,
// version.
void load_geotiff(benchmark::State& state) {
  GDALAllRegister();
  const char* path = "/vsimem/bench.tif";
  const HeightGrid& grid = rugged_terrain().grid(0);
  {
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    GDALDataset* file = driver->Create(path, kPosts, kPosts, 1, GDT_Float32, nullptr);
    double geotransform[6] = {-5, 10, 0, kExtentM + 5, 0, -10};
    file->SetGeoTransform(geotransform);
    HugePageVector<float> heights = grid.posts();
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
