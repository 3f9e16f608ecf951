// SPDX-License-Identifier: BSD-3-Clause
// What the eigenrays of one link cost on one core: searched for, and extrapolated from a search near by.
//
// Claims (microseconds, searched for): isovelocity 3, layered of 3 and 7 knots 20, deep water thinned from
// 101 knots 80, a slope 170, a bottom of many facets 1500.
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "acoustics/link/energy_flux.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/extrapolate_eigenrays.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/ray_water.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "tests/acoustics/rays/layered_waters.h"

namespace halocline::acoustics {
namespace {

double some_absorption(double depth_m) { return 4.5 - 1e-4 * depth_m; }

RaySea sea_of(const std::vector<SpeedRow>& knots, BottomProfile bottom) {
  return {RayWater(knots, some_absorption), std::move(bottom), fluid_bottom(1.9, 1650, 0.8),
          RaySurface{SurfaceModel::kFlat, 0}, RayOptions{}};
}

const std::vector<SpeedRow> kSeamountWater = {{0, 1520}, {50, 1490}, {200, 1492}};

struct Situation {
  RaySea sea;
  RayLink link;
};

Situation situation(int which) {
  switch (which) {
    case 0:
      return {sea_of({{0, 1500}}, BottomProfile::flat(100)), {30, 50, 3000}};
    case 1:
      return {sea_of(kThermocline, BottomProfile::flat(100)), {20, 50, 2000}};
    case 2:
      return {sea_of(kShelf, BottomProfile::flat(100)), {25, 60, 2000}};
    case 3:
      return {sea_of(thinned(munk_knots(), 0.1), BottomProfile::flat(5000)), {1000, 800, 50000}};
    case 4:
      return {sea_of(munk_knots(), BottomProfile::flat(5000)), {1000, 800, 50000}};
    case 5:
      return {sea_of({{0, 1500}}, BottomProfile({{0, 100}, {5000, 40}})), {20, 30, 2000}};
    case 6:
      return {sea_of(kSeamountWater, BottomProfile({{0, 200}, {1500, 200}, {2500, 80}, {3500, 200}})),
              {20, 50, 3000}};
    default:
      return {sea_of(kSeamountWater, cosine_hill()), {20, 50, 3000}};
  }
}

constexpr const char* kNames[] = {"isovelocity",        "layered_3_knots",   "layered_7_knots",
                                  "deep_thinned",       "deep_101",          "slope",
                                  "seamount_3_corners", "hill_of_100_facets"};

void cold(benchmark::State& state) {
  const auto which = static_cast<int>(state.range(0));
  Situation at = situation(which);
  std::size_t paths = 0;
  for (auto _ : state) {
    at.link.range_m += 1e-6;
    paths = eigenrays(at.sea, at.link).paths.size();
    benchmark::DoNotOptimize(paths);
  }
  state.SetLabel(kNames[which]);
  state.counters["paths"] = static_cast<double>(paths);
}
BENCHMARK(cold)->DenseRange(0, 7)->Unit(benchmark::kMicrosecond);

// Four bottoms of 5 m of relief.
std::vector<Situation> over_rough_bottoms(double range_m) {
  std::vector<Situation> all;
  for (std::uint32_t seed = 0; seed < 4; ++seed)
    all.push_back({sea_of(kRoughWater, rough_bottom(seed, range_m)), {40, 70, range_m}});
  return all;
}

// Over these, the range in metres; what is weak as power (0), every ray one by one (1), as power also what is
// weaker than 1e-4 of the pressure at 1 m, 80 dB (2).
void rough_bottoms(benchmark::State& state) {
  std::vector<Situation> all = over_rough_bottoms(static_cast<double>(state.range(0)));
  for (Situation& at : all) {
    if (state.range(1) == 1) at.sea.options.diffuse_below_db = 0;
    if (state.range(1) == 2) at.sea.options.diffuse_below_pressure = 1e-4;
  }
  std::size_t paths = 0;
  for (auto _ : state) {
    paths = 0;
    for (Situation& at : all) {
      at.link.range_m += 1e-6;
      paths += eigenrays(at.sea, at.link).paths.size();
    }
    benchmark::DoNotOptimize(paths);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all.size()));
  state.counters["paths"] = static_cast<double>(paths) / static_cast<double>(all.size());
}
BENCHMARK(rough_bottoms)
    ->ArgNames({"range_m", "paths"})
    ->ArgsProduct({{500, 1000, 2000, 3000, 5000}, {0, 1, 2}})
    ->Unit(benchmark::kMillisecond);

// What a link over these costs that is so weak that its rays are not traced.
void flux_only_link(benchmark::State& state) {
  std::vector<Situation> all = over_rough_bottoms(static_cast<double>(state.range(0)));
  for (auto _ : state) {
    for (Situation& at : all) {
      at.link.range_m += 1e-6;
      benchmark::DoNotOptimize(
          energy_flux_eigenrays({at.sea.water, 150, at.sea.bottom, at.sea.surface, at.sea.options}, at.link));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all.size()));
}
BENCHMARK(flux_only_link)->ArgName("range_m")->Arg(3000)->Arg(6000)->Unit(benchmark::kMicrosecond);

// To first order, as the channel server does within a cell. Items are paths.
void extrapolate(benchmark::State& state) {
  const Situation at = situation(2);
  const std::vector<Eigenray> before = eigenrays(at.sea, at.link).paths;
  const EndSpeeds speeds{at.sea.water.speed_at(at.link.source_depth_m),
                         at.sea.water.speed_at(at.link.receiver_depth_m)};
  RayLink moved = at.link;
  for (auto _ : state) {
    moved.range_m += 1e-3;
    benchmark::DoNotOptimize(extrapolate_eigenrays(before, at.link, speeds, moved));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(before.size()));
}
BENCHMARK(extrapolate);

}  // namespace
}  // namespace halocline::acoustics
