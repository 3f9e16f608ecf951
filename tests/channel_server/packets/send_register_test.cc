// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/packets/send_register.h"

#include <gtest/gtest.h>

#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;
using testing::for_s;
using testing::request_of;

TEST(SendRegister, APacketIsNewOnce) {
  SendRegister sends;
  EXPECT_TRUE(sends.enter(request_of(1, 10, 5)));
  EXPECT_FALSE(sends.enter(request_of(1, 10, 5)));
  EXPECT_TRUE(sends.enter(request_of(1, 10, 6)));
  EXPECT_TRUE(sends.enter(request_of(2, 10, 5)));
}

TEST(SendRegister, ASenderWithoutSessionIsDistinguishedByTheStartAsWell) {
  SendRegister sends;
  SendRequest first = request_of(1, 10, 0), second = request_of(1, 11, 0);
  first.session = second.session = 0;
  EXPECT_TRUE(sends.enter(first));
  EXPECT_FALSE(sends.enter(first));
  EXPECT_TRUE(sends.enter(second));
}

TEST(SendRegister, ASenderWithASessionMayNotReuseANumber) {
  SendRegister sends;
  EXPECT_TRUE(sends.enter(request_of(1, 10, 0)));
  EXPECT_FALSE(sends.enter(request_of(1, 11, 0)));
}

TEST(SendRegister, AModemThatQueuesIsFreeWhenAllBeforeHaveEnded) {
  SendRegister sends;
  EXPECT_EQ(sends.free_from("v1", at_s(10)), at_s(10));
  sends.occupy("v1", at_s(10), for_s(1));
  sends.occupy("v1", at_s(11), for_s(2));
  EXPECT_EQ(sends.free_from("v1", at_s(10.5)), at_s(13));
  EXPECT_EQ(sends.free_from("v1", at_s(14)), at_s(14));
  EXPECT_EQ(sends.free_from("v2", at_s(10.5)), at_s(10.5));
  EXPECT_EQ(sends.waiting_at("v1", at_s(10.5)), 1u);
  EXPECT_EQ(sends.waiting_at("v1", at_s(11)), 0u);
}

TEST(SendRegister, AReceiptIsKeptOnceDecided) {
  SendRegister sends;
  const SendRequest request = request_of(1, 10, 5);
  EXPECT_TRUE(sends.enter(request));
  EXPECT_EQ(sends.receipt_of(request), nullptr);
  sends.decide(request, {.vehicle = "v1", .result = SendResult::kBusy});
  ASSERT_NE(sends.receipt_of(request), nullptr);
  EXPECT_EQ(sends.receipt_of(request)->result, SendResult::kBusy);
}

TEST(SendRegister, AModemIsBusyWhileItTransmits) {
  SendRegister sends;
  sends.occupy("v1", at_s(10), for_s(2));
  EXPECT_TRUE(sends.is_busy("v1", at_s(10), for_s(0)));
  EXPECT_TRUE(sends.is_busy("v1", at_s(11.999), for_s(1)));
  EXPECT_TRUE(sends.is_busy("v1", at_s(9), for_s(1.001)));
  EXPECT_FALSE(sends.is_busy("v1", at_s(9), for_s(1)));
  EXPECT_FALSE(sends.is_busy("v1", at_s(12), for_s(1)));
  EXPECT_FALSE(sends.is_busy("v2", at_s(11), for_s(1)));
}

TEST(SendRegister, TwoPacketsWithoutDurationDoNotStartTogether) {
  SendRegister sends;
  sends.occupy("v1", at_s(10), for_s(0));
  EXPECT_TRUE(sends.is_busy("v1", at_s(10), for_s(0)));
  EXPECT_FALSE(sends.is_busy("v1", at_s(10.001), for_s(0)));
}

TEST(SendRegister, OfOldPacketsTheLatestTenThousandStayKnown) {
  SendRegister sends;
  constexpr int kAll = 12'000;
  for (int i = 0; i < kAll; ++i) EXPECT_TRUE(sends.enter(request_of(1, 0.01 * i, i)));
  sends.forget_before(at_s(10));
  EXPECT_EQ(sends.size(), std::size_t{kAll} - 1000);
  sends.forget_before(at_s(0.01 * kAll));
  EXPECT_EQ(sends.size(), SendRegister::kMaxOld);
  EXPECT_FALSE(sends.enter(request_of(1, 0.01 * (kAll - 1), kAll - 1)));
}

TEST(SendRegister, OldPacketsStayKnownForTenMinutes) {
  SendRegister sends;
  for (int i = 0; i < 2000; ++i) EXPECT_TRUE(sends.enter(request_of(1, i, i)));
  sends.forget_before(at_s(2000));
  EXPECT_EQ(sends.size(), 600u);  // those of 1400 s and later
  EXPECT_FALSE(sends.enter(request_of(1, 1400, 1400)));
}

TEST(SendRegister, AFloodDoesNotGrowMemoryWithoutBound) {
  SendRegister sends;
  for (std::size_t i = 0; i < SendRegister::kMaxPackets + 100; ++i) {
    EXPECT_TRUE(sends.enter(request_of(1, 0.001 * static_cast<double>(i), static_cast<std::int64_t>(i))));
  }
  EXPECT_EQ(sends.size(), SendRegister::kMaxPackets);
}

}  // namespace
}  // namespace halocline::channel_server
