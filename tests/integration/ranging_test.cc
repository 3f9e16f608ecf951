// SPDX-License-Identifier: BSD-3-Clause
// The ranging scenario: the error of the position estimate, and that its covariance matches it.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bus/bus.h"
#include "tests/integration/embedded_fixture.h"

namespace halocline::clients {
namespace {

class RangingTest : public testing::EmbeddedTest {
 protected:
  std::vector<position_estimate_t> estimates(const std::vector<std::string>& overrides) {
    std::vector<position_estimate_t> all;
    const std::string log = run(load("ranging", overrides), "ranging");
    for (const auto& [channel, message] : messages_in<position_estimate_t>(log)) {
      EXPECT_EQ(channel, "ESTIMATE.auv-1");
      all.push_back(message);
    }
    return all;
  }
};

double error_m(const position_estimate_t& e) { return std::hypot(e.error_ned_m[0], e.error_ned_m[1]); }

double normalised_square(const position_estimate_t& e) {
  const Eigen::Matrix2d covariance = (Eigen::Matrix2d() << e.covariance_ned_m2[0], e.covariance_ned_m2[1],
                                      e.covariance_ned_m2[3], e.covariance_ned_m2[4])
                                         .finished();
  const Eigen::Vector2d error(e.error_ned_m[0], e.error_ned_m[1]);
  return error.dot(covariance.inverse() * error);
}

// Travel times are exact here; what is left is the bending of the way (0.1 m in 0.9 km of this water, by
// Fermat's principle) and the slip of the vehicle in turns, which dead reckoning does not model and which the
// next ranges take back: a turn of 60 degrees is estimated at 2 m.
TEST_F(RangingTest, FindsAndKeepsItsPlaceByPings) {
  const auto all = estimates({"scenario.duration_s=420"});
  ASSERT_EQ(all.size(), 421u);
  int seconds_within_a_metre = 0;
  for (std::size_t second = 30; second < all.size(); ++second) {
    ASSERT_EQ(all[second].estimate_status, position_estimate_t::UNIQUE) << second;
    ASSERT_TRUE(all[second].truth_known);
    EXPECT_LT(error_m(all[second]), 2) << second;
    EXPECT_LT(normalised_square(all[second]), 18.4) << second;  // 1e-4 of chi-squared with two degrees
    seconds_within_a_metre += error_m(all[second]) < 1;
  }
  EXPECT_GT(seconds_within_a_metre, 370);
  EXPECT_GT(all.back().ranges_used, 70);  // a ping each 5 s, most of them answered
}

TEST_F(RangingTest, DoesLikewiseByStampedPacketsOfTheBeacons) {
  std::vector<std::string> one_way{"scenario.duration_s=90", "vehicle.2.localiser.ping_period_s=0",
                                   "vehicle.2.localiser.use_stamps=true"};
  for (const std::string beacon : {"0", "1"}) {
    one_way.push_back("vehicle." + beacon + ".traffic.period_s=10");
    // Short packets: of longer ones most are lost between the echoes of this shallow water.
    one_way.push_back("vehicle." + beacon + ".traffic.payload_bytes=1");
    one_way.push_back("vehicle." + beacon + ".traffic.start_s=" + (beacon == "0" ? "2" : "7"));
  }
  const auto all = estimates(one_way);
  ASSERT_EQ(all.size(), 91u);
  EXPECT_EQ(all.back().estimate_status, position_estimate_t::UNIQUE);
  EXPECT_LT(error_m(all.back()), 1);
  EXPECT_LT(normalised_square(all.back()), 18.4);
}

TEST_F(RangingTest, DepthIsThatOfThePressureGauge) {
  const auto all = estimates({"scenario.duration_s=30"});
  EXPECT_NEAR(all.back().error_ned_m[2], 0, 0.2);
}

TEST_F(RangingTest, WithoutBeaconsNothingIsPublished) {
  EXPECT_TRUE(estimates({"scenario.duration_s=5", "vehicle.2.localiser.beacons=\"\""}).empty());
}

}  // namespace
}  // namespace halocline::clients
