// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acoustics/link/link_kernel.h"
#include "acoustics/modem/modem.h"
#include "acoustics/noise/noise_spectrum.h"
#include "bus/transport/event_log.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/vehicle_equipment.h"
#include "channel_server/vehicles/vehicle_noise.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "tests/channel_server/link_queries.h"
#include "tests/channel_server/node_bench.h"
#include "tests/channel_server/water_models.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::at;
using testing::FlatBottom;
using ::testing::HasSubstr;
using testing::kSpeedMps;
using testing::named;
using testing::NodeBench;

link_end_t with_modem(link_end_t end, const VehicleModem& modem) {
  end.modem_choice = link_end_t::MODEM_GIVEN;
  end.modem = to_message(modem, SimTime());
  return end;
}

class LinkQueryTest : public ::testing::Test {
 protected:
  LinkQueryTest() : bottom_(bench_.lcm(), 100) { bus::set_log_level(bus::LogLevel::kSilent); }

  void publish(const std::vector<std::pair<link_end_t, link_end_t>>& links, std::int64_t request_id = 1) {
    bench_.bus().publish("LINK_QUERY", testing::link_query(links, request_id));
  }
  link_reply_t reply_to(const std::vector<std::pair<link_end_t, link_end_t>>& links, double time_s = 1) {
    publish(links);
    bench_.step(time_s);
    return bench_.replies.at(0).message;
  }
  link_answer_t ask_one(const link_end_t& from, const link_end_t& to) {
    return reply_to({{from, to}}).answers.at(0);
  }
  void expect_bad(const link_end_t& end, const std::string& text) {
    bench_.replies.clear();
    const auto answer = ask_one(at(0, 50), end);
    EXPECT_EQ(answer.answer_status, link_answer_t::BAD_INPUT);
    EXPECT_THAT(answer.problem, HasSubstr(text));
    EXPECT_THAT(answer.problem, HasSubstr("receiver"));
  }

  NodeBench bench_{{}, {testing::quick_modem(), {}}, straight_model(testing::even_water())};
  FlatBottom bottom_;
};

TEST_F(LinkQueryTest, TheFourQueriesOfThePaperAreFieldsOfTheAnswer) {
  const auto answer = ask_one(at(0, 50), at(1500, 50));
  EXPECT_EQ(answer.answer_status, link_answer_t::ANSWERED);
  EXPECT_EQ(answer.getss_received_strength_db, answer.link.received_level_db);
  EXPECT_NEAR(answer.getpd_propagation_delay_s, 1500 / kSpeedMps, tolerance(1e-12));
  EXPECT_EQ(answer.getbw_capacity_kbps, answer.link.capacity_bps / 1000);
  EXPECT_EQ(answer.getml_multipath, answer.link.multipath);
  EXPECT_EQ(answer.link.transmitter_id, 0);
}

TEST_F(LinkQueryTest, TheAnswerIsThatOfTheLinkModelForModemsGiven) {
  VehicleModem quiet = testing::quick_modem(), keen = testing::quick_modem();
  quiet.modem.source_level = {150};
  keen.modem.directivity_index = {10};
  const auto answer = ask_one(with_modem(at(0, 50), quiet), with_modem(at(700, 90), keen));
  const auto expected =
      acoustics::link_budget(testing::even_water(), quiet.modem, keen.modem, {0, 0, 50}, {700, 0, 90});
  EXPECT_EQ(answer.link.received_level_db, expected.received_level.value);
  EXPECT_EQ(answer.link.snr_db, expected.snr.value);
  EXPECT_EQ(answer.link.capacity_bps, expected.capacity_bps);
}

TEST_F(LinkQueryTest, VehiclesAreWhereTheirStatesPutThemAtThatInstant) {
  bench_.state(1, 0, {0, 0, 50});
  bench_.state(2, 0, {1000, 0, 50}, {10, 0, 0});
  bench_.step(2);
  const auto answer = reply_to({{named("v1"), named("v2")}}, 3).answers.at(0);
  EXPECT_EQ(answer.link.receiver_id, 2);
  EXPECT_NEAR(answer.link.range_m, 1030, tolerance(1e-9));
  EXPECT_NEAR(answer.link.receiver_age_s, 3, tolerance(1e-12));
}

TEST_F(LinkQueryTest, AVehicleWithoutStatesIsUnknown) {
  const auto answer = ask_one(named("ghost"), at(0, 50));
  EXPECT_EQ(answer.answer_status, link_answer_t::UNKNOWN_VEHICLE);
  EXPECT_THAT(answer.problem, HasSubstr("ghost"));
}

