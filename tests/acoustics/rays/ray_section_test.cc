// SPDX-License-Identifier: BSD-3-Clause
// Water that changes along the link: closed forms, the layered search, and rays integrated by Runge and
// Kutta.
#include "acoustics/sea/ray_section.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/ray_water.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/check.h"
#include "core/units.h"
#include "tests/acoustics/rays/runge_kutta_ray.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

const FluidBottom kSand = fluid_bottom(1.9, 1650, 0.8);

double sand_magnitude(double sine, double speed_mps) {
  return bottom_magnitude_at_sine(kSand, sine, speed_mps);
}

double little_absorption(double depth_m) { return 3 + depth_m / 100; }  // dB/km

// Nodes of a section, by which tests know it beside the section itself.
struct Nodes {
  std::vector<double> ranges, depths;
  std::vector<std::vector<double>> speeds;  // of each column
};

template <class Speed>
Nodes nodes_of(double range_m, int strips, const std::vector<double>& depths, const Speed& speed) {
  Nodes nodes{{}, depths, {}};
  for (int i = 0; i <= strips; ++i) {
    nodes.ranges.push_back(range_m * i / strips);
    nodes.speeds.emplace_back();
    for (const double depth : depths) nodes.speeds.back().push_back(speed(nodes.ranges.back(), depth));
  }
  return nodes;
}

std::shared_ptr<const RaySection> section_of(const Nodes& nodes) {
  std::vector<RayWater> columns;
  for (const std::vector<double>& column : nodes.speeds) {
    std::vector<SpeedRow> rows;
    for (std::size_t j = 0; j < nodes.depths.size(); ++j) rows.push_back({nodes.depths[j], column[j]});
    columns.emplace_back(rows, little_absorption);
  }
  return std::make_shared<const RaySection>(nodes.ranges, std::move(columns));
}

RaySea sea_of(std::shared_ptr<const RaySection> section, BottomProfile bottom) {
  RaySea sea{section->columns().front(), std::move(bottom), kSand, {}, {}};
  sea.options.max_bounces = 20;
  sea.section = std::move(section);
  return sea;
}

std::vector<double> even_depths(double step, double deepest) {
  std::vector<double> depths;
  for (double z = 0; z <= deepest; z += step) depths.push_back(z);
  return depths;
}

std::optional<Eigenray> direct_of(const Eigenrays& found) {
  for (const Eigenray& path : found.paths)
    if (path.surface_bounces + path.bottom_bounces == 0) return path;
  return std::nullopt;
}

// c = c0 + g . x everywhere: t = acosh(1 + g^2 d^2 / (2 c1 c2)) / g (Jensen and others 2011, section 3.3,
// turned by an angle).
TEST(RaySection, AGradientInAnyDirectionHasItsClosedForm) {
  std::mt19937 draw(7);
  std::uniform_real_distribution<double> share(0, 1);
  for (int k = 0; k < 60; ++k) {
    const double a = 0.01 * (2 * share(draw) - 1), b = 0.1 * (2 * share(draw) - 1),
                 range = 500 + 4000 * share(draw);
    const auto speed = [&](double r, double z) { return 1500 + a * (r - 2000) + b * (z - 500); };
    const auto section = section_of(nodes_of(range, 1 + k % 9, even_depths(40, 1200), speed));
    const RayLink link{300 + 400 * share(draw), 300 + 400 * share(draw), range};
    const auto direct = direct_of(eigenrays(sea_of(section, BottomProfile::flat(1000)), link));
    ASSERT_TRUE(direct);
    const double c1 = speed(0, link.source_depth_m), c2 = speed(range, link.receiver_depth_m),
                 g = std::hypot(a, b);
    const double d2 = range * range + std::pow(link.receiver_depth_m - link.source_depth_m, 2);
    const double x = g * std::sqrt(d2) / (2 * std::sqrt(c1 * c2));
    EXPECT_NEAR(direct->delay_s, 2 / g * std::asinh(x), tolerance(2e-9));
    // The length of the arc of the circle that both ends and the line c = 0 give.
    const double chord_angle = std::atan2(link.receiver_depth_m - link.source_depth_m, range);
    const double turned = direct->arrival_angle_rad - direct->launch_angle_rad;
    EXPECT_NEAR((direct->arrival_angle_rad + direct->launch_angle_rad) / 2, chord_angle, tolerance(1e-8));
    EXPECT_NEAR(direct->path_length_m, std::sqrt(d2) * turned / 2 / std::sin(turned / 2), tolerance(1e-5));
  }
}

