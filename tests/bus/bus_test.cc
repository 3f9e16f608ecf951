// SPDX-License-Identifier: BSD-3-Clause
#include "bus/bus.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/bus/messages_for_tests.h"

namespace halocline::bus {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::valid_message;

class BusTest : public ::testing::Test {
 protected:
  BusTest() { set_log_level(LogLevel::kSilent); }
  ~BusTest() override { set_log_level(LogLevel::kInfo); }

  void drain() {
    while (lcm_.handleTimeout(0) > 0) {
    }
  }
  void publish_raw(const std::string& channel, const std::vector<std::uint8_t>& bytes) {
    lcm_.publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
  }

  lcm::LCM lcm_{"memq://"};
  Bus bus_{lcm_, {"listener", 11}};
};

TEST_F(BusTest, DeliversPublishedMessages) {
  std::vector<double> received;
  bus_.subscribe<sim_clock_t>(channels::kClock,
                              [&](const sim_clock_t& m) { received.push_back(m.clock_rate); });
  sim_clock_t clock = valid_message<sim_clock_t>(1);
  clock.clock_rate = 2.5;
  bus_.publish(channels::kClock, clock);
  drain();
  EXPECT_THAT(received, ElementsAre(2.5));
  EXPECT_EQ(bus_.counters().received, 1);
  EXPECT_EQ(bus_.counters().sent, 1);
}

TEST_F(BusTest, AFamilyHandlerGetsTheNameAfterTheDot) {
  std::vector<std::string> names;
  bus_.subscribe<vehicle_state_t>(
      channels::kState, [&](std::string_view name, const vehicle_state_t&) { names.emplace_back(name); });
  bus_.publish("STATE.alpha", valid_message<vehicle_state_t>(1));
  bus_.publish("STATE.b-2", valid_message<vehicle_state_t>(2));
  bus_.publish("XSTATE.alpha", valid_message<vehicle_state_t>(3));
  bus_.publish("STATEx", valid_message<vehicle_state_t>(4));
  drain();
  EXPECT_THAT(names, ElementsAre("alpha", "b-2"));
}

TEST_F(BusTest, ANameThatIsNoNameIsRefused) {
  int received = 0;
  bus_.subscribe<vehicle_state_t>(channels::kState,
                                  [&](std::string_view, const vehicle_state_t&) { ++received; });
  for (const char* channel : {"STATE.", "STATE.Upper", "STATE.a.b", "STATE.much-too-long-for-a-vehicle"}) {
    bus_.publish(channel, valid_message<vehicle_state_t>(1));
  }
  drain();
  EXPECT_EQ(received, 0);
  EXPECT_EQ(bus_.counters().refused, 4);
  EXPECT_EQ(bus_.counters().received, 0);
}

TEST_F(BusTest, ALiteralChannelReceivesNoOtherChannel) {
  int received = 0;
  bus_.subscribe<sim_clock_t>("A.B", [&](const sim_clock_t&) { ++received; });
  for (const char* channel : {"AxB", "A.BC", "XA.B", "A.B"})
    bus_.publish(channel, valid_message<sim_clock_t>(1));
  drain();
  EXPECT_EQ(received, 1);
}

// Beyond a few they share one subscription of LCM's.
TEST_F(BusTest, ManyChannelsOfAFamilyReceiveTheirOwnMessagesAlone) {
  constexpr int kChannels = 50;
  std::vector<std::vector<std::int64_t>> received(kChannels);
  int twice = 0;
  for (int i = 0; i < kChannels; ++i) {
    bus_.subscribe<vehicle_state_t>("STATE.v" + std::to_string(i),
                                    [&received, i](const vehicle_state_t& state) {
                                      received[static_cast<std::size_t>(i)].push_back(state.sequence);
                                    });
  }
  bus_.subscribe<vehicle_state_t>("STATE.v7", [&](const vehicle_state_t&) { ++twice; });
  for (int i = 0; i < kChannels; ++i) {
    vehicle_state_t state = valid_message<vehicle_state_t>(1);
    state.sequence = i;
    bus_.publish("STATE.v" + std::to_string(i), state);
  }
  bus_.publish("STATE.v", valid_message<vehicle_state_t>(1));
  bus_.publish("STATE.v70", valid_message<vehicle_state_t>(1));
  drain();
  for (int i = 0; i < kChannels; ++i) EXPECT_THAT(received[static_cast<std::size_t>(i)], ElementsAre(i));
  EXPECT_EQ(twice, 1);
  EXPECT_EQ(bus_.counters().received, kChannels + 1);
  EXPECT_EQ(bus_.subscribed().size(), kChannels + 1u);
}

TEST_F(BusTest, AnotherTypeOfTheSameLengthIsRefused) {
  int received = 0;
  bus_.subscribe<vehicle_state_t>(channels::kState,
                                  [&](std::string_view, const vehicle_state_t&) { ++received; });
  auto bytes = encoded(valid_message<vehicle_state_t>(1));
  bytes[0] ^= 1;  // of the fingerprint
  publish_raw("STATE.a", bytes);
  drain();
  EXPECT_EQ(received, 0);
  EXPECT_EQ(bus_.counters().refused, 1);
}

TEST_F(BusTest, AnImpossibleMessageIsCountedAndIgnoredAndTheNextIsReceived) {
  int received = 0;
  bus_.subscribe<vehicle_state_t>(channels::kState,
                                  [&](std::string_view, const vehicle_state_t&) { ++received; });
  vehicle_state_t state = valid_message<vehicle_state_t>(1);
  state.position_ned_m[0] = std::numeric_limits<double>::quiet_NaN();
  bus_.publish("STATE.a", state);
  bus_.publish("STATE.a", valid_message<vehicle_state_t>(1));
  drain();
  EXPECT_EQ(received, 1);
  EXPECT_EQ(bus_.counters().refused, 1);
}

TEST_F(BusTest, ReportsARefusalWithChannelAndReasonFirstTenthAndHundredthTime) {
  set_log_level(LogLevel::kWarning);
  bus_.subscribe<vehicle_state_t>(channels::kState, [](std::string_view, const vehicle_state_t&) {});
  vehicle_state_t state = valid_message<vehicle_state_t>(1);
  state.vehicle_id = -1;
  ::testing::internal::CaptureStderr();
  for (int i = 0; i < 250; ++i) bus_.publish("STATE.a", state);
  drain();
  const std::string reports = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(reports.begin(), reports.end(), '\n'), 3) << reports;
  EXPECT_THAT(reports, HasSubstr("channel=STATE.a count=1 reason=\"vehicle_id is -1; allowed is 1 and up"));
  EXPECT_THAT(reports, HasSubstr("count=10 "));
  EXPECT_THAT(reports, HasSubstr("count=100 "));
  EXPECT_EQ(bus_.counters().refused, 250);
}

