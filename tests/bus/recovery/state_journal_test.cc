// SPDX-License-Identifier: BSD-3-Clause
#include "bus/recovery/state_journal.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/bus/runtime/journal_files.h"
#include "tests/support/file_size_limit.h"

namespace halocline::bus {
namespace {

// A state of a number and three texts, of which each is a part.
class State {
 public:
  std::int64_t number = 0;
  std::vector<std::string> texts{"", "", ""};

  void set(std::size_t i, std::string text) {
    texts[i] = std::move(text);
    ++changes_[i];
  }
  void archive(Archive& a) {
    a(number);
    for (std::size_t i = 0; i < texts.size(); ++i) a.part(changes_[i], texts[i]);
  }
  bool operator==(const State& o) const { return number == o.number && texts == o.texts; }

 private:
  std::vector<std::uint64_t> changes_{0, 0, 0};
};

class StateJournalTest : public ::testing::Test {
 protected:
  void open(std::uint64_t digest = 1) { journal_ = files_.open(digest); }
  bool write() {
    ++state_.number;
    archive_.begin_with_parts(journal_->wants_whole());
    archive_(state_);
    const auto added = static_cast<std::uint8_t>(state_.number);
    return journal_->write(7, SimTime::from_seconds(static_cast<double>(state_.number)), archive_,
                           std::span(&added, 1));
  }
  bool write(std::size_t i, const std::string& text) {
    state_.set(i, text);
    return write();
  }
  // What the next incarnation inherits.
  std::optional<State> inherited(std::uint64_t digest = 1) const {
    const auto journal = files_.open(digest);
    if (!journal->inherited()) return std::nullopt;
    State state;
    Archive a(journal->inherited()->state, journal->inherited()->parts);
    a(state);
    a.require_end();
    return state;
  }
  std::string content(int file) const {
    std::ifstream in(files_.file(file), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  // Without a new file: the journal goes on writing to the one that it has opened.
  void set_content(int file, const std::string& bytes) const {
    std::filesystem::resize_file(files_.file(file), bytes.size());
    std::fstream(files_.file(file), std::ios::in | std::ios::out | std::ios::binary) << bytes;
  }
  std::uintmax_t size_of(int file) const { return std::filesystem::file_size(files_.file(file)); }

  testing::JournalFiles files_;
  std::unique_ptr<StateJournal> journal_ = files_.open();
  State state_;
  Archive archive_;
};

TEST_F(StateJournalTest, ANewJournalInheritsNothing) { EXPECT_FALSE(journal_->inherited().has_value()); }

TEST_F(StateJournalTest, TheLatestStateIsInherited) {
  write(0, "a");
  write(2, "c");
  write();
  const auto saved = files_.open();
  EXPECT_EQ(saved->inherited()->session, 7);
  EXPECT_EQ(saved->inherited()->at, SimTime::from_seconds(3));
  EXPECT_EQ(saved->inherited()->additions, (std::vector<std::uint8_t>{1, 2, 3}));
  EXPECT_EQ(inherited(), state_);
}

TEST_F(StateJournalTest, WhatHasNotChangedIsNotWrittenAgain) {
  write(0, std::string(10'000, 'a'));
  const auto size = size_of(0);
  write(1, "b");
  EXPECT_LT(size_of(0), size + 300);
  EXPECT_EQ(inherited(), state_);
}

TEST_F(StateJournalTest, TheNextIncarnationWritesOn) {
  write(0, "a");
  write(1, "b");
  open();
  write(2, "c");
  write(0, "d");
  EXPECT_EQ(inherited(), state_);
}

TEST_F(StateJournalTest, FilesTakeTurnsAndStayBounded) {
  const std::string large(5'000, 'x');
  for (int i = 0; i < 300; ++i) {
    write(static_cast<std::size_t>(i % 3), large + std::to_string(i));
    ASSERT_EQ(inherited(), state_) << i;
  }
  EXPECT_GT(size_of(1), 0u);
  EXPECT_LT(size_of(0) + size_of(1), 20 * 3 * large.size());
}

// A kill in the middle of a write leaves the first bytes of the new content, whichever write it was.
TEST_F(StateJournalTest, AWriteThatWasCutOffLeavesTheStateBefore) {
  std::optional<State> before;
  for (int i = 0; i < 60; ++i) {
    const std::string old[] = {content(0), content(1)};
    write(static_cast<std::size_t>(i % 3), std::string(5'000, static_cast<char>('a' + i % 26)));
    for (const int file : {0, 1}) {
      const std::string written = content(file), &kept = old[file];
      if (written == kept) continue;
      const auto begin = static_cast<std::size_t>(
          std::mismatch(written.begin(), written.end(), kept.begin(), kept.end()).first - written.begin());
      for (const std::size_t cut : {begin + 1, begin + 50, begin + 200, begin + 4'000}) {
        set_content(file, written.substr(0, cut) + kept.substr(std::min(cut, kept.size())));
        EXPECT_EQ(inherited(), before) << i << " " << cut;
      }
      set_content(file, written);
    }
    EXPECT_EQ(inherited(), state_);
    before = state_;
  }
}

TEST_F(StateJournalTest, ARecordOfWhichAByteChangedIsNotTakenUp) {
  write(0, "a");
  const State before = state_;
  const auto size = static_cast<std::streamoff>(size_of(0));
  write(1, "b");
  std::fstream(files_.file(0), std::ios::in | std::ios::out | std::ios::binary).seekp(size + 60).put('x');
  EXPECT_EQ(inherited(), before);
}

TEST_F(StateJournalTest, AStateOfAnotherConfigurationIsNotTakenUp) {
  write();
  EXPECT_FALSE(inherited(2).has_value());
}

TEST_F(StateJournalTest, AnotherFileIsRefusedAndStaysAsItIs) {
  journal_.reset();
  std::ofstream(files_.file(1)) << "somebody's notes";
  EXPECT_THROW(open(), InvalidArgument);
  EXPECT_EQ(content(1), "somebody's notes");
}

// As on a full disk: the kernel refuses what makes the file longer.
TEST_F(StateJournalTest, WhatAFullDiskRefusedIsNotInheritedAndTheNextRecordIsWhole) {
  EXPECT_TRUE(write(0, "a"));
  {
    const halocline::testing::FileSizeLimit full_disk(size_of(0) + 10);
    EXPECT_FALSE(write(1, std::string(1000, 'b')));
  }
  EXPECT_FALSE(inherited().has_value());
  EXPECT_TRUE(journal_->wants_whole());
  EXPECT_TRUE(write(2, "c"));
  EXPECT_EQ(inherited(), state_);
}

TEST_F(StateJournalTest, FilesThatOthersDeleteOrTruncateAreMadeAnew) {
  const auto remove = [](const std::string& path) { std::filesystem::remove(path); };
  const auto truncate = [](const std::string& path) { std::filesystem::resize_file(path, 0); };
  for (const std::function<void(const std::string&)>& attack :
       {std::function(+remove), std::function(+truncate)}) {
    EXPECT_TRUE(write(0, "a"));
    for (const int file : {0, 1}) attack(files_.file(file));
    EXPECT_FALSE(write(1, "b"));
    EXPECT_FALSE(inherited().has_value());
    EXPECT_TRUE(write(2, "c"));
    EXPECT_EQ(inherited(), state_);
  }
}

TEST_F(StateJournalTest, APathThatCannotBeWrittenIsRefused) {
  EXPECT_THROW(StateJournal("/nowhere/journal", 1), InvalidArgument);
}

}  // namespace
}  // namespace halocline::bus
