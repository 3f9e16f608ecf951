// SPDX-License-Identifier: BSD-3-Clause
// MACs by a clock that differs from simulation time, or is set.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/messages/messages.h"
#include "clients/onboard/networks/mac.h"
#include "clients/onboard/networks/network_config.h"
#include "clients/onboard/networks/network_packet.h"
#include "core/sim_time.h"
#include "tests/clients/onboard/networks/ring.h"

namespace halocline::networks {
namespace {

constexpr std::int32_t kOwn = 1, kOther = 2, kThird = 3;

SimTime at_s(double seconds) { return SimTime::from_seconds(seconds); }
SimDuration for_s(double seconds) { return SimDuration::from_seconds(seconds); }

using Maker = std::unique_ptr<Mac> (*)(MacPort, const NetworkRules&);

// A MAC whose transmissions are only counted.
struct Bench {
  explicit Bench(Maker make, NetworkRules rules = {}) : mac(make(port(), rules)) {}
  MacPort port() {
    return {.transmit = [this](SimTime, const MacFrame&) { ++transmissions; },
            .deliver = [](SimTime, const MacFrame&) {},
            .drop = [](SimTime, const MacFrame&) {},
            .draw = [] { return 0.5; }};
  }

  int transmissions = 0;
  std::unique_ptr<Mac> mac;
};

class AnyMac : public ::testing::TestWithParam<Maker> {};

TEST_P(AnyMac, TakesUpWorkByAClockThatIsBehindAsByAnyOther) {
  Bench right(GetParam()), behind(GetParam());
  right.mac->offer({kOther, {1}}, at_s(10));
  behind.mac->offer({kOther, {1}}, at_s(10 - 50));
  EXPECT_EQ(behind.mac->next() + for_s(50), right.mac->next());
}

TEST_P(AnyMac, WaitsNoLongerWhenItsClockIsSetBack) {
  Bench bench(GetParam());
  bench.mac->offer({kOther, {1}}, at_s(68));
  const SimDuration wait = bench.mac->next() - at_s(68);
  bench.mac->on_clock_set(at_s(18), for_s(-50));
  EXPECT_EQ(bench.mac->next() - at_s(18), wait);
}

INSTANTIATE_TEST_SUITE_P(Networks, AnyMac,
                         ::testing::Values(&make_aloha, &make_slotted_aloha, &make_csma, &make_maca,
                                           &make_dacap, &make_t_lohi));

TEST(Maca, IsSilentForAsLongWhenItsClockIsSetBack) {
  Bench bench(&make_maca);
  modem_receive_t overheard{};
  overheard.utime = at_s(68).to_utime();
  overheard.source_id = kOther;
  overheard.destination_id = kThird;
  overheard.payload = {0xA1};  // a request
  overheard.payload_size = 1;
  bench.mac->on_packet(overheard, kOwn);
  bench.mac->offer({kOther, {1}}, at_s(68));
  const SimDuration silence = NetworkRules().handshake;
  EXPECT_EQ(bench.mac->next(), at_s(68) + silence);
  bench.mac->on_clock_set(at_s(18), for_s(-50));
  EXPECT_EQ(bench.mac->next(), at_s(18) + silence);
}

TEST(Maca, WaitsForAnAnswerForAsLongWhenItsClockIsSetBack) {
  Bench bench(&make_maca);
  bench.mac->offer({kOther, {1}}, at_s(68));
  bench.mac->step(at_s(68));
  ASSERT_EQ(bench.transmissions, 1);
  modem_event_t ended{};
  ended.utime = at_s(68.1).to_utime();
  ended.modem_event = modem_event_t::TRANSMISSION_ENDED;
  bench.mac->on_event(ended);
  const SimTime deadline = bench.mac->next();
  bench.mac->on_clock_set(at_s(18.1), for_s(-50));
  EXPECT_EQ(bench.mac->next(), deadline - for_s(50));
}

TEST(SlottedAloha, TakesTheNextSlotOfAClockThatWasSetBack) {
  NetworkRules rules;
  rules.slot = for_s(1.2);
  Bench bench(&make_slotted_aloha, rules);
  bench.mac->offer({kOther, {1}}, at_s(68));
  EXPECT_EQ(bench.mac->next(), at_s(68.4));
  bench.mac->on_clock_set(at_s(18.1), for_s(-49.9));
  EXPECT_EQ(bench.mac->next(), at_s(19.2));
}

// Two vehicles, of which "late" has the keys of a clock; its packets go to the hub.
std::string with_clock(const std::string& network, const std::string& vehicle_keys, double interval_s,
                       double duration_s) {
  return fmt::format(testing::kWater, fmt::arg("duration", duration_s), fmt::arg("seed", 1),
                     fmt::arg("modem", testing::kModem)) +
         "[network]\ninterval_s = " + fmt::format("{:.1f}", interval_s) + "\n" + network + "\n" +
         testing::vehicle("hub", 1, 0, 0) +
         "[[vehicle]]\nname = \"late\"\nid = 2\nstart_ned_m = [150.0, 0.0, 5.0]\n" + vehicle_keys +
         "\n[vehicle.network]\ndestination = \"hub\"\n";
}

class AnyHandshake : public ::testing::TestWithParam<std::string> {};

TEST_P(AnyHandshake, IsTheSameByAClockWithAnOffset) {
  const std::string rules = "mac = \"" + GetParam() + "\"";
  const std::string clock = "model = \"fixed\"\n[vehicle.clock]\ndrift_ppm = 0.0\noffset_s = ";
  const testing::Results right = testing::run_text(with_clock(rules, clock + "0.0", 20, 600));
  const testing::Results behind = testing::run_text(with_clock(rules, clock + "-50.0", 20, 600));
  constexpr double kClockSteps_s = 1e-4;  // a reading is found to within some microseconds
  EXPECT_GT(right.delivered, 10);
  EXPECT_THAT(behind.delays_s, ::testing::Pointwise(::testing::DoubleNear(kClockSteps_s), right.delays_s));
}

INSTANTIATE_TEST_SUITE_P(Networks, AnyHandshake, ::testing::Values("maca", "dacap", "t-lohi"),
                         [](const auto& test) { return test.param == "t-lohi" ? "tlohi" : test.param; });

// It surfaces, and the first fix sets its clock back by 50 s.
TEST(Tdma, TakesTheNextOwnSlotWhenAFixSetsTheClockBack) {
  const testing::Results results = testing::run_text(with_clock(
      "mac = \"tdma\"\nslot_s = 0.7",
      "model = \"hover\"\n[vehicle.clock]\ndrift_ppm = 0.0\noffset_s = 50.0\n[vehicle.sensors.gps]\n"
      "rate_hz = 1.0\n[vehicle.mission]\nsteering = \"thrusters\"\nwaypoints = [[150.0, 1.0, 0.0]]",
      1.8, 200));
  ASSERT_GT(results.delivered, 10);
  constexpr double kStepBack_s = 50;
  EXPECT_LT(*std::max_element(results.delays_s.begin(), results.delays_s.end()), kStepBack_s / 2);
}

}  // namespace
}  // namespace halocline::networks
