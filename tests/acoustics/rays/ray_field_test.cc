// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/link/ray_doppler.h"
#include "acoustics/link/received_field.h"
#include "acoustics/modem/beam_pattern.h"
#include "acoustics/rays/eigenray.h"
#include "core/check.h"
#include "core/units.h"
#include "tests/acoustics/reference_rows.h"
#include "tests/support/csv.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;
using testing::tolerance;

Eigenray path_of(double delay_s, double amplitude, double phase_rad = 0) {
  Eigenray path;
  path.delay_s = delay_s;
  path.amplitude = amplitude;
  path.phase_rad = phase_rad;
  return path;
}

Eigenrays of(std::vector<Eigenray> paths) { return {RaySolver::kImages, std::move(paths)}; }

TEST(ReceivedField, PowersOfPathsAdd) {
  const ReceivedField field = received_field(of({path_of(1, 0.003), path_of(1.1, 0.004)}));
  EXPECT_NEAR(field.level.value, 20 * std::log10(0.005), tolerance(1e-12));
  EXPECT_FALSE(field.silent);
}

TEST(ReceivedField, SpreadOfTwoEqualPathsIsHalfTheirDistance) {
  const ReceivedField field = received_field(of({path_of(1, 0.01), path_of(1.2, 0.01)}));
  EXPECT_NEAR(field.mean_delay_s, 1.1, tolerance(1e-15));
  EXPECT_NEAR(field.delay_spread_s, 0.1, tolerance(1e-15));
  EXPECT_NEAR(field.longest_echo_s, 0.2, tolerance(1e-15));
  EXPECT_EQ(field.first_delay_s, 1);
}

TEST(ReceivedField, EchoesThirtyDecibelsDownDoNotLengthenIt) {
  const ReceivedField field = received_field(of({path_of(1, 1e-2), path_of(1.1, 1e-3), path_of(2, 1e-4)}));
  EXPECT_NEAR(field.longest_echo_s, 0.1, tolerance(1e-15));
}

TEST(ReceivedField, AbsorptionCounts) {
  Eigenray path = path_of(1, 0.01);
  path.absorption_db = 6;
  EXPECT_NEAR(received_field(of({path})).level.value, -46, tolerance(1e-12));
}

TEST(ReceivedField, AShadowIsMarkedAndHasNoFloorUnlessOneIsStated) {
  EXPECT_TRUE(received_field(of({})).silent);
  EXPECT_TRUE(std::isinf(received_field(of({})).level.value));
  FieldOptions options;
  options.floor = Decibels{-120};
  EXPECT_EQ(received_field(of({}), options).level.value, -120);
  EXPECT_TRUE(received_field(of({}), options).silent);
  EXPECT_EQ(received_field(of({path_of(1, 1e-9)}), options).level.value, -120);
}

TEST(CoherentLevel, OppositePhasesCancelAndEqualOnesAddByPressure) {
  EXPECT_NEAR(coherent_level(of({path_of(1, 0.01), path_of(1, 0.01)}), 25e3).value, 20 * std::log10(0.02),
              tolerance(1e-12));
  EXPECT_LT(coherent_level(of({path_of(1, 0.01), path_of(1, 0.01, pi)}), 25e3).value, -300);
}

TEST(CoherentLevel, HalfAPeriodOfDelayTurnsThePhaseByPi) {
  EXPECT_LT(coherent_level(of({path_of(0, 0.01), path_of(0.5 / 1000, 0.01)}), 1000).value, -300);
}

TEST(ImpulseResponse, PutsEachPathOnItsSampleWithItsPhase) {
  const auto taps = impulse_response(of({path_of(1, 0.01), path_of(1.01, 0.02, pi / 2)}), 0, 1000, 1, 20);
  ASSERT_EQ(taps.size(), 20U);
  EXPECT_NEAR(std::abs(taps[0] - std::complex<double>(0.01, 0)), 0, tolerance(1e-15));
  EXPECT_NEAR(std::abs(taps[10] - std::complex<double>(0, 0.02)), 0, tolerance(1e-15));
  for (std::size_t i = 0; i < taps.size(); ++i) {
    EXPECT_EQ(std::abs(taps[i]) > 0, i == 0 || i == 10) << i;
  }
}

