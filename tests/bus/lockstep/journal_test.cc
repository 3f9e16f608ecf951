// SPDX-License-Identifier: BSD-3-Clause
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
  void flip(std::size_t bit) const {
    std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
    const auto at = static_cast<std::streamoff>(bit / 8);
    file.seekg(at);
    const int byte = file.get();
    file.seekp(at);
    file.put(static_cast<char>(byte ^ (1 << bit % 8)));
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

// Whichever it is, of word, kind, length, check sum or body: later entries do not follow from those before.
TEST_F(JournalTest, ARunIsNotContinuedPastAFlippedBit) {
  constexpr std::size_t kHead = bus::JournalFile::kHeadBytes, kSecond = bus::kJournalHeaderBytes + kHead + 10;
  for (std::size_t bit = 8 * kSecond; bit < 8 * (kSecond + kHead + 11); ++bit) {
    write_three();
    flip(bit);
    EXPECT_THROW(read_journal(path_), InvalidArgument) << bit;
    std::remove(path_.c_str());
  }
}

TEST_F(JournalTest, AFlippedBitOfTheLastEntryCutsItOff) {
  write_three();
  flip(8 * std::filesystem::file_size(path_) - 1);
  const JournalContents contents = read_journal(path_);
  EXPECT_EQ(contents.entries.size(), 2u);
  EXPECT_EQ(contents.bytes_cut_off, bus::JournalFile::kHeadBytes + 12);
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
