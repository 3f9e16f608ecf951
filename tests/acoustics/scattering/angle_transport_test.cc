// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/scattering/angle_transport.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/scattering/delay_windows.h"
#include "acoustics/scattering/turned_sound.h"
#include "core/units.h"
#include "tests/acoustics/scattering/transport_seas.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using testing::bounced_loss_db;
using testing::loss_db;
using testing::mean_rate_power;
using testing::tolerance;
using testing::TransportSeaOf;

// Sea without any loss: even water, waves of 8 m/s, a rough bottom that reflects all.
AngleTransport lossless(double depth_m) {
  const RayWater water({{0, 1500}, {depth_m, 1500}}, [](double) { return 0.0; });
  return AngleTransport(
      {water, depth_m, 25'000, scattering_surface({SurfaceModel::kFlat, 8}, 25'000), {0.03, 0.04}});
}

// Closed form: power stays and fills all angles, I = 2 theta_max / (r H).
TEST(AngleTransport, KeepsAllPowerInALosslessRoughSea) {
  const AngleTransport sea = lossless(50);
  const TransportEnd upper(sea, 20), lower(sea, 33);
  const double expected_db = loss_db(2 * to_radians(88) / (2000.0 * 50));
  EXPECT_NEAR(expected_db, 45.126099646, 1e-8);
  EXPECT_NEAR(loss_db(mean_rate_power(sea, upper, lower, 2000)), expected_db, tolerance(1e-9));
  const TurnedSound sound = turned_sound(sea, upper, lower, 2000);
  EXPECT_NEAR(loss_db(sound.power + sound.unbounced), expected_db, tolerance(0.03));
}

// Power that is launched goes with the cosine, reception does not: the directions of a link differ a little
// where scattering changes the angle, by 1 dB at most. The link takes the mean of both, which is reciprocal.
TEST(AngleTransport, DiffersLittleBetweenTheDirections) {
  const TransportSeaOf summer{{{0, 1526}, {15, 1526.3}, {30, 1507}, {50, 1501}, {100, 1501.8}},
                              100,
                              25'000,
                              9,
                              "MediumSand",
                              5,
                              true};
  const AngleTransport sea = summer.transport();
  const TransportEnd upper(sea, 10), lower(sea, 77);
  for (const double range_m : {300.0, 3000.0}) {
    const TurnedSound down = turned_sound(sea, upper, lower, range_m);
    const TurnedSound up = turned_sound(sea, lower, upper, range_m);
    EXPECT_NEAR(loss_db(down.power), loss_db(up.power), 1);
    EXPECT_NEAR(loss_db(DelaySpectrum(down, up).power()), loss_db(DelaySpectrum(up, down).power()),
                tolerance(1e-9));
  }
}

// Energy: a row of T sums to at most what the bounce keeps, and to all of it without loss.
TEST(AngleTransport, BouncesKeepTheirPower) {
  const AngleTransport sea = lossless(20);
  for (const Boundary boundary : {Boundary::kSurface, Boundary::kBottom}) {
    for (std::size_t i = 0; i < sea.size(); ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < sea.size(); ++j) sum += sea.bounce_row(boundary, i)[j];
      EXPECT_NEAR(sum, 1, tolerance(1e-12)) << i;
    }
  }
}

