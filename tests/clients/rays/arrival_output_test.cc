#include "clients/rays/arrival_output.h"

#include <sstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "clients/rays/sea_files.h"
#include "core/csv_table.h"
#include "tests/support/csv.h"

namespace halocline::clients {
namespace {

std::vector<LinkArrivals> pekeris() {
  SeaDescription description;
  description.sound_speed_mps = 1500;
  description.bottom_depth_m = 100;
  const acoustics::RaySea sea = make_sea(description);
  std::vector<LinkArrivals> found;
  for (const double range_m : {1000.0, 2000.0}) {
    const acoustics::RayLink link{30, 10, range_m};
    found.push_back({link, acoustics::arrivals(sea, link)});
  }
  return found;
}

TEST(ArrivalOutput, CsvHoldsTheColumnsAndRowsOfTheReference) {
  std::stringstream text;
  print_arrivals(text, pekeris(), OutputFormat::kCsv);
  std::vector<std::string> errors;
  const CsvTable table = read_csv(text, errors);
  ASSERT_TRUE(errors.empty());
  std::size_t i = 0;
  for (const testing::CsvRow& row : testing::read_reference_csv("rays/B_pekeris_exact.csv")) {
    if (row.number("rcv_depth_m") != 10 || row.number("rcv_range_m") > 2000) continue;
    ASSERT_LT(i, table.rows.size());
    // As the reference rounds its columns.
    for (const auto& [column, tolerance] : {std::pair{"src_depth_m", 0.0},
                                            {"rcv_range_m", 0.0},
                                            {"index", 0.0},
                                            {"delay_s", 1e-11},
                                            {"amplitude", 1e-10},
                                            {"phase_deg", 1e-4},
                                            {"launch_angle_deg", 1e-6},
                                            {"arrival_angle_deg", 1e-6},
                                            {"n_surface", 0.0},
                                            {"n_bottom", 0.0},
                                            {"n_caustic", 0.0}}) {
      const auto index = table.column(column);
      ASSERT_TRUE(index.has_value()) << column;
      EXPECT_NEAR(*parse_number(table.rows[i].cells[*index]), row.number(column), tolerance)
          << column << " of line " << row.line();
    }
    ++i;
  }
  EXPECT_EQ(i, table.rows.size());
}

TEST(ArrivalOutput, JsonTellsALinkInAShadowFromOneWithPaths) {
  auto links = pekeris();
  links[1].arrivals.paths.clear();
  std::ostringstream text;
  print_arrivals(text, links, OutputFormat::kJson);
  const auto json = nlohmann::json::parse(text.str());
  ASSERT_EQ(json.size(), 2u);
  EXPECT_FALSE(json[0]["shadow"]);
  EXPECT_EQ(json[0]["paths"].size(), links[0].arrivals.paths.size());
  EXPECT_DOUBLE_EQ(json[0]["first_delay_s"], links[0].arrivals.paths[0].delay_s);
  EXPECT_TRUE(json[1]["shadow"]);
  EXPECT_FALSE(json[1].contains("first_delay_s"));
}

TEST(ArrivalOutput, TheTableSaysShadow) {
  std::ostringstream text;
  print_arrivals(text, {{{30, 10, 1000}, {}}}, OutputFormat::kTable);
  EXPECT_THAT(text.str(), ::testing::HasSubstr("shadow"));
}

}  // namespace
}  // namespace halocline::clients
