// SPDX-License-Identifier: BSD-3-Clause
// TDMA of a whole scenario goes by its vehicles' clocks: a wrong one begins in the slots of others.
#include <cstdint>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tests/integration/embedded_fixture.h"

namespace halocline::clients {
namespace {

// Three stations with packets of 1.04 s in slots of 1.2 s, of which the second's clock is wrong.
class TdmaClocks : public testing::EmbeddedTest {
 protected:
  static constexpr std::int64_t kRoundUs = 3'600'000;  // of three slots, microseconds

  static std::string text_with(const std::string& clock) {
    std::string text =
        "[scenario]\nduration_s = 150.0\n[environment]\nprofile = \"isovelocity\"\n[propagation]\nmodel = "
        "\"straight\"\nfading = \"none\"\n[modem]\ncenter_frequency_hz = 20000.0\nbandwidth_hz = 1000.0\n"
        "bit_rate_bps = 1000.0\n[network]\nmac = \"tdma\"\nslot_s = 1.2\ninterval_s = 2.0\ndata_bytes = "
        "104\n";
    for (const int i : {1, 2, 3}) {
      text += "[[vehicle]]\nname = \"n" + std::to_string(i) + "\"\nid = " + std::to_string(i) +
              "\nmodel = \"fixed\"\nstart_ned_m = [" + std::to_string(75 * i) + ".0, 0.0, 30.0]\n" +
              (i == 2 && !clock.empty() ? "[vehicle.clock]\n" + clock : "") +
              "[vehicle.network]\ndestination = \"n" + (i == 1 ? "2" : "1") + "\"\n";
    }
    return text;
  }
  // Outcomes by their kind; notes when the second station's packets begin.
  std::map<int, int> outcomes_with(const std::string& clock) {
    std::map<int, int> counts;
    const std::string log = run(load_text(text_with(clock)), "tdma");
    for (const auto& [channel, outcome] : messages_in<packet_outcome_t>(log)) {
      ++counts[outcome.outcome];
      if (outcome.source_id == 2) into_round_.insert(outcome.departure_utime % kRoundUs);
    }
    return counts;
  }

  std::set<std::int64_t> into_round_;  // microseconds
};

TEST_F(TdmaClocks, RightClocksLoseNothing) {
  const auto counts = outcomes_with("");
  ASSERT_EQ(counts.size(), 1u);
  EXPECT_EQ(counts.begin()->first, packet_outcome_t::RECEIVED);
  EXPECT_EQ(into_round_, (std::set<std::int64_t>{1'200'000}));
}

TEST_F(TdmaClocks, AClockHalfASecondAheadBeginsEarlyAndCollides) {
  auto counts = outcomes_with("offset_s = 0.5\n");
  EXPECT_EQ(into_round_, (std::set<std::int64_t>{700'000}));
  EXPECT_GT(counts[packet_outcome_t::COLLIDED], 10);
  EXPECT_GT(counts[packet_outcome_t::HALF_DUPLEX], 10);
}

TEST_F(TdmaClocks, AClockThatGainsBeginsEverEarlier) {
  outcomes_with("drift_ppm = 1000.0\n");
  ASSERT_GT(into_round_.size(), 10u);
  EXPECT_LE(*into_round_.rbegin(), 1'200'000);
  EXPECT_NEAR(static_cast<double>(*into_round_.begin()), 1'200'000 - 150'000, 20'000);
}

}  // namespace
}  // namespace halocline::clients
