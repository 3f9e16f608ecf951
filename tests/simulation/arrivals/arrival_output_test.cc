// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/arrivals/arrival_output.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "acoustics/modem/beam_pattern.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "core/csv_table.h"
#include "core/units.h"
#include "runs/plot/plot.h"
#include "simulation/arrivals/arrival_plot.h"
#include "simulation/arrivals/sea_files.h"
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
    found.push_back({link, acoustics::eigenrays(sea, link)});
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

LinkArrivals with_modems() {
  LinkArrivals found = pekeris().front();
  found.modems_known = true;
  for (std::size_t i = 0; i < found.eigenrays.paths.size(); ++i)
    found.received.push_back(
        {{}, Decibels{100.0 - static_cast<double>(i)}, 1.0 + 1e-6 * static_cast<double>(i)});
  return found;
}

TEST(ArrivalOutput, CsvHoldsLevelAndDopplerOfEachPathForKnownModems) {
  std::stringstream text;
  print_arrivals(text, {with_modems()}, OutputFormat::kCsv);
  std::vector<std::string> errors;
  const CsvTable table = read_csv(text, errors);
  ASSERT_TRUE(errors.empty());
  ASSERT_GT(table.rows.size(), 2u);
  EXPECT_EQ(parse_number(table.rows[2].cells[*table.column("level_db")]), 98);
  EXPECT_EQ(parse_number(table.rows[2].cells[*table.column("doppler_factor")]), 1.000002);
}

TEST(ArrivalOutput, JsonHoldsLevelAndDopplerOfEachPathForKnownModems) {
  std::stringstream text;
  print_arrivals(text, {with_modems()}, OutputFormat::kJson);
  const auto path = nlohmann::json::parse(text).at(0).at("paths").at(1);
  EXPECT_EQ(path.at("level_db"), 99);
  EXPECT_EQ(path.at("doppler_factor"), 1.000001);
}

TEST(ArrivalOutput, DistinguishesABlockedLinkFromAShadow) {
  LinkArrivals silent;
  for (const bool blocked : {false, true}) {
    silent.blocked = blocked;
    std::stringstream table, json;
    print_arrivals(table, {silent}, OutputFormat::kTable);
    print_arrivals(json, {silent}, OutputFormat::kJson);
    EXPECT_THAT(table.str(), ::testing::HasSubstr(blocked ? "blocked" : "shadow"));
    EXPECT_EQ(nlohmann::json::parse(json).at(0).at("blocked"), blocked);
  }
}

