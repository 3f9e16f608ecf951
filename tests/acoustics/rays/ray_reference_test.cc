// SPDX-License-Identifier: BSD-3-Clause
// Every row of the reference eigenrays, by every solver that can do its water.
#include "tests/acoustics/rays/ray_reference.h"

#include <cmath>
#include <string>
#include <vector>

#include "acoustics/link/received_field.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "tests/support/csv.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

struct Case {
  const char* name;
  RaySolver solver;
};

std::string case_name(const ::testing::TestParamInfo<Case>& info) {
  return std::string(info.param.name) + "_" + std::string(to_name(info.param.solver));
}

// The references carry 12 digits of delay, 8 of amplitude and 5 to 7 decimals of angles: the tolerances below
// are those of the last digits, a thousand times tighter than what is required (1e-6 s, 0.05 dB, 1 degree,
// 0.01 degree).
void expect_row(const testing::CsvRow& row, const Eigenray& path) {
  const std::string where = "line " + std::to_string(row.line()) + ": " + describe(path);
  EXPECT_NEAR(path.delay_s, row.number("delay_s"), tolerance(1e-9)) << where;
  EXPECT_NEAR(20 * std::log10(path.amplitude / row.number("amplitude")), 0, tolerance(1e-5)) << where;
  EXPECT_LE(degrees_between(to_degrees(path.phase_rad), row.number("phase_deg")), tolerance(1e-3)) << where;
  EXPECT_NEAR(to_degrees(path.launch_angle_rad), row.number("launch_angle_deg"), tolerance(1e-5)) << where;
  EXPECT_NEAR(to_degrees(path.arrival_angle_rad), row.number("arrival_angle_deg"), tolerance(1e-5)) << where;
  EXPECT_EQ(path.caustics, static_cast<int>(row.number("n_caustic"))) << where;
  // Lengths in the reference come in single precision.
  EXPECT_NEAR(path.path_length_m, row.number("path_length_m"), tolerance(1e-3)) << where;
  EXPECT_NEAR(path.absorption_db, row.number("absorption_db"), tolerance(1e-5)) << where;
}

class RayReference : public ::testing::TestWithParam<Case> {};

TEST_P(RayReference, EveryRowIsFoundAndNothingElse) {
  const RaySea sea = reference_sea(GetParam().name);
  for (const auto& [link, rows] : reference_links(GetParam().name)) {
    const auto [source, receiver, range] = link;
    const Eigenrays found = eigenrays(sea, {source, receiver, range}, GetParam().solver);
    std::vector<bool> used(found.paths.size());
    for (const testing::CsvRow& row : rows) {
      const int index = find_path(
          found.paths, used, row.number("delay_s"), to_radians(row.number("launch_angle_deg")),
          static_cast<int>(row.number("n_surface")), static_cast<int>(row.number("n_bottom")), 1e-6);
      ASSERT_GE(index, 0) << "missing: line " << row.line();
      used[static_cast<std::size_t>(index)] = true;
      expect_row(row, found.paths[static_cast<std::size_t>(index)]);
    }
    EXPECT_EQ(found.paths.size(), rows.size()) << source << " " << receiver << " " << range;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Waters, RayReference,
    ::testing::Values(Case{"B_pekeris", RaySolver::kImages}, Case{"B_pekeris", RaySolver::kSnell},
                      Case{"B_pekeris", RaySolver::kArcs}, Case{"B_pekeris_thorp", RaySolver::kImages},
                      Case{"B_pekeris_thorp", RaySolver::kSnell}, Case{"B_pekeris_thorp", RaySolver::kArcs},
                      Case{"C1_thermocline", RaySolver::kSnell}, Case{"C1_thermocline", RaySolver::kArcs},
                      Case{"D1_upslope_iso", RaySolver::kArcs}, Case{"D2_seamount_tri", RaySolver::kArcs}),
    case_name);

TEST(RayReference, LevelsAndSpreadsOfTheSummaryFollow) {
  for (const testing::CsvRow& row : testing::read_reference_csv("rays/summary.csv")) {
    const Eigenrays found =
        eigenrays(reference_sea(row.text("case")),
                  {row.number("src_depth_m"), row.number("rcv_depth_m"), row.number("rcv_range_m")});
    const ReceivedField field = received_field(found);
    // The table has 6 digits of level and of delays.
    EXPECT_NEAR(-field.level.value, row.number("incoherent_tl_db"), tolerance(1e-4)) << "line " << row.line();
    EXPECT_NEAR(field.first_delay_s, row.number("first_delay_s"), tolerance(1e-10)) << "line " << row.line();
    EXPECT_NEAR(field.mean_delay_s, row.number("energy_mean_delay_s"), tolerance(1e-8))
        << "line " << row.line();
    EXPECT_NEAR(field.delay_spread_s, row.number("rms_delay_spread_s"), tolerance(1e-6))
        << "line " << row.line();
  }
}

}  // namespace
}  // namespace halocline::acoustics
