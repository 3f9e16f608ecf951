// SPDX-License-Identifier: BSD-3-Clause
// Every row of every reference table through the calculator, text in and text out, as a person uses it.
#include <cmath>
#include <fstream>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>

#include "core/csv_table.h"
#include "halocline/calc/calc.h"
#include "halocline/calc/quantity.h"
#include "tests/support/tolerance.h"

namespace halocline::clients {
namespace {

using testing::relative_error;
using testing::tolerance;

struct Case {
  std::string file;
  CalcOptions options;
  double capacity_tolerance = 1e-9;  // of columns in bit/s; decibels 1e-10, everything else 1e-12
  double tolerance = 1e-12;
};
std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.file << " by " << c.options.quantity;
}

double allowed_error(const Case& c, const std::string& column) {
  const bool capacity = column.find("bit_per_s") != std::string::npos;
  return testing::tolerance(capacity ? c.capacity_tolerance : c.tolerance);
}

bool is_level(const std::string& column) {
  return column.find("dB") != std::string::npos && column.find("per_km") == std::string::npos;
}

CsvTable computed(const Case& c) {
  std::ifstream in(std::string(HALOCLINE_TEST_DATA) + "/acoustics/" + c.file);
  std::stringstream out, err;
  EXPECT_EQ(run_calc(c.options, in, out, err), kCalcDone) << err.str();
  std::vector<std::string> errors;
  return read_csv(out, errors);
}

class CalcReference : public ::testing::TestWithParam<Case> {};

// Compares each computed_<name> with <name>, and expects at least one such pair and no reference column left
// out that the quantity gives.
TEST_P(CalcReference, EveryRowMatches) {
  const Case& c = GetParam();
  const CsvTable table = computed(c);
  ASSERT_FALSE(table.rows.empty());
  int compared = 0;
  for (std::size_t i = 0; i < table.header.cells.size(); ++i) {
    const std::string& name = table.header.cells[i];
    if (!name.starts_with("computed_")) continue;
    const std::string reference = name.substr(std::string("computed_").size());
    const std::size_t r = table.column(reference).value();
    for (const CsvLine& row : table.rows) {
      const double ours = parse_number(row.cells[i]).value(), theirs = parse_number(row.cells[r]).value();
      const bool level_matches = is_level(name) && std::abs(ours - theirs) <= tolerance(1e-10);
      EXPECT_TRUE(level_matches || relative_error(ours, theirs) <= allowed_error(c, name))
          << c.file << " line " << row.number << ", " << reference << ": " << ours << " for " << theirs;
      ++compared;
    }
  }
  EXPECT_GE(compared, static_cast<int>(table.rows.size()));
}

INSTANTIATE_TEST_SUITE_P(
    AllTables, CalcReference,
    ::testing::Values(
        Case{"sound_speed_mackenzie1981.csv", {.quantity = "sound-speed"}},
        Case{"sound_speed_unesco_chenmillero.csv", {.quantity = "sound-speed", .model = "unesco"}},
        Case{"sound_speed_chenmillero_wongzhu1995.csv", {.quantity = "sound-speed", .model = "chen-millero"}},
        Case{"sound_speed_delgrosso_wongzhu1995.csv", {.quantity = "sound-speed", .model = "del-grosso"}},
        Case{"sound_speed_teos10_75term.csv", {.quantity = "sound-speed", .model = "teos10"}},
        Case{"absorption_fisher_simmons1977.csv", {.quantity = "absorption"}},
        Case{"absorption_francois_garrison1982.csv",
             {.quantity = "absorption", .model = "francois-garrison"}},
        Case{"absorption_ainslie_mccolm1998.csv", {.quantity = "absorption", .model = "ainslie-mccolm"}},
        Case{"absorption_thorp.csv", {.quantity = "absorption", .model = "thorp"}},
        Case{"noise_psd.csv", {.quantity = "noise"}},
        Case{"transmission_loss.csv", {.quantity = "transmission-loss"}},
        Case{"snr_eq7.csv", {.quantity = "snr"}}, Case{"capacity_eq8.csv", {.quantity = "capacity"}},
        Case{"pressure_from_depth_leroy_parthiot1998.csv", {.quantity = "pressure"}},
        Case{"depth_from_pressure_unesco.csv", {.quantity = "depth"}},
        Case{"munk_profile.csv", {.quantity = "munk"}},
        Case{"slant_delay_straight_woa98.csv", {.quantity = "delay"}},
        Case{"fig4_delay_vs_depth_1km.csv", {.quantity = "figure-4"}},
        Case{"fig6_fig7_100m_depth.csv", {.quantity = "link"}},
        // Ten printed digits; a minimum found by value is known to half as many digits as the value.
        Case{"stojanovic2006_k1p5_s0p5_w0_snr20.csv", {.quantity = "optimum-band"}, 1e-9, 1e-7},
        Case{"ber_per_uncoded.csv", {.quantity = "bit-error-rate"}},
        Case{"per_janus_like_conv_union_bound.csv", {.quantity = "coded-error-rate"}},
        Case{"conv_code_753_561_spectrum.csv", {.quantity = "code-spectrum"}},
        Case{"janus_frame_durations.csv", {.quantity = "packet-duration"}},
        Case{"bottom_reflection_rayleigh_apl9407.csv", {.quantity = "bottom-reflection"}},
        Case{"surface_loss.csv", {.quantity = "surface-loss"}},
        Case{"doppler_colinear.csv", {.quantity = "doppler"}}),
    [](const ::testing::TestParamInfo<Case>& test) {
      std::string name = test.param.file.substr(0, test.param.file.find('.'));
      return name;
    });

}  // namespace
}  // namespace halocline::clients