TEST_F(LinkQueryTest, WithoutSimulationTimeVehiclesAreUnknownAndPositionsAreAnswered) {
  bench_.state(1, 0, {0, 0, 50});
  publish({{named("v1"), at(0, 50)}, {at(0, 50), at(100, 50)}});
  bench_.step(1, /*known=*/false);
  const auto& answers = bench_.replies.at(0).message.answers;
  EXPECT_EQ(answers.at(0).answer_status, link_answer_t::UNKNOWN_VEHICLE);
  EXPECT_EQ(answers.at(1).answer_status, link_answer_t::ANSWERED);
}

TEST_F(LinkQueryTest, EachLinkIsAnsweredOrRefusedOnItsOwn) {
  const auto reply = reply_to({{at(0, 50), at(100, 50)}, {at(0, 50), at(0, -5)}, {at(0, 50), at(200, 50)}});
  EXPECT_EQ(reply.reply_status, link_reply_t::OK);
  EXPECT_EQ(reply.answers.at(0).answer_status, link_answer_t::ANSWERED);
  EXPECT_EQ(reply.answers.at(1).answer_status, link_answer_t::BAD_INPUT);
  EXPECT_NEAR(reply.answers.at(2).link.range_m, 200, tolerance(1e-9));
}

TEST_F(LinkQueryTest, ImpossibleEndsAreRefusedWithClearWords) {
  expect_bad(at(0, -1), "above the sea surface");
  expect_bad(at(0, 13000), "deeper than 12000 m");
  expect_bad(at(std::numeric_limits<double>::quiet_NaN(), 50), "no position");
  expect_bad(at(std::numeric_limits<double>::infinity(), 50), "no position");
  expect_bad(named("Not A Name"), "no name");
  link_end_t strange = at(0, 50);
  strange.modem_choice = 7;
  expect_bad(strange, "modem_choice");
}

TEST_F(LinkQueryTest, ImpossibleModemsAreRefusedWithClearWords) {
  VehicleModem modem = testing::quick_modem();
  modem.modem.bandwidth_hz = 60'000;  // around 25 kHz
  expect_bad(with_modem(at(0, 50), modem), "bandwidth");
  modem = testing::quick_modem();
  modem.modem.source_level = {std::numeric_limits<double>::quiet_NaN()};
  expect_bad(with_modem(at(0, 50), modem), "source_level_db");
  modem = testing::quick_modem();
  modem.modem.directivity_index = {41};
  expect_bad(with_modem(at(0, 50), modem), "directivity_index_db");
}

TEST_F(LinkQueryTest, AQueryWithoutLinksOrWithTooManyIsRefusedAsAWhole) {
  EXPECT_EQ(reply_to({}).reply_status, link_reply_t::REFUSED);
  bench_.replies.clear();
  const auto reply = reply_to(std::vector<std::pair<link_end_t, link_end_t>>(201, {at(0, 50), at(1, 50)}));
  EXPECT_EQ(reply.reply_status, link_reply_t::REFUSED);
  EXPECT_THAT(reply.refusal, HasSubstr("1 to 200"));
  EXPECT_TRUE(reply.answers.empty());
}

TEST_F(LinkQueryTest, TwoHundredLinksAreAnswered) {
  const auto reply = reply_to(std::vector<std::pair<link_end_t, link_end_t>>(200, {at(0, 50), at(400, 50)}));
  ASSERT_EQ(reply.num_answers, 200);
  EXPECT_EQ(reply.answers.back().link.multipath, link_t::MULTIPATH_LIKELY);
}

TEST_F(LinkQueryTest, ARepetitionWhileWaitingIsAnsweredOnce) {
  bottom_.set_away(true);
  publish({{at(0, 50), at(1, 50)}}, 3);
  publish({{at(0, 50), at(1, 50)}}, 3);
  bench_.step(1);
  bench_.step(1.25);
  EXPECT_EQ(bench_.replies.size(), 1u);
}

TEST_F(LinkQueryTest, TooManyWaitingQueriesAreRefused) {
  bottom_.set_away(true);
  for (int i = 0; i < 40; ++i) publish({{at(0, 50), at(1, 50)}}, i);
  bench_.step(1);
  for (int i = 40; i < 80; ++i) publish({{at(0, 50), at(1, 50)}}, i);
  bench_.step(1.01);
  EXPECT_EQ(bench_.replies.size(), 16u);
  EXPECT_THAT(bench_.replies.back().message.refusal, HasSubstr("too many queries"));
  bench_.step(1.26);
  EXPECT_EQ(bench_.replies.size(), 80u);
}

TEST_F(LinkQueryTest, TheReplyGoesToItsClientWithItsNumber) {
  publish({{at(0, 50), at(1, 50)}}, 123456789);
  bench_.step(7);
  EXPECT_EQ(bench_.replies.at(0).channel, "LINK_REPLY.tester");
  EXPECT_EQ(bench_.replies.at(0).message.request_id, 123456789);
  EXPECT_EQ(bench_.replies.at(0).message.utime, 7'000'000);
  EXPECT_EQ(bench_.replies.at(0).message.session, NodeBench::kSession);
}

