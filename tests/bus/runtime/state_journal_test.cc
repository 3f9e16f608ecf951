#include "bus/runtime/state_journal.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/bus/runtime/journal_files.h"

namespace halocline::bus {
namespace {

using State = std::vector<std::uint8_t>;

class StateJournalTest : public ::testing::Test {
 protected:
  StateJournalTest() {
    const auto journal = files_.open();
    EXPECT_FALSE(journal->inherited().has_value());
    journal->write(7, SimTime::from_seconds(1), State(1000, 1));
    journal->write(7, SimTime::from_seconds(2), State(10, 2));
    journal->write(7, SimTime::from_seconds(3), State(20, 3));  // into the first file again
  }
  testing::JournalFiles files_;
};

TEST_F(StateJournalTest, TheLatestStateIsInherited) {
  const auto inherited = files_.open()->inherited();
  ASSERT_TRUE(inherited.has_value());
  EXPECT_EQ(inherited->session, 7);
  EXPECT_EQ(inherited->at, SimTime::from_seconds(3));
  EXPECT_EQ(inherited->state, State(20, 3));
}

TEST_F(StateJournalTest, TheNextIncarnationWritesOn) {
  files_.open()->write(7, SimTime::from_seconds(4), State(30, 4));
  files_.open()->write(7, SimTime::from_seconds(5), State(40, 5));
  EXPECT_EQ(files_.open()->inherited()->state, State(40, 5));
}

// As a kill in the middle of a write may leave it.
TEST_F(StateJournalTest, AWriteThatWasCutOffLeavesTheStateBefore) {
  for (const std::uintmax_t size : {0, 8, 60}) {
    std::filesystem::resize_file(files_.file(0), size);
    EXPECT_EQ(files_.open()->inherited()->state, State(10, 2)) << size;
  }
}

TEST_F(StateJournalTest, AStateOfWhichAByteChangedIsNotTakenUp) {
  std::fstream(files_.file(0), std::ios::in | std::ios::out | std::ios::binary).seekp(60).put('x');
  EXPECT_EQ(files_.open()->inherited()->state, State(10, 2));
}

TEST_F(StateJournalTest, AStateOfAnotherConfigurationIsNotTakenUp) {
  EXPECT_FALSE(files_.open(2)->inherited().has_value());
}

TEST_F(StateJournalTest, APathThatCannotBeWrittenIsRefused) {
  EXPECT_THROW(StateJournal("/nowhere/journal", 1), InvalidArgument);
}

}  // namespace
}  // namespace halocline::bus
