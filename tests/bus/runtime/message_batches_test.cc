// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/message_batches.h"

#include <gtest/gtest.h>

namespace halocline::bus {
namespace {

constexpr SimDuration kMillisecond = SimDuration::from_milliseconds(1);

// The wait after a second in which `count` messages come every millisecond.
SimDuration wait_after(MessageBatches& batches, SimTime& steady, int count) {
  for (int i = 0; i < 1000; ++i) {
    steady = steady + kMillisecond;
    batches.wait_at(steady);
    batches.note_handled(count);
  }
  return batches.wait_at(steady);
}

TEST(MessageBatches, FewMessagesAreHandledAtOnce) {
  MessageBatches batches;
  SimTime steady;
  EXPECT_EQ(wait_after(batches, steady, 2), SimDuration());
}

TEST(MessageBatches, ManyGather) {
  MessageBatches batches;
  SimTime steady;
  EXPECT_EQ(wait_after(batches, steady, 4), MessageBatches::kBatch);
}

TEST(MessageBatches, AfterSilenceTheFirstIsHandledAtOnce) {
  MessageBatches batches;
  SimTime steady;
  EXPECT_GT(wait_after(batches, steady, 50), SimDuration());
  steady = steady + SimDuration::from_seconds(10);
  EXPECT_EQ(batches.wait_at(steady), SimDuration());
}

TEST(MessageBatches, ABurstOnceInAWhileIsNotBusy) {
  MessageBatches batches;
  SimTime steady;
  for (int i = 0; i < 100; ++i) {
    steady = steady + SimDuration::from_seconds(1);
    EXPECT_EQ(batches.wait_at(steady), SimDuration());
    batches.note_handled(1000);
  }
}

}  // namespace
}  // namespace halocline::bus