TEST_F(BusTest, RefusalsOfOneReasonAreOneKindWhateverTheNumbers) {
  set_log_level(LogLevel::kWarning);
  bus_.subscribe<vehicle_command_t>("COMMAND.a", [](const vehicle_command_t&) {});
  ::testing::internal::CaptureStderr();
  for (int i = 0; i < 500; ++i) {
    vehicle_command_t command = valid_message<vehicle_command_t>(1);
    command.rudder_rad = 10 + i;
    bus_.publish("COMMAND.a", command);
  }
  drain();
  const std::string reports = ::testing::internal::GetCapturedStderr();
  EXPECT_LE(std::count(reports.begin(), reports.end(), '\n'), 3) << reports;
}

TEST_F(BusTest, AChannelWithControlCharactersIsShownWithoutThem) {
  set_log_level(LogLevel::kWarning);
  bus_.subscribe<vehicle_state_t>(channels::kState, [](std::string_view, const vehicle_state_t&) {});
  ::testing::internal::CaptureStderr();
  bus_.publish("STATE.a\x1b[31mforged", valid_message<vehicle_state_t>(1));
  drain();
  const std::string reports = ::testing::internal::GetCapturedStderr();
  EXPECT_THAT(reports, HasSubstr("channel=STATE.a?[31mforged "));
}

TEST_F(BusTest, AHandlersExceptionIsKeptAndThrownOnce) {
  bus_.subscribe<sim_clock_t>(channels::kClock, [](const sim_clock_t&) { throw std::runtime_error("boom"); });
  bus_.publish(channels::kClock, valid_message<sim_clock_t>(1));
  EXPECT_NO_THROW(drain());
  EXPECT_THROW(bus_.rethrow_if_failed(), std::runtime_error);
  EXPECT_NO_THROW(bus_.rethrow_if_failed());
}

TEST_F(BusTest, AfterAFailureNothingMoreIsHandled) {
  int received = 0;
  bus_.subscribe<sim_clock_t>(channels::kClock, [&](const sim_clock_t&) {
    ++received;
    throw std::runtime_error("boom");
  });
  for (int i = 0; i < 3; ++i) bus_.publish(channels::kClock, valid_message<sim_clock_t>(1));
  drain();
  EXPECT_EQ(received, 1);
}

TEST_F(BusTest, ResultsThatGoOutAfterTheirInstantByTheClockCountAsLate) {
  const auto publish_at = [&](std::string_view channel, double utime_s) {
    auto state = valid_message<vehicle_state_t>(1);
    state.utime = SimTime::from_seconds(utime_s).to_utime();
    bus_.publish(channel, state);
  };
  std::optional<SimTime> now;
  bus_.lateness().set_clock([&] { return now; }, SimDuration::from_milliseconds(50));
  publish_at("STATE.a", 1);  // no time is known
  now = SimTime::from_seconds(30);
  for (const double utime_s : {5.1, 29.96, 30.0, 31.0}) publish_at("STATE.a", utime_s);
  for (const char* request :
       {"SEND.a", "SET_ENVIRONMENT", "FAULT.a", "STATUS.a", "HEARTBEAT.a", "REPAIR.STATE.a"})
    publish_at(request, 1);
  EXPECT_EQ(bus_.counters().late, 1);
  EXPECT_EQ(bus_.lateness().summary(SimTime()).max_s, 24.9);
  EXPECT_EQ(bus_.lateness().summary(SimTime()).p50_s, 0);
}

