// SPDX-License-Identifier: BSD-3-Clause
// The examples in the comments of the headers of acoustics/, compiled and run (tests/docs/check_examples).
#include <algorithm>
#include <cmath>
#include <iostream>
#include <span>
#include <sstream>

#include <gtest/gtest.h>

#include "acoustics/link/link_budget.h"
#include "acoustics/link/link_kernel.h"
#include "acoustics/math/depth_means.h"
#include "acoustics/math/gauss_legendre.h"
#include "acoustics/math/symmetric_eigenproblem.h"
#include "acoustics/modem/bit_error.h"
#include "acoustics/modem/modem.h"
#include "acoustics/noise/place_noise.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "acoustics/sea/surface/surface_boundary.h"
#include "acoustics/sea/surface/surface_layers.h"
#include "acoustics/sea/water_load.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

TEST(HeaderExamples, GaussLegendre) {
  const double area = integrate(gauss_legendre_5(), 0.0, 1.0, [](double x) { return x * x; });
  EXPECT_NEAR(area, 1.0 / 3, 1e-15);
}

TEST(HeaderExamples, SymmetricEigenproblem) {
  const EigenPairs pairs = symmetric_eigenpairs({{2, 1, 1, 2}}, 2);  // values 1 and 3
  EXPECT_NEAR(std::min(pairs.values[0], pairs.values[1]), 1, 1e-14);
  EXPECT_NEAR(std::max(pairs.values[0], pairs.values[1]), 3, 1e-14);
}

TEST(HeaderExamples, Modem) {
  const Modem modem = generic_modem(Decibels{185}, Decibels{70}, 25'000, 5'000);
  const SimDuration duration = packet_timing(modem, 16).duration;
  const double bit_errors = bit_error_rate(modem, to_power_ratio(Decibels{-8}));
  EXPECT_NEAR(duration.seconds(), 1.6, 1e-9);
  EXPECT_NEAR(bit_errors, 0.5 * std::exp(-0.5 * std::pow(10, -0.8) * 5000 / 80), 1e-12);
}

TEST(HeaderExamples, BitError) {
  const double errors = bit_error_rate(Modulation::kBpsk, Fading::kNone, to_power_ratio(Decibels{9.6}));
  EXPECT_NEAR(errors, 9.7e-6, 1e-7);
}

TEST(HeaderExamples, Eigenray) {
  const Environment environment;
  std::ostringstream printed;
  std::streambuf* const to_console = std::cout.rdbuf(printed.rdbuf());
  const RayOptions options{.frequency_hz = 11'520};
  const RaySea sea{ray_water(environment, options.frequency_hz), BottomProfile::flat(100),
                   *sediment("MediumSand"), RaySurface{.wind_mps = 5}, options};
  const Eigenrays found = eigenrays(sea, {.source_depth_m = 30, .receiver_depth_m = 50, .range_m = 2000});
  for (const Eigenray& path : found.paths)
    std::cout << path.delay_s << ' ' << path.received_pressure() << '\n';
  if (found.shadow()) std::cout << "no ray gets there\n";
  std::cout.rdbuf(to_console);
  EXPECT_FALSE(found.shadow());
  EXPECT_NE(printed.str(), "");
}

TEST(HeaderExamples, LinkBudget) {
  const Environment environment;
  const Modem transmitter, receiver;
  const Vec3 from_ned_m(0, 0, 10), to_ned_m(1000, 0, 20);
  const LinkModel model(environment, transmitter, receiver);
  const LinkBudget link = model.budget(from_ned_m, to_ned_m);
  EXPECT_NEAR(link.range_m, std::hypot(1000, 10), 1e-9);
}

TEST(HeaderExamples, LinkKernel) {
  const Environment environment;
  const Modem transmitter, receiver;
  const Vec3 from_ned_m(0, 0, 10), to_ned_m(1000, 0, 20);
  const LinkKernel kernel(environment, transmitter, receiver);
  const LinkBudget link = kernel.budget(from_ned_m, to_ned_m, Capacity::kComputed);
  EXPECT_GT(link.capacity_bps, 0);
}

TEST(HeaderExamples, DepthMeans) {
  const DepthMeans water({0, 50, 12'000}, 1,
                         [](double, std::span<double> values) { values[0] = 1 / 1500.0; });
  const double slowness_s_per_m = water.mean(0, water.place(10), water.place(70));
  EXPECT_NEAR(slowness_s_per_m, 1 / 1500.0, 1e-18);
}

TEST(HeaderExamples, Absorption) {
  const double a = absorption_spectrum(
                       AbsorptionModel::kFisherSimmons1977,
                       {.temperature_degc = 4, .salinity_psu = 35, .depth_m = 0, .pressure_atm = 1, .ph = 8})
                       .components_at(10e3)
                       .total_db_per_km;
  EXPECT_NEAR(a, 0.83, 0.005);
}

TEST(HeaderExamples, PlaceNoise) {
  const double level_db = place_noise(NoisePlace::kHarbour, 25e3).value().value;
  EXPECT_NEAR(level_db, 50.4, 0.05);
}

TEST(HeaderExamples, WaterLoad) {
  const double db_per_km = WaterLoad{.particles_kg_m3 = 0.2, .particle_radius_m = 3e-6}.db_per_km(25e3);
  EXPECT_NEAR(db_per_km, 7.5, 0.05);
}

TEST(HeaderExamples, BoundaryReflection) {
  const FluidBottom sand = sediment("MediumSand").value();
  const double lost_db = bottom_reflection(sand, to_radians(15), 1500).loss_db();
  EXPECT_GT(lost_db, 0);
}

TEST(HeaderExamples, SurfaceLayers) {
  const double under = surface_waves(14).share_under_water(0.5);  // 0.6753 of the time
  const double lost_db = bubble_layer(14, 25'000).straight_loss_db(0.5, 20, 500.4);
  EXPECT_NEAR(under, 0.6753, 1e-4);
  EXPECT_NEAR(lost_db, 10.16, 0.01);
}

TEST(HeaderExamples, SurfaceBoundary) {
  const SurfaceBoundary rough = surface_boundary(10, {}, 25'000);
  const double kept = rough.kept_power(0.2);  // B of a bounce
  EXPECT_NEAR(kept, 0.435, 0.001);
}

TEST(HeaderExamples, SoundSpeed) {
  const double c = mackenzie_1981(25, 35, 1000);
  EXPECT_NEAR(c, 1550.744, 5e-4);
}

TEST(HeaderExamples, SoundSpeedProfile) {
  const auto water = SoundSpeedProfile::global_mean();
  const double delay_s = water.travel_time_s(100, 900, std::hypot(2000, 800));
  EXPECT_NEAR(delay_s, std::hypot(2000, 800) / 1490, 0.02);
}

}  // namespace
}  // namespace halocline::acoustics