void expect_same(const Eigenrays& found, const Eigenrays& expected, double delay_s, double decibels) {
  ASSERT_EQ(found.paths.size(), expected.paths.size());
  for (std::size_t i = 0; i < found.paths.size(); ++i) {
    const Eigenray &a = found.paths[i], &b = expected.paths[i];
    EXPECT_NEAR(a.delay_s, b.delay_s, delay_s);
    EXPECT_NEAR(20 * std::log10(a.amplitude / b.amplitude), 0, decibels);
    EXPECT_NEAR(a.absorption_db, b.absorption_db, 10 * decibels);  // the means of layers are to first order
    EXPECT_NEAR(std::remainder(a.phase_rad - b.phase_rad, 2 * std::numbers::pi), 0, 1e-4);
    EXPECT_NEAR(a.launch_angle_rad, b.launch_angle_rad, 1e-6);
    EXPECT_NEAR(a.arrival_angle_rad, b.arrival_angle_rad, 1e-6);
    EXPECT_EQ(a.identity, b.identity);
    EXPECT_EQ(a.caustics, b.caustics);
  }
}

// Over a bottom that changes, in water of one gradient: with columns alike, and with columns that differ by a
// nanometre a second.
TEST(RaySection, IsTheLayeredSearchWhereTheWaterIsTheSame) {
  std::mt19937 draw(3);
  std::uniform_real_distribution<double> share(0, 1);
  for (int k = 0; k < 24; ++k) {
    const double range = 400 + 4000 * share(draw), nearly = k % 2 == 0 ? 0 : 1e-9,
                 gradient = 0.2 * (2 * share(draw) - 1);
    const Nodes nodes =
        nodes_of(range, 1 + k % 5, {0, 15, 30, 45, 60, 90, 130, 200, 260},
                 [&](double r, double z) { return 1500 + gradient * z + nearly * std::sin(r + 7 * z); });
    const RayLink link{5 + 120 * share(draw), 5 + 120 * share(draw), range};
    const BottomProfile bottom = k % 3 == 0
                                     ? BottomProfile::flat(160)
                                     : BottomProfile({{-100, 150}, {range / 2, 160}, {range + 100, 140}});
    RaySea sea = sea_of(section_of(nodes), bottom);
    sea.options.diffuse_below_db = 0;
    const Eigenrays found = eigenrays(sea, link);
    EXPECT_EQ(found.solver, RaySolver::kArcs);
    sea.section = nullptr;
    expect_same(found, eigenrays(sea, link, RaySolver::kArcs), tolerance(1e-9), tolerance(1e-4));
  }
}

// A function between points of one axis, and its slope, by Hermite's cubics; `f` by the point's place.
struct Between {
  double value, slope;
};
template <class Value>
Between between(const std::vector<double>& axis, std::size_t i, double x, const Value& f) {
  const auto slope = [&](std::size_t k) {  // of the parabola through three points
    const std::size_t m = std::clamp<std::size_t>(k, 1, axis.size() - 2);
    const double a = axis[m - 1], b = axis[m], c = axis[m + 1], y = axis[k];
    return f(m - 1) * (2 * y - b - c) / ((a - b) * (a - c)) + f(m) * (2 * y - a - c) / ((b - a) * (b - c)) +
           f(m + 1) * (2 * y - a - b) / ((c - a) * (c - b));
  };
  const double h = axis[i + 1] - axis[i], t = (x - axis[i]) / h, f0 = f(i), f1 = f(i + 1), s0 = h * slope(i),
               s1 = h * slope(i + 1);
  return {f0 * (1 + 2 * t) * (1 - t) * (1 - t) + s0 * t * (1 - t) * (1 - t) + f1 * t * t * (3 - 2 * t) +
              s1 * t * t * (t - 1),
          (6 * t * (t - 1) * (f0 - f1) + s0 * (1 - t) * (1 - 3 * t) + s1 * t * (3 * t - 2)) / h};
}

