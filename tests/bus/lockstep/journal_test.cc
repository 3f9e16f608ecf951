#include "bus/lockstep/journal.h"

#include <cstdio>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/check.h"

namespace halocline::conductor {
namespace {

class JournalTest : public ::testing::Test {
 protected:
  ~JournalTest() override { std::remove(path_.c_str()); }
  void write_three() {
    Journal journal(path_);
    for (std::uint8_t i = 0; i < 3; ++i)
      EXPECT_TRUE(journal.append({EntryKind::kRound, bus::Bytes(10u + i, i)}));
  }
  std::string path_ = ::testing::TempDir() + "halocline-journal-" + std::to_string(getpid());
};

TEST_F(JournalTest, GivesBackWhatWasWritten) {
  write_three();
  const JournalContents contents = read_journal(path_);
  ASSERT_EQ(contents.entries.size(), 3u);
  EXPECT_EQ(contents.entries[2].kind, EntryKind::kRound);
  EXPECT_EQ(contents.entries[2].bytes, bus::Bytes(12, 2));
  EXPECT_EQ(contents.bytes_cut_off, 0u);
}

TEST_F(JournalTest, NoFileIsAnEmptyJournal) { EXPECT_TRUE(read_journal(path_).entries.empty()); }

TEST_F(JournalTest, WhateverAKillLeftOfTheLastEntryIsCutOff) {
  write_three();
  const auto whole = std::filesystem::file_size(path_);
  const auto last = bus::JournalFile::kHeadBytes + 12u;
  for (auto size = whole - 1; size > whole - last; --size) {
    std::filesystem::resize_file(path_, size);
    const JournalContents contents = read_journal(path_);
    ASSERT_EQ(contents.entries.size(), 2u) << size;
    EXPECT_EQ(contents.bytes_cut_off, size - (whole - last));
    EXPECT_EQ(std::filesystem::file_size(path_), whole - last);
    std::remove(path_.c_str());
    write_three();
  }
}

TEST_F(JournalTest, GoesOnBehindWhatWasCutOff) {
  write_three();
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 1);
  read_journal(path_);
  EXPECT_TRUE(Journal(path_).append({EntryKind::kOver, {}}));
  const JournalContents contents = read_journal(path_);
  ASSERT_EQ(contents.entries.size(), 3u);
  EXPECT_EQ(contents.entries[2].kind, EntryKind::kOver);
}

// Entries behind it do not follow from those before.
TEST_F(JournalTest, ARunIsNotContinuedFromADamagedJournal) {
  write_three();
  std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(bus::kJournalHeaderBytes + bus::JournalFile::kHeadBytes + 10 + bus::JournalFile::kHeadBytes + 4);
  file.put('x');
  file.close();
  EXPECT_THROW(read_journal(path_), InvalidArgument);
}

TEST_F(JournalTest, AnotherFileIsRefusedAndStaysAsItIs) {
  std::ofstream(path_) << "an LCM log, say";
  EXPECT_THROW(read_journal(path_), InvalidArgument);
  EXPECT_THROW(Journal{path_}, InvalidArgument);
  EXPECT_EQ(std::filesystem::file_size(path_), 15u);
}

TEST(Journal, AFolderIsNoJournal) { EXPECT_THROW(Journal("/"), InvalidArgument); }

}  // namespace
}  // namespace halocline::conductor
