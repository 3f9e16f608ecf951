// SPDX-License-Identifier: BSD-3-Clause
// Figures 4, 6 and 7 of Sehgal, Cernea and Birk 2010, made by the running channel server, against the
// reference tables (tests/data/README.md). Tolerances are those of the reference formulas: relative 1e-12, dB
// 1e-10, capacity 1e-9; a vehicle's depth is exact in all three, and states travel as doubles.
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "simulation/composition.h"
#include "tests/integration/embedded_fixture.h"
#include "tests/support/csv.h"
#include "tests/support/tolerance.h"

namespace halocline::clients {
namespace {

using ::halocline::testing::read_reference_csv;
using ::halocline::testing::relative_error;
using ::halocline::testing::tolerance;

class EmbeddedFiguresTest : public testing::EmbeddedTest {
 protected:
  // The rows of each vehicle's last link table, by (transmitter, receiver).
  std::map<std::pair<int, int>, link_t> last_rows(const std::string& log) {
    std::map<std::pair<int, int>, link_t> rows;
    for (const auto& [channel, table] : messages_in<link_table_t>(log)) {
      for (const link_t& row : table.peers) rows[{row.transmitter_id, row.receiver_id}] = row;
    }
    return rows;
  }
};

std::string name_of(const std::string& prefix, double number) {
  return prefix + "-" + std::to_string(std::lround(number));
}

TEST_F(EmbeddedFiguresTest, Figure4DelaysAreThoseOfTheReference) {
  const ScenarioConfig config = load("figure4", {"scenario.duration_s=5"});
  const std::string log = run(config, "figure4");
  const auto rows = last_rows(log);
  const auto reference = read_reference_csv("acoustics/fig4_delay_vs_depth_1km.csv");
  int compared = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const auto* a = config.scenario.find(name_of("a", reference[i].number("depth_m")));
    const auto* b = config.scenario.find(name_of("b", reference[i].number("depth_m")));
    if (a == nullptr || b == nullptr) continue;
    EXPECT_LT(relative_error(rows.at({a->id, b->id}).delay_s, reference[i].number("delay_woa98_s")),
              tolerance(1e-12));
    ++compared;
  }
  EXPECT_GE(compared, 4);
}

// The numbers of model.md section 8, printed to six digits.
TEST_F(EmbeddedFiguresTest, Figure4TravelTimesAreThePapers) {
  const ScenarioConfig config = load("figure4", {});
  std::map<std::string, double> travel;
  for (const auto& [channel, packet] : messages_in<modem_receive_t>(run(config, "figure4"))) {
    travel[channel] = packet.travel_time_s;
  }
  EXPECT_NEAR(travel.at("RECEIVE.b-0"), 0.660724, tolerance(1e-6));
  EXPECT_NEAR(travel.at("RECEIVE.b-950"), 0.674539, tolerance(1e-6));
  EXPECT_NEAR(travel.at("RECEIVE.b-4500"), 0.652978, tolerance(1e-6));
  for (const auto& [channel, delay] : travel) EXPECT_LE(delay, travel.at("RECEIVE.b-950")) << channel;
}

// One run for each band and wind of the reference.
TEST_F(EmbeddedFiguresTest, Figures6And7AreThoseOfTheReference) {
  const auto reference = read_reference_csv("acoustics/fig6_fig7_100m_depth.csv");
  std::map<std::vector<double>, std::map<std::pair<int, int>, link_t>> runs;
  const ScenarioConfig plain = load("figure6", {});
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const double low = reference[i].number("f_lo_kHz"), high = reference[i].number("f_hi_kHz");
    const double wind = reference[i].number("wind_m_per_s");
    auto& rows = runs[{low, high, wind}];
    if (rows.empty()) {
      ScenarioConfig config =
          load("figure6", {"scenario.duration_s=2", "environment.wind_mps=" + std::to_string(wind),
                           "modem.center_frequency_hz=" + std::to_string((low + high) * 500),
                           "modem.bandwidth_hz=" + std::to_string((high - low) * 1000)});
      rows = last_rows(run(config, "figure6"));
    }
    const auto* from = plain.scenario.find(name_of("tx", reference[i].number("Ptx_dB_re_1uPa_at_1m")));
    const auto* to = plain.scenario.find(name_of("rx", reference[i].number("range_m")));
    ASSERT_TRUE(from != nullptr && to != nullptr) << "row " << i;
    const link_t& row = rows.at({from->id, to->id});
    EXPECT_NEAR(row.transmission_loss_db, reference[i].number("TL_fc_dB"), tolerance(1e-10)) << "row " << i;
    EXPECT_NEAR(row.received_level_db, reference[i].number("Prx_fc_dB_re_1uPa"), tolerance(1e-10))
        << "row " << i;
    EXPECT_LT(relative_error(row.capacity_bps, reference[i].number("C_eq8_bit_per_s")), tolerance(1e-9))
        << "row " << i;
  }
  EXPECT_EQ(runs.size(), 6u);
}

// The numbers of model.md section 8.
TEST_F(EmbeddedFiguresTest, Figures6And7HaveThePapersEnds) {
  const ScenarioConfig config = load("figure6", {"scenario.duration_s=2"});
  const auto rows = last_rows(run(config, "figure6"));
  const auto row = [&](const char* from, const char* to) {
    return rows.at({config.scenario.find(from)->id, config.scenario.find(to)->id});
  };
  EXPECT_NEAR(row("tx-120", "rx-4").received_level_db, 110.955, tolerance(5e-4));
  EXPECT_NEAR(row("tx-60", "rx-180").received_level_db, 25.541, tolerance(5e-4));
  EXPECT_NEAR(row("tx-120", "rx-4").capacity_bps / 1000, 85.77, tolerance(5e-3));
  EXPECT_NEAR(row("tx-60", "rx-180").capacity_bps, 3.0, tolerance(5e-2));
}

}  // namespace
}  // namespace halocline::clients
