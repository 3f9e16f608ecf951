// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/link_budget.h"

#include <cmath>
#include <string>

#include "acoustics/link/capacity.h"
#include "acoustics/link/link_kernel.h"
#include "acoustics/link/transmission_loss.h"
#include "acoustics/math/frequency_band.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/pressure.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/check.h"
#include "tests/acoustics/reference_rows.h"
#include "tests/support/csv.h"

namespace halocline::acoustics {
namespace {

using testing::CsvRow;
using testing::tolerance;

Modem modem_of(double source_level_db, double low_khz, double high_khz) {
  return generic_modem({source_level_db}, {0}, khz_to_hz((low_khz + high_khz) / 2),
                       khz_to_hz(high_khz - low_khz));
}

// Two nodes at 100 m depth in the water of the reference figures.
LinkBudget figure_link(const CsvRow& row) {
  Environment sea;
  sea.noise = {row.number("shipping"), row.number("wind_m_per_s")};
  const Modem modem =
      modem_of(row.number("Ptx_dB_re_1uPa_at_1m"), row.number("f_lo_kHz"), row.number("f_hi_kHz"));
  return link_budget(sea, modem, modem, {0, 0, 100}, {row.number("range_m"), 0, 100});
}

TEST(LinkBudget, FiguresSixAndSevenMatchEveryReferenceRow) {
  const std::string file = "fig6_fig7_100m_depth.csv";
  expect_column(file, "alpha_fc_dB_per_km",
                [](const CsvRow& row) { return figure_link(row).absorption_db_per_km; });
  expect_decibels(file, "TL_fc_dB",
                  [](const CsvRow& row) { return figure_link(row).transmission_loss.value; });
  expect_decibels(file, "Prx_fc_dB_re_1uPa",
                  [](const CsvRow& row) { return figure_link(row).received_level.value; });
  expect_decibels(file, "SNR_eq7_dB",
                  [](const CsvRow& row) { return figure_link(row).snr_narrowband.value; });
  expect_column(
      file, "C_eq8_bit_per_s", [](const CsvRow& row) { return figure_link(row).capacity_bps; }, 1e-9);
}

TEST(LinkBudget, FiguresSixAndSevensLandmarksHold) {
  const Environment sea;
  const auto link = [&](double source_level_db, double range_m) {
    const Modem modem = modem_of(source_level_db, 22.5, 27.5);
    return link_budget(sea, modem, modem, {0, 0, 100}, {0, range_m, 100});
  };
  // As the model page prints them.
  EXPECT_NEAR(link(120, 4).transmission_loss.value, 9.045, tolerance(5e-4));
  EXPECT_NEAR(link(120, 180).transmission_loss.value, 34.459, tolerance(5e-4));
  EXPECT_NEAR(link(120, 4).received_level.value, 110.955, tolerance(5e-4));
  EXPECT_NEAR(link(60, 180).received_level.value, 25.541, tolerance(5.1e-4));
  EXPECT_NEAR(link(120, 4).capacity_bps, 85'770, tolerance(5));
  EXPECT_NEAR(link(60, 180).capacity_bps, 3.0, tolerance(0.05));
}

TEST(LinkBudget, EquationSevenMatchesEveryReferenceRow) {
  expect_decibels("snr_eq7.csv", "SNR_dB", [](const CsvRow& row) {
    const double f = khz_to_hz(row.number("f_kHz"));
    const AbsorbingWater water{row.number("T_degC"), 35, 0, row.number("P_atm"), 8};
    const double alpha = absorption_db_per_km(AbsorptionModel::kFisherSimmons1977, water, f);
    const double loss =
        transmission_loss(row.number("range_m"), row.number("k_spreading"), alpha).total.value;
    const double noise =
        noise_components(f, {row.number("shipping"), row.number("wind_m_per_s")}).total.value;
    return row.number("Ptx_dB_re_1uPa_at_1m") - loss - noise - 10 * std::log10(row.number("B_Hz"));
  });
}

struct Case {
  Environment sea;
  Modem tx{}, rx{};
  Vec3 from{0, 0, 30}, to{800, 600, 430};
  LinkBudget budget() const { return link_budget(sea, tx, rx, from, to); }
};

TEST(LinkBudget, PartsAddUp) {
  Case c;
  c.rx.directivity_index = {3};
  const LinkBudget link = c.budget();
  EXPECT_NEAR(link.range_m, std::sqrt(800 * 800 + 600 * 600 + 400 * 400), tolerance(1e-12));
  EXPECT_DOUBLE_EQ(link.received_level.value, c.tx.source_level.value - link.transmission_loss.value);
  EXPECT_NEAR(link.snr.value, link.received_level.value - link.noise_level.value + 3, tolerance(1e-12));
  EXPECT_NEAR(link.mean_sound_speed_mps, link.range_m / link.delay_s, tolerance(1e-9));
  EXPECT_TRUE(link.receivable);
}

// alpha(z) averaged over the depths of a path by brute force.
double mean_alpha(const Environment& sea, double z1, double z2, double frequency_hz) {
  constexpr int kSteps = 20'000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double z = z1 + (z2 - z1) * (i + 0.5) / kSteps;
    sum += absorption_spectrum_at(sea, z).components_at(frequency_hz).total_db_per_km;
  }
  return sum / kSteps;
}

TEST(LinkBudget, AbsorptionIsIntegratedAlongTheSlantPath) {
  for (const AbsorptionModel model : kAbsorptionModels) {
    for (const double bottom : {30.001, 49.0, 430.0, 6000.0}) {
      Case c;
      c.sea.absorption_model = model;
      c.to.z() = bottom;
      // The midpoint rule with 20 000 steps errs by about 1e-8.
      EXPECT_NEAR(c.budget().absorption_db_per_km / mean_alpha(c.sea, 30, bottom, c.tx.centre_frequency_hz),
                  1, tolerance(1e-7))
          << to_name(model) << " to " << bottom;
    }
  }
}

TEST(LinkBudget, CapacityUsesTheSlantAbsorptionAtEveryFrequency) {
  Case c;
  c.tx = c.rx = generic_modem({150}, {0}, 50e3, 40e3);
  c.to = {800, 600, 1930};
  const double range = (c.to - c.from).norm();
  double bits = 0;
  for (const FrequencyNode& node : frequency_nodes(30e3, 70e3)) {
    const double loss =
        transmission_loss(range, 1.5, mean_alpha(c.sea, 30, 1930, node.frequency_hz)).total.value;
    const double density = std::pow(10, (150 - loss) / 10) / 40e3;
    bits +=
        node.weight_hz * log2_of_1_plus(density / noise_power_density(node.frequency_hz, c.sea.noise).value);
  }
  EXPECT_NEAR(c.budget().capacity_bps / bits, 1, tolerance(1e-7));  // the midpoint rule's error again
}

TEST(LinkBudget, IsTheSameBothWays) {
  Case there, back;
  std::swap(back.from, back.to);
  EXPECT_DOUBLE_EQ(there.budget().delay_s, back.budget().delay_s);
  EXPECT_DOUBLE_EQ(there.budget().transmission_loss.value, back.budget().transmission_loss.value);
  EXPECT_DOUBLE_EQ(there.budget().capacity_bps, back.budget().capacity_bps);
}

TEST(LinkBudget, ZeroRangeTakesNoTimeAndLosesNothing) {
  Case c;
  c.to = c.from;
  const LinkBudget link = c.budget();
  EXPECT_EQ(link.range_m, 0);
  EXPECT_EQ(link.delay_s, 0);
  EXPECT_EQ(link.transmission_loss.value, 0);
  EXPECT_NEAR(link.mean_sound_speed_mps, c.sea.profile.sound_speed_mps(30), tolerance(1e-9));
  EXPECT_TRUE(std::isfinite(link.capacity_bps));
}

TEST(LinkBudget, WithinOneMetreSoundTakesItsTimeAndLosesNothing) {
  Case c;
  c.to = c.from + Vec3(0.18, 0.24, 0);
  const LinkBudget link = c.budget();
  EXPECT_NEAR(link.delay_s, 0.3 / c.sea.profile.sound_speed_mps(c.from.z()), tolerance(1e-12));
  EXPECT_EQ(link.transmission_loss.value, 0);
}

TEST(LinkBudget, EveryInputMovesWhatItShould) {
  const LinkBudget before = Case{}.budget();
  const auto changed = [](auto change) {
    Case c;
    change(c);
    return c.budget();
  };
  const LinkBudget windy = changed([](Case& c) { c.sea.noise.wind_mps = 9; });
  EXPECT_GT(windy.noise_level, before.noise_level);
  EXPECT_LT(windy.snr, before.snr);
  EXPECT_LT(windy.capacity_bps, before.capacity_bps);
  EXPECT_EQ(windy.received_level, before.received_level);
  EXPECT_GT(changed([](Case& c) { c.sea.noise.shipping = 1; }).noise_level, before.noise_level);
  EXPECT_GT(changed([](Case& c) { c.sea.spreading_exponent = 2; }).transmission_loss,
            before.transmission_loss);
  EXPECT_NE(changed([](Case& c) { c.sea.latitude_rad = 0; }).absorption_db_per_km,
            before.absorption_db_per_km);
  const LinkBudget louder = changed([](Case& c) { c.tx.source_level.value += 10; });
  EXPECT_NEAR(louder.snr.value - before.snr.value, 10, tolerance(1e-12));
  const LinkBudget directed = changed([](Case& c) { c.rx.directivity_index = {6}; });
  EXPECT_NEAR(directed.snr.value - before.snr.value, 6, tolerance(1e-12));
  EXPECT_GT(directed.capacity_bps, before.capacity_bps);
  EXPECT_EQ(directed.received_level, before.received_level);
  const LinkBudget slow = changed([](Case& c) {
    c.sea.profile = SoundSpeedProfile::isovelocity(1400, {10, 35});
  });
  EXPECT_GT(slow.delay_s, before.delay_s);
}

TEST(LinkBudget, AcidityMovesFrancoisGarrisonsAbsorption) {
  Case c;
  c.tx = c.rx = generic_modem({185}, {70}, 3e3, 1e3);
  c.sea.absorption_model = AbsorptionModel::kFrancoisGarrison1982;
  const double basic = c.budget().absorption_db_per_km;
  c.sea.ph = 7.7;
  EXPECT_LT(c.budget().absorption_db_per_km, basic);
}

TEST(LinkBudget, ATideMovesDepthsNotVehicles) {
  Case c, shifted;
  shifted.sea.sea_surface_z_m = -2;
  shifted.from.z() -= 2;
  shifted.to.z() -= 2;
  EXPECT_NEAR(shifted.budget().delay_s / c.budget().delay_s, 1, tolerance(1e-14));
  shifted.from.z() += 2;
  shifted.to.z() += 2;
  EXPECT_NE(shifted.budget().delay_s, c.budget().delay_s);
  EXPECT_EQ(shifted.budget().range_m, c.budget().range_m);
}

TEST(LinkBudget, APartOfTheBandCostsItsShareOfTheRatioAndOfTheCapacity) {
  const Modem sender = modem_of(160, 22.5, 27.5), upper = modem_of(160, 25, 30);
  const auto from_sender = [&](const Modem& receiver) {
    return link_budget(Environment(), sender, receiver, {0, 0, 100}, {0, 1000, 100});
  };
  const LinkBudget whole = from_sender(sender), half = from_sender(upper);
  EXPECT_NEAR(half.snr.value, whole.snr.value - 10 * std::log10(2), tolerance(1e-9));
  EXPECT_NEAR(half.snr_narrowband.value, whole.snr_narrowband.value - 10 * std::log10(2), tolerance(1e-9));
  const LinkBudget lower = from_sender(modem_of(160, 20, 25));
  EXPECT_NEAR(half.capacity_bps + lower.capacity_bps, whole.capacity_bps, tolerance(1e-6));
  EXPECT_TRUE(half.receivable);
  EXPECT_EQ(from_sender(modem_of(160, 27.5, 32.5)).capacity_bps, 0);
}

TEST(LinkBudget, OnlyAModemOfTheFamilyReceives) {
  Modem sender = modem_of(160, 22.5, 27.5);
  const Modem receiver = sender;
  sender.family = "whistle";
  EXPECT_FALSE(link_budget(Environment(), sender, receiver, {0, 0, 100}, {0, 100, 100}).receivable);
  EXPECT_TRUE(link_budget(Environment(), sender, sender, {0, 0, 100}, {0, 100, 100}).receivable);
}

TEST(LinkBudget, CutOffDecidesWhatIsReceivable) {
  Case c;
  const double level = c.budget().received_level.value;
  c.rx.min_receivable_level = {level};
  EXPECT_TRUE(c.budget().receivable);
  c.rx.min_receivable_level = {std::nextafter(level, 1e9)};
  EXPECT_FALSE(c.budget().receivable);
  c.rx.min_receivable_level = {0};
  c.rx.centre_frequency_hz = 100e3;  // listens elsewhere
  EXPECT_FALSE(c.budget().receivable);
}

TEST(LinkBudget, AbsorptionBetweenTwoDepthsIsTheLinks) {
  const Case c;
  const LinkKernel model(c.sea, c.tx, c.rx);
  const LinkBudget link = model.budget(c.from, c.to, Capacity::kLeftOut);
  EXPECT_EQ(model.absorption_db_per_km(30, 430), link.absorption_db_per_km);
}

TEST(LinkBudget, RefusesImpossibleSeas) {
  Environment sea;
  sea.spreading_exponent = 3;
  EXPECT_THROW(LinkKernel(sea, Modem{}, Modem{}), InvalidArgument);
  sea.spreading_exponent = 1.5;
  sea.noise.shipping = 1.5;
  EXPECT_THROW(LinkKernel(sea, Modem{}, Modem{}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