// Down each column, then along the range, where no slope is limited.
PiecewiseWater pieces_of(const Nodes& nodes) {
  const std::size_t layers = nodes.depths.size() - 1;
  const auto place = [](const std::vector<double>& axis, double x) {
    return static_cast<std::size_t>(std::upper_bound(axis.begin() + 1, axis.end() - 1, x) - axis.begin()) - 1;
  };
  PiecewiseWater water;
  water.piece = [=](double r, double z) {
    return static_cast<int>(place(nodes.ranges, r) * layers + place(nodes.depths, z));
  };
  water.speed = [=](int piece, double r, double z) -> SpeedThere {
    const std::size_t i = static_cast<std::size_t>(piece) / layers,
                      j = static_cast<std::size_t>(piece) % layers;
    const std::size_t first = i > 0 ? i - 1 : 0, last = std::min(i + 2, nodes.ranges.size() - 1);
    std::vector<Between> columns;
    // At the ends of the section slopes ask for a third column.
    const std::size_t from = std::min(first, last - std::min<std::size_t>(last, 3));
    for (std::size_t k = from; k <= std::max<std::size_t>(last, 2); ++k)
      columns.push_back(between(nodes.depths, j, z, [&](std::size_t knot) { return nodes.speeds[k][knot]; }));
    const Between c = between(nodes.ranges, i, r, [&](std::size_t k) { return columns[k - from].value; });
    return {c.value, c.slope,
            between(nodes.ranges, i, r, [&](std::size_t k) { return columns[k - from].slope; }).value};
  };
  return water;
}

// Through a front, over a bottom that slopes: all paths within 30 dB of the strongest. Of rays that all but
// graze a boundary some do not come to the receiver when they are launched a nanoradian off; they are not
// compared. Where slopes are limited, which the pieces leave out, rays differ by some 1e-7 s.
TEST(RaySection, RandomLinksThroughAFrontAgreeWithRungeKutta) {
  std::mt19937 draw(11);
  std::uniform_real_distribution<double> share(0, 1);
  std::size_t compared = 0, not_compared = 0, within = 0;
  for (int k = 0; k < 100; ++k) {
    const double range = 1000 + 5000 * share(draw), front = range * share(draw),
                 width = 300 + 700 * share(draw);
    const Nodes nodes = nodes_of(range, static_cast<int>(std::ceil(range / 200)), even_depths(20, 300),
                                 [&](double r, double z) { return front_speed(front, width, r, z).c; });
    const StraightBottom bottom{140 + 80 * share(draw), 0.02 * (share(draw) - 0.5)};
    RaySea sea = sea_of(section_of(nodes),
                        BottomProfile({{-1000, bottom.at(-1000)}, {range + 1000, bottom.at(range + 1000)}}));
    sea.options.airy_folds = false;  // rays as they are
    sea.options.diffuse_below_db = 0;
    const RayLink link{5 + 90 * share(draw), 5 + 90 * share(draw), range};
    const RungeKuttaTracer tracer(pieces_of(nodes), bottom, sand_magnitude, 10);
    const Eigenrays found = eigenrays(sea, link);
    double strongest = 0;
    for (const Eigenray& path : found.paths) strongest = std::max(strongest, path.amplitude);
    for (const Eigenray& path : found.paths) {
      if (path.amplitude < 0.03 * strongest) continue;
      const auto one = compare(tracer, link, path);
      if (!one) {
        ++not_compared;
        continue;
      }
      ++compared;
      within += one->delay_s < tolerance(1e-8) ? 1 : 0;
      EXPECT_LT(one->delay_s, tolerance(3e-7));
      EXPECT_LT(one->decibels, tolerance(0.01));
      EXPECT_TRUE(one->caustics_alike);
    }
  }
  EXPECT_GT(compared, 1000U);
  EXPECT_GT(static_cast<double>(within), 0.97 * static_cast<double>(compared));
  EXPECT_LT(not_compared, compared / 200);
}

