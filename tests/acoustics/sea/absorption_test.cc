// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/absorption.h"

#include <functional>
#include <string>

#include "core/units.h"
#include "tests/acoustics/reference_rows.h"
#include "tests/support/csv.h"

namespace halocline::acoustics {
namespace {

using testing::CsvRow;
using testing::tolerance;

double frequency(const CsvRow& row) { return khz_to_hz(row.number("f_kHz")); }

AbsorptionComponents fisher_simmons(const CsvRow& row) {
  const AbsorbingWater water{row.number("T_degC"), 35, 0, row.number("P_atm"), 8};
  return absorption_spectrum(AbsorptionModel::kFisherSimmons1977, water).components_at(frequency(row));
}

AbsorptionComponents by_depth(AbsorptionModel model, const CsvRow& row) {
  const AbsorbingWater water{row.number("T_degC"), row.number("S_ppt"), row.number("depth_m"), 1,
                             row.number("pH")};
  return absorption_spectrum(model, water).components_at(frequency(row));
}

using Components = std::function<AbsorptionComponents(const CsvRow&)>;

void expect_components(const std::string& file, const Components& at) {
  expect_column(file, "alpha_boric_dB_per_km", [&](const CsvRow& row) { return at(row).boric_db_per_km; });
  expect_column(file, "alpha_MgSO4_dB_per_km",
                [&](const CsvRow& row) { return at(row).magnesium_sulphate_db_per_km; });
  expect_column(file, "alpha_water_dB_per_km", [&](const CsvRow& row) { return at(row).water_db_per_km; });
  expect_column(file, "alpha_total_dB_per_km", [&](const CsvRow& row) { return at(row).total_db_per_km; });
}

TEST(Absorption, FisherSimmonsMatchesEveryReferenceRow) {
  const std::string file = "absorption_fisher_simmons1977.csv";
  expect_components(file, fisher_simmons);
  expect_column(file, "f1_boric_Hz",
                [](const CsvRow& row) { return fisher_simmons(row).boric_relaxation_hz; });
  expect_column(file, "f2_MgSO4_Hz",
                [](const CsvRow& row) { return fisher_simmons(row).magnesium_sulphate_relaxation_hz; });
}

void expect_model_by_depth(AbsorptionModel model, const std::string& file) {
  const Components at = [model](const CsvRow& row) { return by_depth(model, row); };
  expect_components(file, at);
  expect_column(file, "f1_boric_kHz",
                [&](const CsvRow& row) { return hz_to_khz(at(row).boric_relaxation_hz); });
  expect_column(file, "f2_MgSO4_kHz",
                [&](const CsvRow& row) { return hz_to_khz(at(row).magnesium_sulphate_relaxation_hz); });
}

TEST(Absorption, FrancoisGarrisonMatchesEveryReferenceRow) {
  expect_model_by_depth(AbsorptionModel::kFrancoisGarrison1982, "absorption_francois_garrison1982.csv");
}

TEST(Absorption, AinslieMcColmMatchesEveryReferenceRow) {
  expect_model_by_depth(AbsorptionModel::kAinslieMcColm1998, "absorption_ainslie_mccolm1998.csv");
}

TEST(Absorption, ThorpMatchesEveryReferenceRowInAllItsForms) {
  const auto column = [](const std::string& name, AbsorptionModel model) {
    expect_column("absorption_thorp.csv", name, [model](const CsvRow& row) {
      return absorption_db_per_km(model, AbsorbingWater{4, 35, 0, 1, 8}, frequency(row));
    });
  };
  column("thorp1967_dB_per_km(x1.0936)", AbsorptionModel::kThorp1967);
  column("thorp_extended_dB_per_km", AbsorptionModel::kThorpExtended);
  column("thorp_lowfreq_dB_per_km", AbsorptionModel::kThorpLowFrequency);
  column("thorp_piecewise_0.4kHz_dB_per_km", AbsorptionModel::kThorpPiecewise);
  column("thorp_JKPS_dB_per_km", AbsorptionModel::kThorpJensen);
  expect_column("absorption_thorp.csv", "thorp1967_dB_per_kyd",
                [](const CsvRow& row) { return thorp_1967_db_per_kiloyard(frequency(row)); });
}

double fisher_simmons_at(double frequency_khz, double temperature_degc, double pressure_atm) {
  return absorption_db_per_km(AbsorptionModel::kFisherSimmons1977, {temperature_degc, 35, 0, pressure_atm, 8},
                              khz_to_hz(frequency_khz));
}

TEST(Absorption, FisherSimmonsMatchesItsTableFour) {
  EXPECT_NEAR(fisher_simmons_at(10, 4, 1), 0.83, tolerance(5e-3));
  EXPECT_NEAR(fisher_simmons_at(10, 4, 500), 0.52, tolerance(5e-3));
  EXPECT_NEAR(fisher_simmons_at(100, 4, 500), 17.5, tolerance(0.05));
}

double francois_garrison_at(double frequency_khz, double t, double s, double depth_m, double ph) {
  return absorption_db_per_km(AbsorptionModel::kFrancoisGarrison1982, {t, s, depth_m, 1, ph},
                              khz_to_hz(frequency_khz));
}

TEST(Absorption, FrancoisGarrisonMatchesItsTableFour) {
  struct Printed {
    double t, s, f_khz, alpha;
  };
  for (const Printed& p :
       {Printed{0, 30, 1, 0.0610}, Printed{0, 35, 1, 0.0640}, Printed{10, 35, 1, 0.0600},
        Printed{0, 30, 10, 1.12}, Printed{0, 35, 10, 1.29}, Printed{10, 35, 10, 0.963},
        Printed{0, 30, 100, 21.0}, Printed{0, 35, 100, 23.4}, Printed{10, 35, 100, 33.6}}) {
    // Three printed digits.
    EXPECT_NEAR(francois_garrison_at(p.f_khz, p.t, p.s, 0, 8) / p.alpha, 1, tolerance(5e-3))
        << p.f_khz << " " << p.t;
  }
  EXPECT_NEAR(francois_garrison_at(50, 27, 35, 10, 8.1), 10.71, tolerance(5e-3));
  EXPECT_NEAR(francois_garrison_at(100, 27, 35, 10, 8.1), 35.611359656810865, tolerance(1e-10));
}

TEST(Absorption, ModelsStandWhereTheModelPagePutsThem) {
  const AbsorbingWater water{13.3, 35.03, 100, 10.9525, 8};  // 25 kHz, 13.3 degC, 100 m
  EXPECT_NEAR(absorption_db_per_km(AbsorptionModel::kFisherSimmons1977, water, 25e3), 3.50, tolerance(5e-3));
  EXPECT_NEAR(absorption_db_per_km(AbsorptionModel::kFrancoisGarrison1982, water, 25e3), 4.49,
              tolerance(5e-3));
  EXPECT_NEAR(absorption_db_per_km(AbsorptionModel::kAinslieMcColm1998, water, 25e3), 4.57, tolerance(5e-3));
  EXPECT_NEAR(absorption_db_per_km(AbsorptionModel::kThorpExtended, water, 25e3), 6.10, tolerance(6e-3));
}

TEST(Absorption, TheKiloyardFactorIsAppliedOnce) {
  const AbsorbingWater water{4, 35, 0, 1, 8};
  EXPECT_NEAR(
      absorption_db_per_km(AbsorptionModel::kThorp1967, water, 10e3) / thorp_1967_db_per_kiloyard(10e3),
      1.0936, tolerance(1e-14));
  EXPECT_NEAR(absorption_db_per_km(AbsorptionModel::kThorpExtended, water, 10e3), 1.187029938708157,
              tolerance(1e-13));
}

TEST(Absorption, PressureLowersIt) {
  double before = fisher_simmons_at(25, 10, 1);
  for (double atm = 50; atm <= 500; atm += 50) {
    EXPECT_LT(fisher_simmons_at(25, 10, atm), before) << atm;
    before = fisher_simmons_at(25, 10, atm);
  }
}

TEST(Absorption, AcidityMovesTheBoricTermOnly) {
  for (const AbsorptionModel model :
       {AbsorptionModel::kFrancoisGarrison1982, AbsorptionModel::kAinslieMcColm1998}) {
    const auto at = [model](double ph) {
      return absorption_spectrum(model, {10, 35, 0, 1, ph}).components_at(5e3);
    };
    EXPECT_GT(at(8.2).boric_db_per_km, 1.3 * at(8.0).boric_db_per_km);
    EXPECT_EQ(at(8.2).magnesium_sulphate_db_per_km, at(8.0).magnesium_sulphate_db_per_km);
    EXPECT_EQ(at(8.2).water_db_per_km, at(8.0).water_db_per_km);
  }
}

TEST(Absorption, EveryModelGrowsWithFrequency) {
  for (const AbsorptionModel model : kAbsorptionModels) {
    if (model == AbsorptionModel::kThorpPiecewise) continue;  // steps by 0.001 dB/km where its halves join
    double before = 0;
    for (double f = 100; f < 500e3; f *= 1.3) {
      const double alpha = absorption_db_per_km(model, {10, 35, 100, 11, 8}, f);
      EXPECT_GT(alpha, before) << to_name(model) << " at " << f;
      before = alpha;
    }
  }
}

TEST(Absorption, NamesRoundTrip) {
  for (const AbsorptionModel model : kAbsorptionModels) {
    EXPECT_EQ(absorption_model_from_name(to_name(model)), model);
  }
  EXPECT_EQ(absorption_model_from_name("none"), std::nullopt);
}

}  // namespace
}  // namespace halocline::acoustics
