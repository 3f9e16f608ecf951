// SPDX-License-Identifier: BSD-3-Clause
#include "bus/numbered_publisher.h"

#include <vector>

#include <gtest/gtest.h>

namespace halocline::bus {
namespace {

class NumberedPublisherTest : public ::testing::Test {
 protected:
  std::int64_t next_on(const std::string& channel) {
    node_status_t message{};
    publisher_.number(channel, message);
    session_ = message.session;
    return message.sequence;
  }

  lcm::LCM lcm_{"memq://"};
  Bus bus_{lcm_, {"publisher", 77}};
  NumberedPublisher publisher_{bus_};
  std::int64_t session_ = 0;
};

TEST_F(NumberedPublisherTest, PublishesWithTheSessionAndTheNextNumberOfTheChannel) {
  std::vector<std::pair<std::int64_t, std::int64_t>> received;
  Bus receiver(lcm_, {"receiver", 1});
  receiver.subscribe<packet_outcome_t>(channels::kOutcome, [&](const packet_outcome_t& message) {
    received.emplace_back(message.session, message.sequence);
  });
  packet_outcome_t outcome{};
  outcome.num_receivers = 1;
  outcome.source_id = outcome.receiver_id = 1;
  for (int i = 0; i < 2; ++i) {
    publisher_.publish(channels::kOutcome, outcome);
    lcm_.handleTimeout(0);
  }
  EXPECT_EQ(received, (std::vector<std::pair<std::int64_t, std::int64_t>>{{77, 0}, {77, 1}}));
}

TEST_F(NumberedPublisherTest, CountsEachChannelByItself) {
  EXPECT_EQ(next_on("STATE.a"), 0);
  EXPECT_EQ(next_on("STATE.a"), 1);
  EXPECT_EQ(next_on("STATE.b"), 0);
  EXPECT_EQ(next_on("STATE.a"), 2);
}

TEST_F(NumberedPublisherTest, AResumedChannelGoesOnInItsSession) {
  publisher_.resume("STATE.a", 5, 41);
  EXPECT_EQ(next_on("STATE.a"), 42);
  EXPECT_EQ(session_, 5);
  EXPECT_EQ(next_on("STATE.b"), 0);
  EXPECT_EQ(session_, 77);
}

TEST_F(NumberedPublisherTest, NamesMadeUpWithoutEndDoNotRenumberAChannelInUse) {
  std::int64_t expected = 0;
  for (std::size_t i = 0; i < 2 * NumberedPublisher::kMaxChannels; ++i) {
    next_on("RECEIPT." + std::to_string(i));
    if (i % 1000 == 0) {
      EXPECT_EQ(next_on("OUTCOME"), expected++);
    }
  }
  EXPECT_EQ(next_on("RECEIPT.0"), 0) << "longest unused, so started again at 0";
}

}  // namespace
}  // namespace halocline::bus