// Mode stripping, eta r >> 2 H, smooth and without absorption: I = sqrt(2 pi / (eta H)) r^-1.5 where
// |V|^2 = exp(-eta sin(theta)) (Weston 1971).
TEST(AngleTransport, StripsSteepSoundAsThePowerLaw) {
  const double eta = 0.3, depth_m = 100, range_m = 10'000;
  const RayWater water({{0, 1500}, {depth_m, 1500}}, [](double) { return 0.0; });
  const AngleTransport sea(
      {water, depth_m, 25'000, {}, {0, 0, [&](double s) { return std::exp(-eta * s); }}});
  const TransportEnd end(sea, 50);
  const TurnedSound sound = turned_sound(sea, end, end, range_m);
  const double expected = std::sqrt(2 * std::numbers::pi / (eta * depth_m)) * std::pow(range_m, -1.5);
  EXPECT_NEAR(loss_db(sound.power + sound.unbounced), loss_db(expected), tolerance(0.1));
}

struct OracleRow {
  const char* name;
  TransportSeaOf sea;
  double depth_m;
  std::vector<double> bounced_db;  // at 200, 500, 1000, 2000, 5000 and 10 000 m; 0: not compared
};

// Power of what has bounced in seven seas, by the numpy oracle of 192 bins and one ray a bin. Left out:
// levels beyond 120 dB, and places where the first bounce of flat rays decides, which one ray a bin does not
// resolve. In the tropic the oracle's values are those of 800 bins: with 192 they are 0.8 and 1.2 dB too low
// beyond 5 km, since a fifth of a bin decides there which rays the surface meets.
TEST(AngleTransport, AgreesWithTheOracleOfSevenSeas) {
  const std::vector<SpeedRow> even{{0, 1500}, {20, 1500}}, winter{{0, 1482}, {100, 1483.6}};
  const std::vector<OracleRow> rows{
      {"even 20 m",
       {even, 20, 25'000, 5, "MediumSand", 4.644842},
       10,
       {40.681, 49.924, 59.236, 71.243, 95.385, 0}},
      {"even 15 m",
       {{{0, 1500}, {15, 1500}}, 15, 13'000, 8, "FineSand", 1.374652},
       7.5,
       {41.831, 51.143, 59.739, 68.323, 80.621, 93.053}},
      {"winter",
       {winter, 100, 25'000, 5, "MediumSand", 5.334009, true},
       60,
       {45.328, 51.862, 59.190, 70.253, 94.901, 0}},
      {"summer",
       {{{0, 1526}, {15, 1526.3}, {30, 1507}, {50, 1501}, {100, 1501.8}},
        100,
        25'000,
        5,
        "MediumSand",
        4.502292,
        true},
       60,
       {45.384, 52.074, 59.174, 67.460, 87.379, 114.546}},
      {"gale",
       {winter, 100, 25'000, 14, "MediumSand", 5.334009, true},
       60,
       {46.911, 54.808, 63.907, 76.774, 106.342, 151.565}},
      {"ice",
       {{{0, 1435}, {7.5, 1435.2}}, 7.5, 10'000, 0, "SandySilt", 1.276111, true, true},
       3.75,
       {45.517, 0, 54.257, 60.696, 73.189, 90.127}},
      {"tropic",
       {{{0, 1541.9}, {15, 1541.2}}, 15, 25'000, 5, "SandySilt", 2.426587, true},
       7.5,
       {48.58, 55.43, 0, 65.79, 84.68, 110.42}},
  };
  const double ranges_m[] = {200, 500, 1000, 2000, 5000, 10'000};
  for (const OracleRow& row : rows) {
    const AngleTransport sea = row.sea.transport(128);
    for (std::size_t i = 0; i < row.bounced_db.size(); ++i) {
      if (row.bounced_db[i] == 0) continue;
      EXPECT_NEAR(bounced_loss_db(sea, row.depth_m, row.depth_m, ranges_m[i]), row.bounced_db[i],
                  tolerance(0.5))
          << row.name << " " << ranges_m[i];
    }
  }
}

// Few bins: within 0.5 dB of many, where the transport is used with them.
TEST(AngleTransport, NeedsFewBinsForEndsInMidWater) {
  const TransportSeaOf seas[] = {{{{0, 1500}, {20, 1500}}, 20, 25'000, 5, "MediumSand", 4.6},
                                 {{{0, 1482}, {100, 1483.6}}, 100, 25'000, 5, "MediumSand", 5.3, true},
                                 {{{0, 1541.9}, {15, 1541.2}}, 15, 25'000, 5, "SandySilt", 2.4, true}};
  for (const TransportSeaOf& one : seas) {
    const AngleTransport few = one.transport(48), many = one.transport(96);
    for (const double range_m : {200.0, 500.0, 2000.0, 5000.0})
      EXPECT_NEAR(bounced_loss_db(few, one.depth_m / 2, one.depth_m / 2, range_m),
                  bounced_loss_db(many, one.depth_m / 2, one.depth_m / 2, range_m), tolerance(0.5))
          << one.depth_m << " " << range_m;
  }
}

// A surface duct above a barrier at 40 m and a deep duct below it: flat rays of each stay there without
// scattering by a boundary, so an end below hears little of the upper duct.
TEST(AngleTransport, KeepsTwoDuctsApart) {
  const TransportSeaOf ducts{
      {{0, 1500}, {20, 1500.5}, {40, 1510}, {70, 1499}, {100, 1503}}, 100, 25'000, 0, "MediumSand", 5};
  const AngleTransport sea = ducts.transport();
  std::size_t states_above = 0, states_below = 0;
  for (const TransportState& state : sea.states()) {
    if (state.lower_m < 40) ++states_above;
    if (state.upper_m > 40) ++states_below;
  }
  EXPECT_GT(states_above, 3u);
  EXPECT_GT(states_below, 3u);
  EXPECT_GT(sea.size(), 48u);
}

// Depth that varies: over stretches of one depth the sound is that of the depth, and shoaling water costs.
TEST(AngleTransport, LosesMoreWhereTheWaterGetsShallow) {
  const TransportSeaOf deep{{{0, 1500}, {60, 1500}}, 40, 25'000, 5, "MediumSand", 4.6};
  TransportSeaOf shallow = deep;
  shallow.depth_m = 20;
  const auto over = [](const TransportSeaOf& one) {
    return std::make_shared<const AngleTransport>(one.transport());
  };
  const std::shared_ptr<const AngleTransport> a = over(deep), b = over(shallow);
  const TransportEnd end(*a, 10), shallow_end(*b, 10);
  const double one_db = loss_db(turned_sound(*a, end, end, 2000).power);
  EXPECT_NEAR(loss_db(turned_sound({{a, 900}, {a, 1100}}, end, end).power), one_db, tolerance(0.6));
  EXPECT_GT(loss_db(turned_sound({{a, 1000}, {b, 1000}}, end, shallow_end).power), one_db);
}

// Windows hold all power; they last as measured channels do (some 8 to 30 ms over 15 m of fine sand, 13 kHz).
TEST(DelaySpectrum, LastsAsMeasuredChannelsDo) {
  const TransportSeaOf space{{{0, 1500}, {15, 1500}}, 15, 13'000, 6, "FineSand", 1.4};
  const AngleTransport sea = space.transport();
  const TransportEnd source(sea, 11), receiver(sea, 12);
  for (const double range_m : {60.0, 200.0, 1000.0}) {
    const TurnedSound forward = turned_sound(sea, source, receiver, range_m);
    const TurnedSound backward = turned_sound(sea, receiver, source, range_m);
    const DelaySpectrum spectrum(forward, backward);
    const std::vector<DelayWindow> windows = spectrum.windows();
    ASSERT_EQ(windows.size(), kMaxDelayWindows);
    // All but the last hundredth of the power.
    const double lasts_s = windows[14].excess_s - windows.front().excess_s;
    EXPECT_GT(lasts_s, 0.006) << range_m;
    EXPECT_LT(lasts_s, 0.030) << range_m;
    double sum = 0, before_s = -1;
    for (const DelayWindow& window : windows) {
      EXPECT_GE(window.excess_s, before_s);
      before_s = window.excess_s;
      sum += window.power;
    }
    EXPECT_NEAR(sum / (0.5 * (forward.power + backward.power)), 1, tolerance(1e-12));
  }
}

// Windows move with the range, without steps: 0.1 m of a kilometre changes no delay by a percent.
TEST(DelaySpectrum, MovesWithoutSteps) {
  const TransportSeaOf space{{{0, 1500}, {15, 1500}}, 15, 13'000, 6, "FineSand", 1.4};
  const AngleTransport sea = space.transport();
  const TransportEnd end(sea, 11);
  std::vector<DelayWindow> before;
  for (double range_m = 1000; range_m < 1005; range_m += 0.1) {
    const TurnedSound sound = turned_sound(sea, end, end, range_m);
    const std::vector<DelayWindow> windows = DelaySpectrum(sound, sound).windows();
    for (std::size_t i = 0; !before.empty() && i < windows.size(); ++i) {
      EXPECT_NEAR(windows[i].excess_s / before[i].excess_s, 1, 0.02) << range_m;
      EXPECT_NEAR(loss_db(windows[i].power), loss_db(before[i].power), 0.05) << range_m;
    }
    before = windows;
  }
}

// A part whose delay passes from bin to bin takes its angle along without steps.
TEST(DelaySpectrum, AnglesOfWindowsMoveWithoutSteps) {
  std::vector<DelayWindow> before;
  for (double excess_s = 1e-3; excess_s < 1.2e-3; excess_s *= 1.0002) {
    TurnedSound sound;
    sound.parts = {{.power = 1, .excess_s = 1.1e-3, .sine_squares = 0.01},
                   {.power = 1, .excess_s = excess_s, .sine_squares = 0.2}};
    const std::vector<DelayWindow> now = DelaySpectrum(sound, sound).windows();
    for (std::size_t i = 0; i < before.size(); ++i)
      EXPECT_NEAR(now[i].launch_sine, before[i].launch_sine, 0.02) << excess_s << " " << i;
    before = now;
  }
  EXPECT_EQ(before.size(), kMaxDelayWindows);
}

}  // namespace
}  // namespace halocline::acoustics
