// SPDX-License-Identifier: BSD-3-Clause
// The example protocols in lockstep against what textbooks say of them, by statistics. Bounds are those of
// 99.9 % confidence: 3.29 standard deviations.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/onboard/networks/network_packet.h"
#include "halocline/sweep/sweep_plan.h"
#include "simulation/composition.h"
#include "tests/clients/onboard/networks/ring.h"

namespace halocline::networks {
namespace {

using ::testing::Each;
using testing::Results;
using testing::Ring;
using testing::run;
using testing::run_text;
using ::testing::SizeIs;
using testing::vehicle;

constexpr double kSigmas = 3.29;

double aloha(double g) { return g * std::exp(-2 * g); }
// Non-persistent CSMA (Kleinrock and Tobagi 1975, equation 7).
double csma(double g, double a) { return g * std::exp(-a * g) / (g * (1 + 2 * a) + std::exp(-a * g)); }

// Standard deviation of the share of packets received of n by pure ALOHA. A packet comes through when the
// gaps before and after it are longer than itself, each with the probability p = exp(-G); neighbours share a
// gap, so the variance of the number is n [p^2 (1 - p^2) + 2 p^3 (1 - p)].
double deviation_of_aloha(double g, double n) {
  const double p = std::exp(-g);
  return std::sqrt((p * p * (1 - p * p) + 2 * p * p * p * (1 - p)) / n);
}

class PureAloha : public ::testing::TestWithParam<double> {};

// Fifty stations are nearly a Poisson process: of a finite number N the share is greater by G^2 / (2 N) of
// itself, 1 % at G = 1.
TEST_P(PureAloha, HasTheThroughputOfAbramson) {
  const Results results = run({.load = GetParam()});
  const double g = results.g(), n = static_cast<double>(results.sent);
  EXPECT_NEAR(g, GetParam(), kSigmas * GetParam() / std::sqrt(n));
  EXPECT_NEAR(results.share(), std::exp(-2 * g), kSigmas * deviation_of_aloha(g, n));
  EXPECT_NEAR(results.s(), aloha(g), g * kSigmas * deviation_of_aloha(g, n));
  for (const auto& [outcome, count] : results.outcomes) {
    EXPECT_TRUE(outcome == packet_outcome_t::RECEIVED || outcome == packet_outcome_t::COLLIDED) << outcome;
  }
}

INSTANTIATE_TEST_SUITE_P(Networks, PureAloha, ::testing::Values(0.1, 0.5, 1.0));

// Near stations are up to 24 dB louder at the hub than far ones: a packet of theirs survives a far one that
// comes during it.
TEST(Aloha, GetsMoreThroughWhereStrongPacketsCapture) {
  const Results results = run({.radius_m = 750, .load = 0.5, .nearest_m = 20});
  const double g = results.g(), n = static_cast<double>(results.sent);
  EXPECT_GT(results.share(), std::exp(-2 * g) + kSigmas * deviation_of_aloha(g, n));
}

// Of N stations S = G (1 - G / N)^(N - 1) a slot (Abramson 1973). The number of slots with one packet is
// binomial. Places are rounded to a millimetre, so a slot is a little longer than a packet.
TEST(SlottedAloha, HasTheThroughputOfRoberts) {
  const Ring ring{.mac = "slotted-aloha", .settings = "slot_s = 1.001", .load = 0.8};
  const Results results = run(ring);
  const double slots = results.duration_s / 1.001, g = static_cast<double>(results.sent) / slots;
  const double s = g * std::pow(1 - g / ring.stations, ring.stations - 1);
  EXPECT_NEAR(static_cast<double>(results.delivered) / slots, s, kSigmas * std::sqrt(s * (1 - s) / slots));
}

TEST(Tdma, NeverCollidesAndCarriesMoreThanAloha) {
  // Fifty-one slots, one of them the hub's.
  const Results results = run({.mac = "tdma", .settings = "slot_s = 1.1", .load = 0.7, .packets = 2000});
  EXPECT_EQ(results.outcomes.count(packet_outcome_t::COLLIDED), 0u);
  EXPECT_GT(results.s(), 2 * aloha(0.5));
}

// Sound needs at most 0.01 of a packet from station to station. The number received is less random than a
// Poisson number, since a packet keeps others from theirs.
TEST(Csma, HasTheThroughputOfKleinrockAndTobagiWherePropagationIsShort) {
  const Results results = run({.mac = "csma", .packet_s = 10, .load = 1});
  const double expected = csma(results.attempts(), 0.01);
  EXPECT_NEAR(results.s(), expected, kSigmas * expected / std::sqrt(static_cast<double>(results.delivered)));
}

TEST(Csma, BeatsAlohaWherePropagationIsShort) {
  const Results sensing = run({.mac = "csma", .packet_s = 10, .load = 1, .packets = 1000});
  const Results blind = run({.mac = "aloha", .packet_s = 10, .load = 1, .packets = 1000});
  EXPECT_GT(sensing.s(), 2 * blind.s());
}

// Sound needs up to five packets from station to station: what is sensed has long passed the hub, and who
// waits for it loses his turn.
TEST(Csma, LosesAgainstAlohaWherePropagationIsLong) {
  const Ring ring{.radius_m = 750, .packet_s = 0.2, .load = 0.3, .packets = 8000};
  Ring with_sense = ring;
  with_sense.mac = "csma";
  const Results sensing = run(with_sense), blind = run(ring);
  const double n = static_cast<double>(blind.sent);
  // Of the difference, as if both were ALOHA: fewer packets of CSMA vary less.
  const double deviation = ring.load * deviation_of_aloha(ring.load, n) * std::sqrt(2);
  EXPECT_LT(sensing.s(), blind.s() - kSigmas * deviation);
}

TEST(Csma, TriesAgainUntilTheChannelIsFree) {
  const Results patient = run({.mac = "csma",
                               .settings = "tries = 50\nbackoff_s = 20.0",
                               .packet_s = 10,
                               .load = 0.4,
                               .packets = 500});
  const Results impatient = run({.mac = "csma", .packet_s = 10, .load = 0.4, .packets = 500});
  EXPECT_EQ(patient.dropped, 0);
  EXPECT_GT(impatient.dropped, 50);
  EXPECT_GT(patient.delivered, impatient.delivered);
}

TEST(Maca, CarriesMoreThanAlohaWherePacketsAreLong) {
  const std::string rules = "tries = 10\nbackoff_s = 10.0\nhandshake_s = 0.6\nexchange_s = 10.6";
  const Results maca = run({.mac = "maca", .settings = rules, .packet_s = 10, .load = 0.6, .packets = 500});
  const Results blind = run({.mac = "aloha", .packet_s = 10, .load = 0.6, .packets = 500});
  EXPECT_GT(maca.s(), 1.5 * blind.s());
}

TEST(Maca, APacketTakesThreeOfModemsAndTheirTravelTimes) {
  const Results one = run({.mac = "maca",
                           .settings = "handshake_s = 3.0\nexchange_s = 13.0",
                           .stations = 1,
                           .radius_m = 750,
                           .packet_s = 10,
                           .load = 0.05,
                           .packets = 20});
  ASSERT_GT(one.delivered, 10);
  EXPECT_EQ(one.delivered * 3, one.sent);
  // A byte lasts 8 ms; RTS, CTS and the data's first byte have one each. Sound travels 0.5 s, three
  // times.
  EXPECT_NEAR(*std::min_element(one.delays_s.begin(), one.delays_s.end()), 10 + 3 * 0.008 + 3 * 0.5, 1e-5);
}

// A source, a relay and a sink in line; the sink does not receive the source.
std::string line(const std::string& network, const std::string& via) {
  return fmt::format(testing::kWater, fmt::arg("duration", 2000.0), fmt::arg("seed", 1),
                     fmt::arg("modem", testing::kModem)) +
         "[network]\nmac = \"aloha\"\ninterval_s = 40.0\n" + network +
         "\n[[extra_loss]]\nfrom = \"source\"\nto = \"sink\"\nshare = 1.0\n" + vehicle("sink", 1, 0, 0) +
         vehicle("relay", 2, 500, 0) +
         vehicle("source", 3, 1000, 0, "[vehicle.network]\ndestination = \"sink\"\n" + via);
}

TEST(StaticRouting, GoesByTheNeighbour) {
  const Results by_relay = run_text(line("", "via = \"relay\"")), direct = run_text(line("", ""));
  EXPECT_GT(by_relay.delivered, 20);
  EXPECT_GE(by_relay.delivered, by_relay.offered - 2);  // some may be under way at the end
  EXPECT_THAT(by_relay.hops, Each(2));
  EXPECT_EQ(direct.delivered, 0);
}

TEST(Flooding, GoesRoundWhatIsLostOnce) {
  const Results two = run_text(line("router = \"flooding\"\nhops = 2", ""));
  const Results one = run_text(line("router = \"flooding\"\nhops = 1", ""));
  EXPECT_GT(two.delivered, 20);
  EXPECT_GE(two.delivered, two.offered - 2);
  EXPECT_THAT(two.hops, Each(2));
  EXPECT_EQ(one.delivered, 0);
}

TEST(Networks, TheSameSeedGivesTheSameRunAndAnotherSeedAnother) {
  const Ring ring{.mac = "csma", .settings = "tries = 5", .stations = 10, .packets = 200};
  Ring other = ring;
  other.seed = 2;
  const Results first = run(ring);
  EXPECT_EQ(first.delays_s, run(ring).delays_s);
  EXPECT_NE(first.delays_s, run(other).delays_s);
}

// Packets and their header.
TEST(NetworkPacket, SurvivesItsWay) {
  const NetworkPacket packet{70'000, 3, 4'000'000'000, 1'234'567'890'123, 7, 5};
  const auto bytes = encode(packet);
  EXPECT_EQ(bytes.size(), NetworkPacket::kHeaderBytes + 5);
  const auto read = decode_network_packet(bytes);
  ASSERT_TRUE(read);
  EXPECT_EQ(std::tie(read->origin, read->destination, read->number, read->offered_utime, read->hops,
                     read->data_bytes),
            std::tie(packet.origin, packet.destination, packet.number, packet.offered_utime, packet.hops,
                     packet.data_bytes));
  EXPECT_FALSE(decode_network_packet(std::span(bytes).first(NetworkPacket::kHeaderBytes - 1)));
}

class ShippedNetwork : public ::testing::TestWithParam<std::string> {};

// A scenario makes sense, and so does each point of a sweep.
TEST_P(ShippedNetwork, MakesSense) {
  const std::string file = std::string(HALOCLINE_SOURCE_DIR) + "/scenarios/networks/" + GetParam();
  if (GetParam().starts_with("sweep_")) {
    const clients::SweepPlan plan = clients::load_plan(file);
    for (std::size_t i = 0; i < plan.runs(); ++i)
      EXPECT_NO_THROW(clients::load_scenario(plan.scenario.place(), run_of(plan, i).overrides)) << i;
  } else {
    EXPECT_THAT(clients::load_checked(file, {}).warnings, ::testing::IsEmpty());
  }
}

std::vector<std::string> shipped() {
  std::vector<std::string> names;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(HALOCLINE_SOURCE_DIR) + "/scenarios/networks"))
    names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(Networks, ShippedNetwork, ::testing::ValuesIn(shipped()),
                         [](const auto& test) { return test.param.substr(0, test.param.find('.')); });

}  // namespace
}  // namespace halocline::networks
