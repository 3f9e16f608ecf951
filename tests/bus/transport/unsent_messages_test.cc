// SPDX-License-Identifier: BSD-3-Clause
#include "bus/transport/unsent_messages.h"

#include <cstddef>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/at_ms.h"

namespace halocline::bus {
namespace {

using halocline::testing::at_ms;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class UnsentMessagesTest : public ::testing::Test {
 protected:
  void keep(int ms, const std::string& channel) { unsent_.keep(at_ms(ms), channel, "x", 1); }
  std::vector<std::string> sent_at(int ms, std::size_t taken) {
    std::vector<std::string> sent;
    unsent_.send(at_ms(ms), [&](const std::string& channel, const void*, std::size_t) {
      if (sent.size() == taken) return false;
      sent.push_back(channel);
      return true;
    });
    return sent;
  }
  UnsentMessages unsent_;
};

TEST_F(UnsentMessagesTest, AreSentInOrderAsTheNetworkTakesThem) {
  for (const char* channel : {"a", "b", "c"}) keep(0, channel);
  EXPECT_EQ(unsent_.next_due(), at_ms(20));
  EXPECT_THAT(sent_at(20, 0), IsEmpty());
  EXPECT_EQ(unsent_.next_due(), at_ms(40));
  EXPECT_THAT(sent_at(343, 2), ElementsAre("a", "b"));
  EXPECT_THAT(sent_at(363, 9), ElementsAre("c"));
  EXPECT_EQ(unsent_.next_due(), SimTime::never());
}

TEST_F(UnsentMessagesTest, AreForgottenAfterTenSeconds) {
  keep(0, "old");
  keep(5000, "new");
  EXPECT_THAT(sent_at(10'000, 0), IsEmpty());
  EXPECT_THAT(sent_at(10'001, 9), ElementsAre("new"));
}

TEST_F(UnsentMessagesTest, TakeNoMoreThanTheirBound) {
  const std::vector<char> large(1 << 20);
  for (int i = 0; i < 100; ++i) unsent_.keep(at_ms(i), std::to_string(i), large.data(), large.size());
  EXPECT_THAT(sent_at(200, 100), ElementsAre("96", "97", "98", "99"));
}

}  // namespace
}  // namespace halocline::bus
