// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <functional>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/messages/messages.h"
#include "bus/transport/subscription.h"

namespace halocline::bus {
namespace {

class Newest : public ::testing::Test {
 protected:
  void receive(std::int64_t session, std::int64_t sequence, std::int64_t utime) {
    vehicle_sensors_t message{};
    message.session = session;
    message.sequence = sequence;
    message.utime = utime;
    handle_(message);
  }
  std::vector<std::int64_t> utimes_;
  std::function<void(const vehicle_sensors_t&)> handle_ =
      newest<vehicle_sensors_t>([this](const vehicle_sensors_t& m) { utimes_.push_back(m.utime); });
};

TEST_F(Newest, WhatRepairBringsLateChangesNothing) {
  receive(1, 0, 0);
  receive(1, 2, 200);
  receive(1, 1, 100);
  receive(1, 3, 300);
  EXPECT_THAT(utimes_, ::testing::ElementsAre(0, 200, 300));
}

TEST_F(Newest, ARestartedPublisherBeginsAnew) {
  receive(1, 50, 5000);
  receive(2, 0, 6000);
  receive(2, 1, 6100);
  EXPECT_THAT(utimes_, ::testing::ElementsAre(5000, 6000, 6100));
}

TEST_F(Newest, OfAPublisherWithoutNumbersEveryMessageCounts) {
  receive(0, 0, 100);
  receive(0, 0, 90);
  EXPECT_THAT(utimes_, ::testing::ElementsAre(100, 90));
}

}  // namespace
}  // namespace halocline::bus