TEST(ImpulseResponse, KeepsTheEnergyOfPathsThatDoNotShareASample) {
  const Eigenrays paths = of({path_of(1, 0.01), path_of(1.01, 0.02), path_of(1.5, 0.005)});
  double energy = 0;
  for (const auto& tap : impulse_response(paths, 25e3, 8000, 0.9, 8000)) energy += std::norm(tap);
  EXPECT_NEAR(to_decibels({energy}).value, received_field(paths).level.value, tolerance(1e-12));
}

TEST(ImpulseResponse, LeavesOutWhatFallsOutside) {
  for (const auto& tap : impulse_response(of({path_of(1, 0.01)}), 25e3, 1000, 1.5, 10))
    EXPECT_EQ(std::abs(tap), 0);
  EXPECT_THROW(impulse_response(of({}), 25e3, 0, 0, 10), InvalidArgument);
}

TEST(BeamPattern, IsOmnidirectionalWithoutATable) {
  EXPECT_EQ(BeamPattern{}.factor(1.0), 1);
  EXPECT_EQ(BeamPattern{}.loss(-1.0).value, 0);
}

TEST(BeamPattern, IsLinearInDecibelsBetweenRowsAndConstantBeyond) {
  const BeamPattern beam({{-0.5, 20}, {0, 0}, {0.5, 10}});
  EXPECT_NEAR(beam.loss(-0.25).value, 10, tolerance(1e-12));
  EXPECT_NEAR(beam.loss(0.1).value, 2, tolerance(1e-12));
  EXPECT_EQ(beam.loss(-1.5).value, 20);
  EXPECT_EQ(beam.loss(1.5).value, 10);
  EXPECT_NEAR(beam.factor(-0.5), 0.1, tolerance(1e-15));
}

TEST(BeamPattern, RefusesRowsThatDoNotRise) {
  EXPECT_THROW(BeamPattern({{0, 0}, {0, 1}}), InvalidArgument);
  EXPECT_THROW(BeamPattern(std::vector<BeamRow>{}), InvalidArgument);
}

TEST(BeamPattern, WeighsThePathByTheAngleItLeavesInAndTheOneItComesFrom) {
  Eigenray path = path_of(1, 0.01);
  path.launch_angle_rad = 0.5;   // leaves downward
  path.arrival_angle_rad = 0.5;  // travels downward at the receiver: comes from above
  FieldOptions down;
  down.transducers.source = BeamPattern({{-0.5, 40}, {0.5, 0}});
  EXPECT_NEAR(received_field(of({path}), down).level.value, -40, tolerance(1e-12));
  FieldOptions listens;
  listens.transducers.receiver = BeamPattern({{-0.5, 0}, {0.5, 40}});
  EXPECT_NEAR(received_field(of({path}), listens).level.value, -40, tolerance(1e-12));
}

TEST(RayDoppler, MatchesTheClosedFormForColinearMotion) {
  expect_column("doppler_colinear.csv", "f_rx_exact_Hz", [](const testing::CsvRow& row) {
    const double c = row.number("c_m_per_s");
    return row.number("f_Hz") * doppler_factor(row.number("v_tx_toward_rx_m_per_s"), c,
                                               row.number("v_rx_away_from_tx_m_per_s"), c);
  });
}

const MovingEnds kMoving{{0, 0, 30}, {2, 0, 0.5}, {300, 400, 60}, {0, -1, 0}, 1500, 1490};

TEST(RayDoppler, OfEachPathComesFromItsAngles) {
  Eigenray path;
  path.launch_angle_rad = 0.3;
  path.arrival_angle_rad = -0.2;
  // North 0.6, east 0.8 towards the receiver.
  const double source = 2 * 0.6 * std::cos(0.3) + 0.5 * std::sin(0.3), receiver = -0.8 * std::cos(0.2);
  EXPECT_NEAR(doppler_factor(path, kMoving), (1 - receiver / 1490) / (1 - source / 1500), tolerance(1e-15));
}

TEST(RayDoppler, IsOneAtRestAndAboveOneWhenClosing) {
  MovingEnds ends = kMoving;
  ends.source_velocity_mps = ends.receiver_velocity_mps = Vec3::Zero();
  EXPECT_EQ(doppler_factor(Eigenray{}, ends), 1);
  EXPECT_GT(doppler_factor(Eigenray{}, kMoving), 1);
}

TEST(RayDoppler, RefusesSupersonicEnds) {
  EXPECT_THROW(doppler_factor(1500, 1500, 0, 1500), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
