// SPDX-License-Identifier: BSD-3-Clause
#include "bus/repair/session_watch.h"

#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "bus/transport/node_identity.h"
#include "tests/support/at_ms.h"

namespace halocline::bus {
namespace {

using halocline::testing::at_ms;

TEST(SessionWatch, OfTwoNodesOfOneNameTheFirstIsAcceptedAndTheOtherRefusedOnEveryChannel) {
  SessionWatch watch;
  for (int ms = 0; ms < 10'000; ms += 250) {
    EXPECT_TRUE(watch.on_heartbeat(at_ms(ms), "vehicle-sim", 1));
    EXPECT_FALSE(watch.on_heartbeat(at_ms(ms + 100), "vehicle-sim", 2));
    EXPECT_TRUE(watch.on_message(at_ms(ms + 110), "SENSORS.auv-1", 1));
    EXPECT_FALSE(watch.on_message(at_ms(ms + 120), "SENSORS.auv-1", 2));
  }
}

TEST(SessionWatch, ARestartedNodeIsAcceptedAfterASecondOfSilence) {
  SessionWatch watch;
  watch.on_heartbeat(at_ms(0), "vehicle-sim", 1);
  EXPECT_FALSE(watch.on_heartbeat(at_ms(700), "vehicle-sim", 2));
  EXPECT_FALSE(watch.on_message(at_ms(900), "STATE.auv-1", 2));
  EXPECT_TRUE(watch.on_heartbeat(at_ms(1000), "vehicle-sim", 2));
  EXPECT_TRUE(watch.on_message(at_ms(1001), "STATE.auv-1", 2));
  EXPECT_FALSE(watch.on_heartbeat(at_ms(1100), "vehicle-sim", 1));  // it was not dead
}

TEST(SessionWatch, AChannelOfAVehicleHasOnePublisherWhateverTheNodesAreCalled) {
  SessionWatch watch;
  for (int ms = 0; ms < 10'000; ms += 500) {
    for (const char* channel : {"STATE.auv-1", "RECEIPT.auv-1", "RECEIVE.auv-1"}) {
      EXPECT_TRUE(watch.on_message(at_ms(ms), channel, 1));
      EXPECT_FALSE(watch.on_message(at_ms(ms + 1), channel, 2));
      EXPECT_FALSE(watch.on_message(at_ms(ms + 2), channel, 0));  // without a session
    }
    EXPECT_TRUE(watch.on_message(at_ms(ms), "STATE.auv-2", 2));
    EXPECT_TRUE(watch.on_message(at_ms(ms), "SEND.auv-1", 2));  // several programs may use a modem
  }
}

// Shard 1 has the receivers 1 and 3, shard 2 those with even ids. A second server under another name, 9,
// decides for all of them, and its rows of those out of reach (receiver 0) come first.
TEST(SessionWatch, OutcomesOfAReceiverHaveOnePublisherAndShardsShareTheReceivers) {
  SessionWatch watch;
  const auto outcome = [&](int ms, std::int64_t session, std::int32_t receiver) {
    return watch.on_message(at_ms(ms), "OUTCOME", session, receiver);
  };
  for (int ms = 0; ms < 60'000; ms += 250) {
    watch.on_heartbeat(at_ms(ms), "channel-server-0", 1);
    watch.on_heartbeat(at_ms(ms), "channel-server-1", 2);
    watch.on_heartbeat(at_ms(ms), "other", 9);
    EXPECT_TRUE(outcome(ms, 1, 0));
    EXPECT_TRUE(outcome(ms, 2, 0));
    EXPECT_EQ(outcome(ms + 1, 9, 0), ms == 0);  // it has not decided for anybody yet
    EXPECT_TRUE(outcome(ms + 2, 1, 1));
    EXPECT_TRUE(outcome(ms + 2, 1, 3));
    EXPECT_TRUE(outcome(ms + 2, 2, 2));
    for (const std::int32_t receiver : {1, 2, 3}) EXPECT_FALSE(outcome(ms + 3, 9, receiver));
  }
  // Once a shard is gone for a second, another may have its receivers, and rows of several.
  EXPECT_FALSE(outcome(60'700, 9, 2));
  EXPECT_TRUE(outcome(60'752, 9, 2));
  EXPECT_TRUE(outcome(60'753, 9, 0));
}

// States by dead reckoning may be minutes apart.
TEST(SessionWatch, HeartbeatsKeepAChannelThatIsSeldomPublishedOn) {
  SessionWatch watch;
  watch.on_message(at_ms(0), "STATE.auv-1", 1);
  for (int ms = 0; ms <= 60'000; ms += 250) watch.on_heartbeat(at_ms(ms), "vehicle-sim", 1);
  EXPECT_FALSE(watch.on_message(at_ms(60'100), "STATE.auv-1", 2));
  EXPECT_TRUE(watch.on_message(at_ms(61'100), "STATE.auv-1", 2));
}

// HEARTBEAT.vehicle-sim with the session of the channel server.
TEST(SessionWatch, AForgedClaimToANameSilencesNoOther) {
  SessionWatch watch;
  watch.on_heartbeat(at_ms(0), "vehicle-sim", 1);
  watch.on_heartbeat(at_ms(0), "channel-server", 2);
  EXPECT_FALSE(watch.on_heartbeat(at_ms(10), "vehicle-sim", 2));
  EXPECT_TRUE(watch.on_message(at_ms(20), "OUTCOME", 2));
  EXPECT_TRUE(watch.on_heartbeat(at_ms(250), "channel-server", 2));
}

// The log of an earlier run, played onto this one: it begins with the first steps of the programs of then.
TEST(SessionWatch, AStatusIsAClaimToItsNameAndPacketsOfADuplicateAreRefusedWithIt) {
  SessionWatch watch;
  const auto packets_of = [](std::int64_t session) {
    return session_of(static_cast<std::uint64_t>(session), "auv-1");
  };
  EXPECT_TRUE(watch.on_message(at_ms(0), "STATUS.traffic", 1));
  for (int ms = 100; ms < 10'000; ms += 1000) {
    EXPECT_TRUE(watch.on_message(at_ms(ms - 50), "STATUS.traffic", 1));
    EXPECT_FALSE(watch.on_message(at_ms(ms), "STATUS.traffic", 9));
    for (const int later_ms : {1, 900}) {
      EXPECT_FALSE(watch.on_message(at_ms(ms + later_ms), "SEND.auv-1", packets_of(9)));
      EXPECT_FALSE(watch.on_message(at_ms(ms + later_ms), "LISTEN.auv-1", packets_of(9)));
      EXPECT_TRUE(watch.on_message(at_ms(ms + later_ms), "SEND.auv-1", packets_of(1)));
      EXPECT_TRUE(watch.on_message(at_ms(ms + later_ms), "SEND.auv-1", 5));  // its program has no STATUS
    }
    watch.on_heartbeat(at_ms(ms + 500), "traffic", 1);
  }
}

TEST(SessionWatch, NamesWithoutEndDoNotForgetThoseThatAreAccepted) {
  SessionWatch watch;
  EXPECT_TRUE(watch.on_message(at_ms(0), "STATE.auv-1", 1));
  for (std::int64_t i = 0; i < 50'000; ++i) {
    EXPECT_TRUE(watch.on_message(at_ms(1), "STATE.x" + std::to_string(i), i));
    watch.on_heartbeat(at_ms(1), "n" + std::to_string(i), i);
    watch.on_heartbeat(at_ms(1), "n0", 100'000 + i);
  }
  EXPECT_FALSE(watch.on_message(at_ms(2), "STATE.auv-1", 2));
  EXPECT_TRUE(watch.on_message(at_ms(2), "STATE.auv-1", 1));
}

}  // namespace
}  // namespace halocline::bus
