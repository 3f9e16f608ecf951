// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/sound_speed.h"

#include "acoustics/sea/pressure.h"
#include "core/units.h"
#include "tests/acoustics/reference_rows.h"
#include "tests/support/csv.h"

namespace halocline::acoustics {
namespace {

using testing::CsvRow;
using testing::tolerance;

TEST(SoundSpeed, MackenzieMatchesEveryReferenceRow) {
  expect_column("sound_speed_mackenzie1981.csv", "c_m_per_s", [](const CsvRow& row) {
    return mackenzie_1981(row.number("T_degC"), row.number("S_ppt"), row.number("depth_m"));
  });
}

TEST(SoundSpeed, UnescoMatchesEveryReferenceRow) {
  expect_column("sound_speed_unesco_chenmillero.csv", "c_m_per_s", [](const CsvRow& row) {
    return unesco_chen_millero(row.number("T68_degC"), row.number("S_psu"), row.number("p_dbar"));
  });
}

TEST(SoundSpeed, WongAndZhusChenMilleroMatchesEveryReferenceRow) {
  expect_column("sound_speed_chenmillero_wongzhu1995.csv", "c_m_per_s", [](const CsvRow& row) {
    return chen_millero_wong_zhu_1995(row.number("T90_degC"), row.number("S_psu"), row.number("p_dbar"));
  });
}

TEST(SoundSpeed, DelGrossoMatchesEveryReferenceRow) {
  expect_column("sound_speed_delgrosso_wongzhu1995.csv", "c_m_per_s", [](const CsvRow& row) {
    return del_grosso_wong_zhu_1995(row.number("T90_degC"), row.number("S_psu"), row.number("P_kg_per_cm2"));
  });
}

TEST(SoundSpeed, Teos10MatchesEveryReferenceRow) {
  expect_column("sound_speed_teos10_75term.csv", "c_m_per_s", [](const CsvRow& row) {
    return teos10_75_term(row.number("SA_g_per_kg"), row.number("CT_degC"), row.number("p_dbar"));
  });
}

TEST(SoundSpeed, UnescoMatchesThePublishedTableToItsLastDigit) {
  for (const CsvRow& row :
       testing::read_reference_csv("acoustics/published_unesco44_sound_speed_table.csv")) {
    const double c = unesco_chen_millero(row.number("T68_degC"), row.number("S_psu"), row.number("p_dbar"));
    // Printed to 0.1 m/s.
    EXPECT_NEAR(c, row.number("c_published_m_per_s(0.1 resolution)"), tolerance(0.0501)) << row.line();
  }
}

TEST(SoundSpeed, PublishedCheckValuesHold) {
  EXPECT_NEAR(mackenzie_1981(25, 35, 1000), 1550.744, tolerance(5e-4));
  EXPECT_NEAR(mackenzie_1981(40, 40, 10'000), 1718.774, tolerance(5e-4));
  EXPECT_NEAR(mackenzie_1981(27, 35, 10), 1539.1, tolerance(0.05));
  EXPECT_NEAR(unesco_chen_millero(40, 40, 10'000), 1731.995, tolerance(5e-4));
}

TEST(SoundSpeed, MackenzieMatchesThePrintedRowAtTenMetres) {
  const double printed[] = {1442.42, 1483.78, 1515.95, 1540.36, 1558.44};
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(mackenzie_1981(10 * i, 30, 10), printed[i], tolerance(5.1e-3));
}

// TEOS-10's own check casts (six depths off the coast), as its handbook prints them.
TEST(SoundSpeed, Teos10MatchesItsHandbook) {
  const double sa[] = {34.7118, 34.8915, 35.0256, 34.8472, 34.7366, 34.7324};
  const double ct[] = {28.7856, 28.4329, 22.8103, 10.2600, 6.8863, 4.4036};
  const double p[] = {10, 50, 125, 250, 600, 1000};
  const double c[] = {1542.426412426373, 1542.558891663385, 1530.801535436184,
                      1494.551099295314, 1487.622786765276, 1484.271672296205};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(teos10_75_term(sa[i], ct[i], p[i]), c[i], tolerance(1e-9)) << i;
}

TEST(SoundSpeed, PressureInBarTakenForDecibarIsNotOurs) {
  // A public code fed bar where decibar belongs (or the reverse) and got -1551 m/s at depth. Ours takes
  // decibar: 1 dbar of pressure is worth 1.6 cm/s, so 10 000 dbar make about +165 m/s.
  const double growth = unesco_chen_millero(10, 35, 10'000) - unesco_chen_millero(10, 35, 0);
  EXPECT_GT(growth, 155);
  EXPECT_LT(growth, 175);
}

TEST(SoundSpeed, ThePapersMisprintIsNotOurs) {
  // Equation 1 of the 2010 paper fuses -5.304e-2 T^2 + 2.374e-4 T^3 into -5.304e-4 T^3.
  const auto misprint = [](double t) {
    return mackenzie_1981(t, 35, 0) + 5.304e-2 * t * t - (2.374e-4 + 5.304e-4) * t * t * t;
  };
  EXPECT_NEAR(misprint(30) - mackenzie_1981(30, 35, 0), 27, tolerance(0.2));
  EXPECT_NEAR(mackenzie_1981(30, 35, 0), unesco_chen_millero(30, 35, 0),
              tolerance(0.5));  // an independent fit
}

TEST(SoundSpeed, NoModelGivesTheSpeedInAir) {
  for (const SoundSpeedModel model : kSoundSpeedModels) {
    const double c = sound_speed_mps(model, 10, 35, 100, to_radians(45));
    EXPECT_NEAR(c, 1491.5, tolerance(1.5))
        << to_name(model);  // five independent fits within 1 m/s of each other
  }
}

TEST(SoundSpeed, WarmthSaltAndDepthEachRaiseItByTheirWorth) {
  for (const SoundSpeedModel model : kSoundSpeedModels) {
    const auto c = [model](double t, double s, double z) {
      return sound_speed_mps(model, t, s, z, to_radians(45));
    };
    // Textbook slopes at 10 degC: about 3.6 m/s a degree, 1.2 a psu, 1.65 per 100 m.
    EXPECT_NEAR(c(11, 35, 100) - c(10, 35, 100), 3.6, tolerance(0.2)) << to_name(model);
    EXPECT_NEAR(c(10, 36, 100) - c(10, 35, 100), 1.2, tolerance(0.1)) << to_name(model);
    EXPECT_NEAR(c(10, 35, 200) - c(10, 35, 100), 1.65, tolerance(0.05)) << to_name(model);
  }
}

TEST(SoundSpeed, ModelsAtDepthUseTheirOwnPressureAndScale) {
  const double latitude = to_radians(30), depth = 2000;
  const double dbar = standard_ocean_pressure_dbar(depth, latitude);
  const auto at = [&](SoundSpeedModel model) { return sound_speed_mps(model, 5, 35, depth, latitude); };
  EXPECT_DOUBLE_EQ(at(SoundSpeedModel::kMackenzie1981), mackenzie_1981(5, 35, depth));
  EXPECT_DOUBLE_EQ(at(SoundSpeedModel::kUnescoChenMillero), unesco_chen_millero(5 * 1.00024, 35, dbar));
  EXPECT_DOUBLE_EQ(at(SoundSpeedModel::kChenMilleroWongZhu1995), chen_millero_wong_zhu_1995(5, 35, dbar));
  EXPECT_DOUBLE_EQ(at(SoundSpeedModel::kDelGrossoWongZhu1995),
                   del_grosso_wong_zhu_1995(5, 35, dbar * 1e4 / 98'066.5));
  EXPECT_DOUBLE_EQ(at(SoundSpeedModel::kTeos10), teos10_75_term(35, 5, dbar));
  EXPECT_DOUBLE_EQ(at(SoundSpeedModel::kHarrisZorzi2007), harris_zorzi_2007(5, 35, depth));
}

TEST(SoundSpeed, NamesRoundTrip) {
  for (const SoundSpeedModel model : kSoundSpeedModels) {
    EXPECT_EQ(sound_speed_model_from_name(to_name(model)), model);
  }
  EXPECT_EQ(sound_speed_model_from_name("air"), std::nullopt);
}

}  // namespace
}  // namespace halocline::acoustics