// At 1 MHz every path of this link has a sample of its own: the powers of the samples are those of the paths.
TEST(ArrivalOutput, ImpulseResponseHoldsThePowerOfAllPaths) {
  const LinkArrivals found = pekeris().front();
  std::stringstream text;
  print_impulse_response(text, found, 25'000, 1e6);
  std::vector<std::string> errors;
  const CsvTable table = read_csv(text, errors);
  double power = 0, expected = 0, last_delay_s = -1;
  for (const auto& row : table.rows) {
    const double delay_s = *parse_number(row.cells[*table.column("delay_s")]);
    if (last_delay_s >= 0) {
      EXPECT_NEAR(delay_s - last_delay_s, 1e-6, 1e-12);
    }
    last_delay_s = delay_s;
    const double real = *parse_number(row.cells[1]), imaginary = *parse_number(row.cells[2]);
    power += real * real + imaginary * imaginary;
  }
  for (const auto& path : found.eigenrays.paths) expected += std::pow(path.received_pressure(), 2);
  EXPECT_NEAR(power / expected, 1, 1e-9);
  EXPECT_LT(*parse_number(table.rows.front().cells[0]), found.eigenrays.paths.front().delay_s);
  EXPECT_GT(last_delay_s, found.eigenrays.paths.back().delay_s);
}

// 6 dB at either end, in every direction: a quarter of the pressure.
TEST(ArrivalOutput, BeamsOfTheModemsWeighTheImpulseResponseAndTheSummary) {
  LinkArrivals found = pekeris().front();
  const auto summarize = [&found](double& greatest, double& loss_db) {
    std::stringstream taps, json;
    print_impulse_response(taps, found, 25'000, 1e6);
    std::vector<std::string> errors;
    greatest = 0;
    for (const auto& row : read_csv(taps, errors).rows) {
      greatest = std::max(greatest, std::abs(*parse_number(row.cells[1])));
    }
    print_arrivals(json, {found}, OutputFormat::kJson);
    loss_db = nlohmann::json::parse(json).at(0).at("transmission_loss_db");
  };
  double plain = 0, weighed = 0, plain_loss_db = 0, weighed_loss_db = 0;
  summarize(plain, plain_loss_db);
  const acoustics::BeamPattern half({{0, 20 * std::log10(2)}});
  found.beams = {half, half};
  summarize(weighed, weighed_loss_db);
  EXPECT_NEAR(weighed / plain, 0.25, 1e-9);
  EXPECT_NEAR(weighed_loss_db - plain_loss_db, 40 * std::log10(2), 1e-9);
}

TEST(ArrivalOutput, ImpulseResponseOfAShadowHasNoRow) {
  std::stringstream text;
  print_impulse_response(text, {}, 25'000, 48'000);
  EXPECT_EQ(text.str(), "delay_s,real,imaginary,magnitude_db\n");
}

TEST(ArrivalOutput, PlotHoldsAStemForEachPathAndItsTwoAngles) {
  const LinkArrivals found = with_modems();
  const Plot plot = arrival_plot({found}, "title");
  ASSERT_EQ(plot.charts.size(), 2u);
  ASSERT_EQ(plot.charts[0].series.size(), 1u);
  EXPECT_EQ(plot.charts[0].series[0].style, Series::kStems);
  EXPECT_EQ(plot.charts[0].series[0].y.at(3), 97);
  EXPECT_EQ(plot.charts[0].series[0].x.at(3), found.eigenrays.paths.at(3).delay_s);
  ASSERT_EQ(plot.charts[1].series.size(), 2u);
  EXPECT_EQ(plot.charts[1].series[1].y.at(1), to_degrees(found.eigenrays.paths.at(1).arrival_angle_rad));
}

TEST(ArrivalOutput, PlotOfAShadowIsLabelled) {
  const Plot plot = arrival_plot({LinkArrivals{}}, "title");
  EXPECT_EQ(plot.charts[0].when_empty, "shadow: no ray gets there");
}

TEST(ArrivalOutput, JsonDistinguishesAShadowFromALinkWithPaths) {
  auto links = pekeris();
  links[1].eigenrays.paths.clear();
  std::ostringstream text;
  print_arrivals(text, links, OutputFormat::kJson);
  const auto json = nlohmann::json::parse(text.str());
  ASSERT_EQ(json.size(), 2u);
  EXPECT_FALSE(json[0]["shadow"]);
  EXPECT_EQ(json[0]["paths"].size(), links[0].eigenrays.paths.size());
  EXPECT_DOUBLE_EQ(json[0]["first_delay_s"], links[0].eigenrays.paths[0].delay_s);
  EXPECT_TRUE(json[1]["shadow"]);
  EXPECT_FALSE(json[1].contains("first_delay_s"));
}

TEST(ArrivalOutput, JsonAndTableNameTheCauseOfALinkWithoutPaths) {
  LinkArrivals weak, steep, blocked;
  weak.eigenrays.lack = acoustics::PathLack::kTooWeak;
  steep.eigenrays.lack = acoustics::PathLack::kTooSteep;
  blocked.blocked = true;
  std::ostringstream text, table;
  print_arrivals(text, {LinkArrivals{}, weak, steep, blocked}, OutputFormat::kJson);
  const auto json = nlohmann::json::parse(text.str());
  EXPECT_EQ(json[0]["cause"], "shadow");
  EXPECT_EQ(json[1]["cause"], "too weak");
  EXPECT_EQ(json[2]["cause"], "too steep");
  EXPECT_EQ(json[3]["cause"], "blocked");
  EXPECT_TRUE(json[0]["shadow"]);
  for (const int i : {1, 2, 3}) EXPECT_FALSE(json[i]["shadow"]) << i;
  print_arrivals(table, {weak}, OutputFormat::kTable);
  EXPECT_THAT(table.str(), ::testing::HasSubstr("too weak"));
}

TEST(ArrivalOutput, TheTableNamesAShadow) {
  std::ostringstream text;
  print_arrivals(text, {{{30, 10, 1000}, {}}}, OutputFormat::kTable);
  EXPECT_THAT(text.str(), ::testing::HasSubstr("shadow"));
}

}  // namespace
}  // namespace halocline::clients
