// SPDX-License-Identifier: BSD-3-Clause
// The protocols that avoid collisions, in lockstep, against what their papers promise: T-Lohi, DACAP and
// ALOHA-CA.
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/clients/onboard/networks/ring.h"

namespace halocline::networks {
namespace {

using testing::Results;
using testing::Ring;
using testing::run;
using testing::run_text;
using testing::vehicle;

std::int64_t count(const Results& results, int outcome) {
  const auto found = results.outcomes.find(outcome);
  return found == results.outcomes.end() ? 0 : found->second;
}

std::int64_t all(const Results& results) {
  std::int64_t sum = 0;
  for (const auto& [outcome, packets] : results.outcomes) sum += packets;
  return sum;
}

// Sound takes 0.1 s from side to side and a tone 0.032 s.
constexpr double kRound_s = 0.232, kGap_s = 0.02;
constexpr const char* kLohi = "contention_s = 0.232";

double best_utilisation(double packet_s) { return packet_s / (packet_s + kRound_s + kGap_s); }

TEST(TLohi, OneVehicleAloneUsesTheChannelButForItsRounds) {
  const Results one =
      run({.mac = "t-lohi", .settings = kLohi, .stations = 1, .packet_s = 2, .load = 1.5, .packets = 450});
  EXPECT_EQ(count(one, packet_outcome_t::RECEIVED), all(one));
  // The queue is empty before the first packet is offered, and a packet may be under way at the end.
  EXPECT_NEAR(one.s(), best_utilisation(one.packet_s), 0.015);
  EXPECT_LE(one.s(), best_utilisation(one.packet_s));
}

// All vehicles always have something to send, so each data packet ends a contention of all twenty.
TEST(TLohi, EachContentionOfManyHasOneWinner) {
  const Results many =
      run({.mac = "t-lohi", .settings = kLohi, .stations = 20, .packet_s = 3, .load = 2, .packets = 1000});
  EXPECT_GT(all(many), 300);
  EXPECT_EQ(count(many, packet_outcome_t::RECEIVED), all(many));
  EXPECT_LE(many.s(), best_utilisation(many.packet_s));
  EXPECT_GT(many.s(), 0.7 * best_utilisation(many.packet_s)) << "within 30 % of the best";
}

// Four vehicles a kilometre round a hub, 1.4 km from each other: at 100 kHz the hub hears each, and they hear
// only the hub.
std::string hidden(const std::string& network, double interval_s) {
  std::string text = fmt::format(
      testing::kWater, fmt::arg("duration", 8000.0), fmt::arg("seed", 1),
      fmt::arg("modem", std::string(testing::kModem) + "source_level_db = 158.0\ncutoff_level_db = 70.0"));
  text.replace(text.find("5000.0"), 6, "100000.0");
  text += fmt::format("[network]\n{}\ninterval_s = {}\ndata_bytes = 228\n", network, interval_s);
  text += vehicle("hub", 1, 0, 0);
  int id = 2;
  for (const auto& [north_m, east_m] : {std::pair(1000, 0), {0, 1000}, {-1000, 0}, {0, -1000}})
    text += vehicle("s" + std::to_string(id - 1), id, north_m, east_m,
                    "[vehicle.network]\ndestination = \"hub\""),
        ++id;
  return text;
}

std::int64_t lost_in_collisions(const Results& results) {
  return count(results, packet_outcome_t::COLLIDED) + count(results, packet_outcome_t::HALF_DUPLEX);
}

// Data of 2 s, sound of 0.667 s, control packets of 8 ms.
constexpr const char* kDacap =
    "mac = \"dacap\"\ntries = 20\nbackoff_s = 8.0\nhandshake_s = 1.4\nexchange_s = 6.2\npacket_s = 2.0\n"
    "longest_travel_s = 0.667\nshortest_handshake_s = 1.334\ntolerance_s = 0.68\ncarrier_threshold_db = 10.0";

TEST(Dacap, LosesNoDataToVehiclesThatTheSenderDoesNotHear) {
  const Results blind = run_text(hidden("mac = \"aloha\"", 40));
  const Results heard = run_text(hidden("mac = \"csma\"\ncarrier_threshold_db = 10.0", 40));
  EXPECT_GT(lost_in_collisions(blind), 150);
  EXPECT_GT(lost_in_collisions(heard), 150) << "carrier sense does not help: nobody hears the others";
  const Results dacap = run_text(hidden(kDacap, 40));
  EXPECT_GT(dacap.delivered, 400);
  EXPECT_EQ(count(dacap, packet_outcome_t::RECEIVED), all(dacap));
}

// Vehicles up to 4 km from the hub: sound takes 2.7 s. A packet of ahoi's format with a header and 21 bytes
// lasts 0.93 s, of which preamble and header are 0.28 s.
Ring wide(const std::string& mac) {
  return {.mac = mac,
          .settings = "packet_s = 0.931\nbackoff_s = 10.0\ntries = 20",
          .stations = 25,
          .radius_m = 4000,
          .packet_s = 0.168,
          .load = 0.09,
          .packets = 6000,
          .modem = "profile = \"ahoi\"\nsource_level_db = 180.0",
          .nearest_m = 200};
}

// Both have the same offers. A collision loses two packets at once: the variance of the number received is at
// most twice that of a binomial one.
TEST(AlohaCa, CarriesMoreThanAlohaWherePropagationIsLong) {
  const Results blind = run(wide("aloha")), avoiding = run(wide("aloha-ca"));
  const double p = blind.share(), n = static_cast<double>(blind.sent);
  const double deviation = std::sqrt(2 * 2 * p * (1 - p) / n);  // of the difference
  EXPECT_GT(avoiding.s(), blind.s() + 3.29 * deviation * blind.g());
}

}  // namespace
}  // namespace halocline::networks