TEST(LinkQueryOverASeabed, APositionInsideItIsRefused) {
  bus::set_log_level(bus::LogLevel::kSilent);
  NodeBench bench({}, {testing::quick_modem(), {}}, ray_model(testing::even_water(), {}, {}));
  FlatBottom bottom(bench.lcm(), 100);
  bench.bus().publish(
      "LINK_QUERY", testing::link_query(
                        {{at(0, 50), at(500, 60)}, {at(0, 130), at(500, 60)}, {at(0, 50), at(500, 108)}}, 1));
  for (int step = 1; step <= 5 && bench.replies.empty(); ++step) bench.step(step);
  const auto& answers = bench.replies.at(0).message.answers;
  EXPECT_EQ(answers.at(0).answer_status, link_answer_t::ANSWERED);
  EXPECT_EQ(answers.at(1).answer_status, link_answer_t::BAD_INPUT);
  EXPECT_EQ(answers.at(1).problem, "transmitter: position_ned_m lies 30 m inside the seabed");
  EXPECT_EQ(answers.at(2).problem, "receiver: position_ned_m lies 8 m inside the seabed");
}

// 2 hears itself and a jammer 300 m beside it; 3 has no modem. All rest, so what a packet meets is what was
// asked for before.
TEST(LinkQueryAmongNoise, TablesAnswersAndOutcomesKnowTheSameNoise) {
  bus::set_log_level(bus::LogLevel::kSilent);
  const acoustics::NoiseSpectrum own({1e3}, {60}), jammer({1e3}, {100});
  const VehicleEquipment equipment{.noise =
                                       VehicleNoise({{"v2", 2, own, NoiseDriver::kNone, 1, Decibels{10}},
                                                     {"v3", 3, jammer, NoiseDriver::kNone, 1, Decibels{20}}},
                                                    testing::for_s(0.05))};
  VehicleModem none = testing::quick_modem();
  none.fitted = false;
  NodeBench bench({}, {testing::quick_modem(), {{"v3", none}}}, straight_model(testing::even_water()),
                  equipment);
  FlatBottom bottom(bench.lcm(), 100);
  for (double time_s = 0; time_s <= 4; time_s += 0.5) {
    bench.state(1, time_s, {0, 0, 50});
    bench.state(2, time_s, {750, 0, 50});
    bench.state(3, time_s, {750, 300, 50});
  }
  bench.run_to(1);
  bench.send(1, 2, 0, 8);
  bench.bus().publish("LINK_QUERY",
                      testing::link_query({{named("v1"), named("v2")}, {named("v1"), at(750, 50)}}, 1));
  bench.run_to(4);
  ASSERT_EQ(bench.outcomes.size(), 1u);
  const auto power = [](double level_db) { return to_power_ratio(Decibels{level_db}).value; };
  const packet_outcome_t& outcome = bench.outcomes[0];
  const double met = power(outcome.noise_level_db) + power(outcome.interference_level_db);
  const link_t &table = bench.last_table(1).peers.at(0),
               &asked = bench.replies.at(0).message.answers.at(0).link;
  EXPECT_NEAR(power(table.noise_level_db) / met, 1, tolerance(1e-9));
  EXPECT_NEAR(power(asked.noise_level_db) / met, 1, tolerance(1e-9));
  EXPECT_NEAR(asked.snr_db, asked.received_level_db - asked.noise_level_db, tolerance(1e-9));
  EXPECT_EQ(asked.capacity_bps, table.capacity_bps);
  EXPECT_EQ(asked.sinr_db, table.sinr_db);
  // A hydrophone at the place of 2 has no noise of its own, and hears 2 at 1 m: 5 kHz of 60 dB in the place
  // of 50 dB.
  const link_t& place = bench.replies[0].message.answers.at(1).link;
  EXPECT_NEAR((power(place.noise_level_db) - power(asked.noise_level_db)) / (5000 * (1e6 - 1e5)), 1,
              tolerance(1e-6));
  EXPECT_LT(place.capacity_bps, asked.capacity_bps);
  const acoustics::Modem& modem = testing::quick_modem().modem;
  const acoustics::LinkKernel kernel(testing::even_water(), modem, modem);
  const Decibels above{place.noise_level_db - kernel.noise_level().value};
  EXPECT_GT(above.value, 3);
  const auto expected = kernel.budget({0, 0, 50}, {750, 0, 50}, acoustics::Capacity::kComputed, above);
  EXPECT_NEAR(place.capacity_bps / expected.capacity_bps, 1, tolerance(1e-9));
}

}  // namespace
}  // namespace halocline::channel_server
