// SPDX-License-Identifier: BSD-3-Clause
#include "bus/logs/log_contents.h"

#include <cstdint>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/logs/log_reader.h"
#include "bus/messages/message_codec.h"
#include "core/check.h"
#include "tests/bus/logs/log_fixture.h"
#include "tests/bus/messages_for_tests.h"

namespace halocline::clients {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::TemporaryLog;

constexpr std::int64_t kSecond = 1'000'000;

// A minute of vehicles 1, 2, ... that are 1400 m apart, of which 1 sends.
class LogContentsTest : public ::testing::Test {
 protected:
  template <class Message>
  void add(std::int64_t at, const std::string& channel, const Message& message) {
    file_.add(at, channel, message);
  }
  void add_another_version(std::int64_t at, const std::string& channel, const packet_outcome_t& message) {
    auto bytes = bus::encoded(message);
    bytes[0] ^= 0x55;
    file_.add_bytes(at, channel, bytes);
  }
  void states(std::int32_t vehicles, std::int64_t at) {
    for (std::int32_t id = 1; id <= vehicles; ++id) {
      auto state = testing::state_at(at, 1400.0 * id);
      state.vehicle_id = id;
      add(at, "STATE.v" + std::to_string(id), state);
    }
  }
  void receipt(std::int64_t sequence, std::int64_t at, std::int8_t result = modem_receipt_t::ACCEPTED) {
    auto receipt = bus::testing::valid_message<modem_receipt_t>(1);
    receipt.utime = receipt.start_utime = at;
    receipt.session = receipt.sequence = 0;
    receipt.send_session = 7;
    receipt.packet_sequence = sequence;
    receipt.receipt_result = result;
    receipt.duration_s = 1;
    add(at, "RECEIPT.v1", receipt);
  }
  static packet_outcome_t outcome(std::int64_t sequence, std::int64_t departure, std::int32_t receiver) {
    auto outcome = bus::testing::valid_message<packet_outcome_t>(1);
    outcome.utime = departure + 2 * kSecond;
    outcome.session = outcome.sequence = 0;
    outcome.send_session = 7;
    outcome.packet_sequence = sequence;
    outcome.source_id = 1;
    outcome.receiver_id = receiver;
    outcome.num_receivers = 1;
    outcome.departure_utime = departure;
    outcome.duration_s = 1;
    return outcome;
  }
  // A packet every five seconds until 50 s, with the outcomes that `add_outcomes(sequence, departure)` adds.
  template <class Function>
  void run(std::int32_t vehicles, Function&& add_outcomes) {
    for (std::int64_t s = 0; s <= 60; ++s) {
      states(vehicles, s * kSecond);
      if (s % 5 != 0 || s == 0 || s > 50) continue;
      receipt(s / 5, s * kSecond);
      add_outcomes(s / 5, s * kSecond);
    }
  }
  std::string report() {
    LogReader log(file_.path());
    while (log.next(event_)) {
    }
    std::ostringstream out;
    is_whole_ = report_damage(out, log);
    missing_ = log.contents().missing();
    return out.str();
  }

