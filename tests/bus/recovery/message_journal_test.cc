// SPDX-License-Identifier: BSD-3-Clause
#include "bus/recovery/message_journal.h"

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bus/messages/message_codec.h"
#include "bus/messages/sequence_number.h"
#include "bus/recovery/journal_file.h"
#include "core/check.h"
#include "tests/support/file_size_limit.h"

namespace halocline::bus {
namespace {

using Kind = JournalledMessage::Kind;

class MessageJournalTest : public ::testing::Test {
 protected:
  ~MessageJournalTest() override {
    for (const char* part : {"", ".1", ".unfinished"}) std::filesystem::remove(path_ + part);
  }
  std::unique_ptr<MessageJournal> open() {
    return std::make_unique<MessageJournal>(
        MessageJournal::Rule{path_, SimDuration::from_seconds(10), {channels::kModem}, {"SET_ENVIRONMENT"}});
  }
  std::unique_ptr<MessageJournal> open_with(std::uint64_t digest) {
    return std::make_unique<MessageJournal>(
        MessageJournal::Rule{path_, SimDuration::from_seconds(10), {}, {}, digest});
  }
  static void receive(MessageJournal& journal, double time_s, const std::string& channel, std::uint8_t byte) {
    journal.add_input(channel, &byte, 1);
    journal.write_inputs(SimTime::from_seconds(time_s));
  }
  void flip_bit(std::uintmax_t byte_at) const {
    std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(static_cast<std::streamoff>(byte_at));
    const int byte = file.get();
    file.seekp(static_cast<std::streamoff>(byte_at));
    file.put(static_cast<char>(byte ^ 4));
  }
  // "o12 CHANNEL 5": output or input, seconds, channel, the only byte; "s12": a step without input.
  static std::vector<std::string> inherited(MessageJournal& journal) {
    std::vector<std::string> all;
    for (const JournalledMessage& m : journal.take_inherited()) {
      const std::string second = std::to_string(m.at.nanoseconds() / 1'000'000'000);
      all.push_back(m.kind == Kind::kStep ? "s" + second
                                          : (m.kind == Kind::kOutput ? "o" : "i") + second + ' ' + m.channel +
                                                ' ' + std::to_string(m.bytes.at(0)));
    }
    return all;
  }
  using Lines = std::vector<std::string>;

  const std::string path_ = ::testing::TempDir() + "halocline-message-journal-" + std::to_string(getpid());
};

TEST_F(MessageJournalTest, TheNextIncarnationReadsInputsAndOutputs) {
  {
    const auto journal = open();
    receive(*journal, 1, "STATE.a", 5);
    journal->write_output(SimTime::from_seconds(2.0), "OUTCOME", {6});
  }
  EXPECT_EQ(inherited(*open()), (Lines{"i1 STATE.a 5", "o2 OUTCOME 6"}));
  EXPECT_EQ(inherited(*open()), (Lines{"i1 STATE.a 5", "o2 OUTCOME 6"})) << "and the one after it";
}

TEST_F(MessageJournalTest, TheLatestStepWithoutInputStandsBeforeTheNextWithOne) {
  {
    const auto journal = open();
    receive(*journal, 1, "STATE.a", 5);
    for (const double t : {2.0, 3.0}) journal->write_inputs(SimTime::from_seconds(t));
    receive(*journal, 4, "STATE.a", 6);
    receive(*journal, 5, "STATE.a", 7);
    journal->write_inputs(SimTime::from_seconds(6.0));
  }
  EXPECT_EQ(inherited(*open()), (Lines{"i1 STATE.a 5", "s3", "i4 STATE.a 6", "i5 STATE.a 7"}));
}

TEST_F(MessageJournalTest, AnInputThatNoStepTookIsNotKept) {
  {
    const auto journal = open();
    const std::uint8_t byte = 5;
    journal->add_input("STATE.a", &byte, 1);
  }
  EXPECT_TRUE(inherited(*open()).empty());
}

TEST_F(MessageJournalTest, WhatAKillCutOffIsNoEntry) {
  {
    const auto journal = open();
    receive(*journal, 1, "STATE.a", 5);
    receive(*journal, 2, "STATE.a", 6);
  }
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 1);
  EXPECT_EQ(inherited(*open()), (Lines{"i1 STATE.a 5"}));
}

TEST_F(MessageJournalTest, AnEntryWhoseBytesChangedIsNoEntry) {
  {
    const auto journal = open();
    receive(*journal, 1, "STATE.a", 5);
    receive(*journal, 2, "STATE.a", 6);
  }
  {
    std::FILE* file = std::fopen(path_.c_str(), "r+");
    std::fseek(file, -1, SEEK_END);
    std::fputc(99, file);
    std::fclose(file);
  }
  EXPECT_EQ(inherited(*open()), (Lines{"i1 STATE.a 5"}));
}

// Whichever bit it is, of head or body.
TEST_F(MessageJournalTest, AFlippedBitCostsOneEntry) {
  constexpr int kEntries = 1294;
  {
    const auto journal = open();
    for (int i = 0; i < kEntries; ++i) receive(*journal, 1 + 0.005 * i, "STATE.a", 5);
  }
  const auto size = std::filesystem::file_size(path_);
  for (const auto at : {size / 2, size / 2 + 7, size / 2 + 20, size / 3}) {
    const std::string saved = path_ + ".saved";
    std::filesystem::copy_file(path_, saved, std::filesystem::copy_options::overwrite_existing);
    flip_bit(at);
    const auto journal = open();
    EXPECT_EQ(inherited(*journal).size(), kEntries - 1u);
    EXPECT_GT(journal->bytes_damaged(), 0u);
    EXPECT_LT(journal->bytes_damaged(), 60u);
    std::filesystem::rename(saved, path_);
  }
}

TEST_F(MessageJournalTest, AnotherFileIsRefusedAndStaysAsItIs) {
  const std::string log(1'900'000, 'x');
  std::ofstream(path_) << log;
  EXPECT_THROW(open(), InvalidArgument);
  EXPECT_EQ(std::filesystem::file_size(path_), log.size());
}

TEST_F(MessageJournalTest, TwoProcessesDoNotShareAJournal) {
  const auto journal = open();
  receive(*journal, 1, "STATE.a", 5);
  const pid_t child = fork();
  if (child == 0) {
    try {
      open();
    } catch (const InvalidArgument&) {
      _exit(7);
    }
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 7);
}

// As on a full disk: the kernel refuses what makes the file longer.
TEST_F(MessageJournalTest, WhenTheDiskIsFullTheJournalIsGivenUpAndNothingElse) {
  const auto journal = open();
  receive(*journal, 1, "STATE.a", 5);
  {
    const halocline::testing::FileSizeLimit full_disk(std::filesystem::file_size(path_) + 10);
    receive(*journal, 2, "STATE.a", 6);
  }
  EXPECT_TRUE(journal->is_given_up());
  receive(*journal, 3, "STATE.a", 7);
  journal->write_output(SimTime::from_seconds(4), "OUTCOME", {8});
  EXPECT_TRUE(inherited(*open()).empty());
}

TEST_F(MessageJournalTest, ALongRunKeepsTheLastSecondsAndWhatIsCarriedOver) {
  {
    const auto journal = open();
    receive(*journal, 0, "MODEM.a", 1);
    receive(*journal, 0, "MODEM.b", 2);
    receive(*journal, 1, "SET_ENVIRONMENT", 3);
    receive(*journal, 2, "SET_ENVIRONMENT", 4);
    receive(*journal, 3, "MODEM.a", 5);
    for (int second = 4; second <= 1000; ++second) receive(*journal, second, "STATE.a", 9);
  }
  EXPECT_LT(std::filesystem::file_size(path_) + std::filesystem::file_size(path_ + ".1"), 30u * 40u);
  const Lines read = inherited(*open());
  EXPECT_EQ(Lines(read.begin(), read.begin() + 4),
            (Lines{"i0 MODEM.b 2", "i1 SET_ENVIRONMENT 3", "i2 SET_ENVIRONMENT 4", "i3 MODEM.a 5"}));
  EXPECT_EQ(read.size(), 4u + 11u);
  EXPECT_EQ(read[4], "i990 STATE.a 9");
  EXPECT_EQ(read.back(), "i1000 STATE.a 9");
}

TEST_F(MessageJournalTest, AnotherRunForgetsAll) {
  {
    const auto journal = open();
    receive(*journal, 1, "MODEM.a", 5);
    journal->clear();
    receive(*journal, 0, "STATE.a", 6);
  }
  EXPECT_EQ(inherited(*open()), (Lines{"i0 STATE.a 6"}));
}

TEST_F(MessageJournalTest, TheLastInputOfEachFlowIsKeptOfTheLatestEightSessions) {
  const auto of_session = [](std::uint8_t session, std::uint8_t first_byte) {
    std::vector<std::uint8_t> message(kSessionAt, 0);
    append_int64(session, message);
    append_int64(0, message);
    message[0] = first_byte;
    return message;
  };
  const auto carried = [this] {
    Lines lines = inherited(*open());
    std::erase_if(lines, [](const std::string& line) { return line.find("MODEM") == std::string::npos; });
    return lines;
  };
  const auto receive_all = [&](double from_s,
                               const std::vector<std::pair<std::uint8_t, std::uint8_t>>& messages) {
    const auto journal = open();
    double t = from_s;
    for (const auto& [session, byte] : messages) {
      const auto message = of_session(session, byte);
      journal->add_input("MODEM.a", message.data(), message.size());
      journal->write_inputs(SimTime::from_seconds(t++));
    }
    for (int i = 0; i <= 50; ++i) receive(*journal, t++, "STATE.a", 0);
  };
  receive_all(1, {{7, 1}, {8, 2}, {7, 3}});
  EXPECT_EQ(carried(), (Lines{"i2 MODEM.a 2", "i3 MODEM.a 3"}));
  receive_all(100, {{1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}, {6, 6}, {9, 7}});
  const Lines lines = carried();
  ASSERT_EQ(lines.size(), 8u);
  EXPECT_EQ(lines.front(), "i3 MODEM.a 3") << "the one heard longest ago made room";
  EXPECT_EQ(lines.back(), "i106 MODEM.a 7");
}

TEST_F(MessageJournalTest, WhatWasWrittenWithAnotherDigestIsNotInherited) {
  receive(*open_with(5), 1, "STATE.a", 5);
  {
    const auto same = open_with(5);
    EXPECT_FALSE(same->is_of_another_run());
    EXPECT_EQ(inherited(*same), (Lines{"i1 STATE.a 5"}));
  }
  {
    const auto other = open_with(6);
    EXPECT_TRUE(other->is_of_another_run());
    EXPECT_TRUE(inherited(*other).empty());
    receive(*other, 2, "STATE.a", 6);
  }
  EXPECT_EQ(inherited(*open_with(6)), (Lines{"i2 STATE.a 6"}));
}

TEST_F(MessageJournalTest, ALinkStaysALinkAndWhatIsNoFileIsRefused) {
  const std::string link = path_ + ".link", pipe = path_ + ".pipe";
  std::filesystem::create_symlink(path_, link);
  receive(
      *std::make_unique<MessageJournal>(MessageJournal::Rule{link, SimDuration::from_seconds(10), {}, {}}), 1,
      "STATE.a", 5);
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(inherited(*open()), (Lines{"i1 STATE.a 5"}));
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& path : {pipe, std::string("/dev/null")})
    EXPECT_THROW(MessageJournal({path, SimDuration::from_seconds(1), {}, {}}), InvalidArgument) << path;
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  for (const std::string& made : {link, pipe}) std::filesystem::remove(made);
}

TEST_F(MessageJournalTest, AFileThatOthersDeleteOrTruncateIsGivenUp) {
  for (const bool deletes : {true, false}) {
    const auto journal = open();
    receive(*journal, 1, "STATE.a", 5);
    EXPECT_FALSE(journal->is_given_up());
    if (deletes) {
      std::filesystem::remove(path_);
    } else {
      std::filesystem::resize_file(path_, 0);
    }
    receive(*journal, 2, "STATE.a", 6);
    EXPECT_TRUE(journal->is_given_up());
    EXPECT_TRUE(inherited(*open()).empty());
  }
}

// Its check sum is right, as a program may make it; sums of such times are none.
TEST_F(MessageJournalTest, AnEntryOfNoTimeIsDamage) {
  receive(*open(), 1, "STATE.a", 5);
  for (const std::uint8_t first : std::array<std::uint8_t, 2>{0x80, 0x7f}) {
    JournalFile file(path_, "HALOCLINE INPUT2");
    ASSERT_TRUE(file.append(std::array{JournalFile::Record{0, {first, 0, 0, 0, 0, 0, 0, 9, 1, 'x', 6}}}));
  }
  const auto journal = open();
  EXPECT_EQ(journal->bytes_damaged(), 22u);
  EXPECT_EQ(inherited(*journal), (Lines{"i1 STATE.a 5"}));
}

TEST_F(MessageJournalTest, APathThatCannotBeWrittenIsRefused) {
  EXPECT_THROW(MessageJournal({"/nowhere/journal", SimDuration::from_seconds(1), {}, {}}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::bus