// Samples of a smooth front: delays and levels of all paths against those in the front itself. Half the
// spacing leaves an eighth of the delay's error and a quarter of the level's.
TEST(RaySection, ConvergesToTheFrontItSamples) {
  constexpr double kRange = 3000, kFront = 1500, kWidth = 600;
  const PiecewiseWater smooth{[](double, double) { return 0; },
                              [](int, double r, double z) { return front_speed(kFront, kWidth, r, z); }};
  const RungeKuttaTracer tracer(smooth, {400, 0}, sand_magnitude, 5);
  std::vector<double> delays_s, decibels;
  for (const int finer : {1, 2, 4}) {
    const auto section =
        section_of(nodes_of(kRange, 15 * finer, even_depths(20.0 / finer, 500),
                            [](double r, double z) { return front_speed(kFront, kWidth, r, z).c; }));
    RaySea sea = sea_of(section, BottomProfile::flat(400));
    sea.options.airy_folds = false;
    sea.options.diffuse_below_db = 0;
    double delay_squares = 0, level_squares = 0;
    for (int k = 0; k < 9; ++k) {
      const RayLink link{150.0 + 10 * k, 230.0 - 5 * k, kRange};
      for (const Eigenray& path : eigenrays(sea, link).paths) {
        if (path.surface_bounces + path.bottom_bounces > 2) continue;
        const auto one = compare(tracer, link, path);
        ASSERT_TRUE(one);
        delay_squares += one->delay_s * one->delay_s;
        level_squares += one->decibels * one->decibels;
      }
    }
    delays_s.push_back(std::sqrt(delay_squares));
    decibels.push_back(std::sqrt(level_squares));
  }
  EXPECT_LT(delays_s[2], tolerance(1e-6));
  EXPECT_GT(delays_s[0] / delays_s[1], 6);
  EXPECT_GT(delays_s[1] / delays_s[2], 6);
  EXPECT_GT(decibels[0] / decibels[1], 3);
  EXPECT_GT(decibels[1] / decibels[2], 3);
}

// The other way round the paths are the same backwards.
TEST(RaySection, PathsAreReciprocal) {
  constexpr double kRange = 4000;
  Nodes nodes = nodes_of(kRange, 20, even_depths(20, 300),
                         [](double r, double z) { return front_speed(1800, 500, r, z).c; });
  const BottomProfile bottom({{0, 180}, {kRange, 220}});
  RaySea sea = sea_of(section_of(nodes), bottom);
  sea.options.airy_folds = false;
  const Eigenrays there = eigenrays(sea, {40, 70, kRange});
  std::reverse(nodes.speeds.begin(), nodes.speeds.end());
  sea = sea_of(section_of(nodes), bottom.reversed(kRange));
  sea.options.airy_folds = false;
  const Eigenrays back = eigenrays(sea, {70, 40, kRange});
  ASSERT_GT(there.paths.size(), 4U);
  ASSERT_EQ(there.paths.size(), back.paths.size());
  for (std::size_t i = 0; i < there.paths.size(); ++i) {
    EXPECT_NEAR(there.paths[i].delay_s, back.paths[i].delay_s, tolerance(1e-9));
    EXPECT_NEAR(there.paths[i].launch_angle_rad, -back.paths[i].arrival_angle_rad, tolerance(1e-7));
  }
}

TEST(RaySection, RefusesWhatItCannotBe) {
  const RayWater one({{0, 1500}, {100, 1490}}, little_absorption),
      other({{0, 1500}, {90, 1490}}, little_absorption);
  EXPECT_THROW(RaySection({0, 100}, {one, other}), InvalidArgument);
  EXPECT_THROW(RaySection({0, 0}, {one, one}), InvalidArgument);
  EXPECT_THROW(RaySection({10}, {one}), InvalidArgument);
  const RaySea sea = sea_of(std::make_shared<const RaySection>(std::vector<double>{0}, std::vector{one}),
                            BottomProfile::flat(90));
  EXPECT_THROW(eigenrays(sea, {10, 20, 500}, RaySolver::kSnell), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