  TemporaryLog file_;
  LoggedEvent event_;
  PacketAccount::Missing missing_;
  bool is_whole_ = false;
};

TEST_F(LogContentsTest, OfALogWithAllOutcomesThereIsNothingToReport) {
  run(3, [&](std::int64_t sequence, std::int64_t at) {
    for (const std::int32_t receiver : {2, 3}) add(at, "OUTCOME", outcome(sequence, at, receiver));
  });
  EXPECT_EQ(report(), "");
  EXPECT_TRUE(is_whole_);
  EXPECT_EQ(missing_.accepted, 10);
}

TEST_F(LogContentsTest, OutcomesOfAnotherVersionLeavePacketsWithoutOne) {
  run(3, [&](std::int64_t sequence, std::int64_t at) {
    for (const std::int32_t receiver : {2, 3})
      add_another_version(at, "OUTCOME", outcome(sequence, at, receiver));
  });
  EXPECT_EQ(report(),
            "halocline: 10 accepted packets have no outcome; 20 events on OUTCOME are of another version\n");
  EXPECT_FALSE(is_whole_);
}

TEST_F(LogContentsTest, PacketsOfALogWithoutOutcomesHaveNone) {
  run(2, [](std::int64_t, std::int64_t) {});
  EXPECT_EQ(report(), "halocline: 10 accepted packets have no outcome\n");
}

TEST_F(LogContentsTest, AReceiverWithoutItsOutcomeIsCounted) {
  run(3, [&](std::int64_t sequence, std::int64_t at) {
    add(at, "OUTCOME", outcome(sequence, at, 2));
    if (sequence > 4) add(at, "OUTCOME", outcome(sequence, at, 3));
  });
  EXPECT_THAT(report(), HasSubstr("4 outcomes are not there of 4 accepted packets that have others"));
  EXPECT_FALSE(is_whole_);
}

TEST_F(LogContentsTest, ARowForSeveralStandsForAllOfThem) {
  run(4, [&](std::int64_t sequence, std::int64_t at) {
    add(at, "OUTCOME", outcome(sequence, at, 1 + static_cast<std::int32_t>(sequence % 3) + 1));
    auto others = outcome(sequence, at, 0);
    others.num_receivers = 2;
    others.outcome = packet_outcome_t::OUT_OF_REACH;
    add(at, "OUTCOME", others);
  });
  EXPECT_EQ(report(), "");
}

TEST_F(LogContentsTest, ARepeatedOutcomeStandsForNoOther) {
  run(3, [&](std::int64_t sequence, std::int64_t at) {
    add(at, "OUTCOME", outcome(sequence, at, 2));
    add(at, sequence == 3 ? "REPAIR.OUTCOME" : "OUTCOME", outcome(sequence, at, sequence == 3 ? 2 : 3));
  });
  EXPECT_THAT(report(), HasSubstr("1 outcomes are not there of 1 accepted packets"));
}

TEST_F(LogContentsTest, APacketUnderWayAtTheEndIsNoFault) {
  run(2, [&](std::int64_t sequence, std::int64_t at) { add(at, "OUTCOME", outcome(sequence, at, 2)); });
  receipt(20, 59 * kSecond);
  EXPECT_EQ(report(), "");
  EXPECT_EQ(missing_.under_way, 1);
}

TEST_F(LogContentsTest, TwoRunsInOneLogAreJudgedEachByItself) {
  for (int repetition = 0; repetition < 2; ++repetition) {
    add(0, "CLOCK", testing::clock_at(0));
    run(2 + repetition, [&](std::int64_t sequence, std::int64_t at) {
      for (std::int32_t receiver = 2; receiver <= 2 + repetition; ++receiver)
        add(at, "OUTCOME", outcome(sequence, at, receiver));
    });
    receipt(20, 59 * kSecond);
    add(60 * kSecond, "CLOCK", testing::clock_at(60 * kSecond));
  }
  EXPECT_EQ(report(), "");
  EXPECT_EQ(missing_.accepted, 22);
  EXPECT_EQ(missing_.under_way, 2);
}

TEST_F(LogContentsTest, RefusedPacketsNeedNoOutcome) {
  run(2, [&](std::int64_t sequence, std::int64_t at) { add(at, "OUTCOME", outcome(sequence, at, 2)); });
  receipt(20, 30 * kSecond, modem_receipt_t::REFUSED_BUSY);
  EXPECT_EQ(report(), "");
}

TEST_F(LogContentsTest, AVehicleAloneOrWithoutAModemNeedsNone) {
  link_table_t links{};
  links.vehicle_id = 1;
  add(0, "LINKS.v1", links);
  run(3, [](std::int64_t, std::int64_t) {});
  EXPECT_EQ(report(), "");
}

TEST_F(LogContentsTest, AVehicleThatIsSilentAtTheDepartureNeedsNone) {
  run(2, [&](std::int64_t sequence, std::int64_t at) { add(at, "OUTCOME", outcome(sequence, at, 2)); });
  for (const std::int64_t s : {1, 2, 58}) {  // a third one, with a modem, published nothing meanwhile
    auto state = testing::state_at(s * kSecond);
    state.vehicle_id = 3;
    add(s * kSecond, "STATE.v3", state);
  }
  add(58 * kSecond, "OUTCOME", outcome(0, 2 * kSecond, 3));
  EXPECT_EQ(report(), "");
}

TEST_F(LogContentsTest, TheFirstEventThatCannotBeReadIsNamedWithItsPlaceAndReason) {
  auto state = testing::state_at(0);
  state.position_ned_m[2] = 1e9;
  add(0, "STATE.v1", testing::state_at(0));
  add(1, "STATE.v1", state);
  add(2, "STATE.v1", state);
  EXPECT_THAT(report(), AllOf(HasSubstr("2 events on STATE.v1 cannot be read, the first at "),
                              HasSubstr(", byte "), HasSubstr("position_ned_m is 1e+09; allowed is")));
  EXPECT_FALSE(is_whole_);
}

TEST_F(LogContentsTest, WhatAVehicleOfOthersLeavesOutIsNoFault) {
  auto state = testing::state_at(kSecond);
  state.vehicle_id = 0;
  state.orientation_wxyz[0] = 0;
  add(0, "STATE.v1", state);
  EXPECT_EQ(report(), "");
}

TEST_F(LogContentsTest, NamesThatAreNotOursAreListed) {
  add(0, "STATE.v1", testing::state_at(0));
  for (const std::string channel : {"STATE.AUV 1", "STATE.AUV 1", "STATE", "OUTCOME.v1"})
    add(0, channel, testing::state_at(0));
  add(0, "CAMERA", testing::state_at(0));  // another program's
  EXPECT_THAT(report(), AllOf(HasSubstr("channels that are not ours"),
                              HasSubstr("OUTCOME.v1 (1 event), STATE (1 event), STATE.AUV 1 (2 events)\n")));
  EXPECT_FALSE(is_whole_);
}

TEST_F(LogContentsTest, ALogOfOtherProgramsHoldsNothingOfOurs) {
  for (int i = 0; i < 3; ++i) add(i, "POSE", testing::state_at(0));
  EXPECT_THAT(report(), HasSubstr("no event is on a channel of Halocline's: POSE (3 events)\n"));
  EXPECT_FALSE(is_whole_);
}

TEST_F(LogContentsTest, NanosecondsAreToldFromMicroseconds) {
  for (std::int64_t s = 1; s <= 60; ++s) {
    add(s * kSecond * 1000, "STATE.v1", testing::state_at(s * kSecond));
    add(s * kSecond, "STATE.v2", testing::state_at(s * kSecond * 1000));
    add(s * kSecond, "STATE.v3", testing::state_at(s * kSecond));
  }
  EXPECT_THAT(
      report(),
      AllOf(HasSubstr("stamped in nanoseconds, where logs have microseconds: on STATE.v1 (60 events)"),
            HasSubstr("utime in nanoseconds, where it is microseconds: on STATE.v2 (60 events)")));
  EXPECT_FALSE(is_whole_);
}

TEST_F(LogContentsTest, AnotherClockThanThatOfTheStampsIsNoFault) {
  constexpr std::int64_t kUnix_us = 1'795'000'000 * kSecond;
  for (std::int64_t s = 1; s <= 60; ++s) {
    add(kUnix_us + s * kSecond, "STATE.v1", testing::state_at(s * kSecond));
    add(kUnix_us + s * kSecond / 1000, "STATE.v2",
        testing::state_at(s * kSecond));  // a thousand times real time
  }
  EXPECT_EQ(report(), "");
}

TEST_F(LogContentsTest, UnixTimeInNanosecondsIsBeyondACentury) {
  add(kSecond, "STATE.v1", testing::state_at(1'795'000'000'000'000'000));
  EXPECT_THAT(report(), AllOf(HasSubstr("utime is 1.795e+18"), HasSubstr("nanoseconds in the place of")));
}

TEST_F(LogContentsTest, ALogWhoseStampsAreBeyondACenturyIsRefusedInWords) {
  for (int i = 0; i < 3; ++i) add(1'795'000'000'000'000'000 + i, "STATE.v1", testing::state_at(kSecond));
  try {
    LogReader log(file_.path());
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("its 3 events are stamped"), HasSubstr("1795000000000000000"),
                                    HasSubstr("nanoseconds")));
  }
}

TEST_F(LogContentsTest, ACompressedLogIsRefusedInWords) {
  file_.replace_bytes(std::string("\x1F\x8B\x08\x00", 4) + "anything");
  try {
    LogReader log(file_.path());
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), HasSubstr("compressed by gzip"));
  }
}

}  // namespace
}  // namespace halocline::clients