TEST_F(BusTest, CountsTheGapsOfASession) {
  bus_.subscribe<sim_clock_t>(channels::kClock, [](const sim_clock_t&) {});
  sim_clock_t clock = valid_message<sim_clock_t>(1);
  clock.session = 5;
  for (const std::int64_t sequence : {7, 8, 11, 11, 9, 12}) {
    clock.sequence = sequence;
    bus_.publish(channels::kClock, clock);
  }
  drain();
  EXPECT_EQ(bus_.counters().gaps, 2);  // 9 and 10, at the time of 11
}

TEST_F(BusTest, PacketsAreNumberedBySendersAndGapsAmongThemShow) {
  bus_.subscribe<modem_send_t>(channels::kSend, [](std::string_view, const modem_send_t&) {});
  modem_send_t send = valid_message<modem_send_t>(1);
  send.session = 9;
  for (const std::int64_t sequence : {1, 4}) {
    send.packet_sequence = sequence;
    bus_.publish("SEND.a", send);
  }
  drain();
  EXPECT_EQ(bus_.counters().gaps, 2);
}

TEST_F(BusTest, UnsubscribesWhenDestroyed) {
  int received = 0;
  {
    Bus brief(lcm_, {"brief", 1});
    brief.subscribe<sim_clock_t>(channels::kClock, [&](const sim_clock_t&) { ++received; });
  }
  bus_.publish(channels::kClock, valid_message<sim_clock_t>(1));
  drain();
  EXPECT_EQ(received, 0);
}

TEST_F(BusTest, ANodeHasAValidName) {
  EXPECT_THROW(Bus(lcm_, {"", 1}), InvalidArgument);
  EXPECT_THROW(Bus(lcm_, {"Node.1", 1}), InvalidArgument);
}

TEST_F(BusTest, MessagesPublishedInAHandlerFollowInOrder) {
  std::vector<std::int64_t> order;
  bus_.subscribe<sim_clock_t>(channels::kClock, [&](const sim_clock_t& m) {
    order.push_back(m.sequence);
    sim_clock_t next = m;
    next.sequence += 10;
    if (m.sequence < 10) bus_.publish(channels::kClock, next);
  });
  sim_clock_t clock = valid_message<sim_clock_t>(1);
  for (const std::int64_t sequence : {1, 2}) {
    clock.sequence = sequence;
    bus_.publish(channels::kClock, clock);
  }
  drain();
  EXPECT_THAT(order, ElementsAre(1, 2, 11, 12));
}

// Random bytes, and valid messages with random bytes changed: each is either delivered or counted, none ends
// us.
TEST_F(BusTest, NoBytesOnAnyChannelCauseAFailure) {
  const auto subscribe = [&](auto message, const char* channel) {
    using Message = decltype(message);
    bus_.subscribe<Message>(channel, [](const Message&) {});
  };
  subscribe(sim_clock_t(), "C0");
  subscribe(vehicle_state_t(), "C1");
  subscribe(environment_t(), "C2");
  subscribe(modem_send_t(), "C3");
  subscribe(link_query_t(), "C4");
  subscribe(link_reply_t(), "C5");
  subscribe(ray_query_t(), "C6");
  subscribe(ray_reply_t(), "C7");
  subscribe(node_status_t(), "C8");
  subscribe(link_table_t(), "C9");
  const std::vector<std::vector<std::uint8_t>> samples{
      encoded(valid_message<sim_clock_t>(1)),   encoded(valid_message<vehicle_state_t>(2)),
      encoded(valid_message<environment_t>(3)), encoded(valid_message<modem_send_t>(4)),
      encoded(valid_message<link_query_t>(1)),  encoded(valid_message<link_reply_t>(2)),
      encoded(valid_message<ray_query_t>(3)),   encoded(valid_message<ray_reply_t>(4)),
      encoded(valid_message<node_status_t>(1)), encoded(valid_message<link_table_t>(2))};
  std::mt19937 random(7);
  constexpr int kRounds = 20'000;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::uint8_t> bytes = samples[random() % samples.size()];
    if (round % 3 == 0) bytes.assign(random() % 200, 0);
    for (int i = 0; i < 8 && !bytes.empty(); ++i)
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    publish_raw("C" + std::to_string(random() % 10), bytes);
    drain();
  }
  EXPECT_NO_THROW(bus_.rethrow_if_failed());
  EXPECT_EQ(bus_.counters().received + bus_.counters().refused, kRounds);
}

}  // namespace
}  // namespace halocline::bus
