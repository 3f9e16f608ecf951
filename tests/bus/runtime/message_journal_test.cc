#include "bus/runtime/message_journal.h"

#include <filesystem>
#include <memory>

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/check.h"

namespace halocline::bus {
namespace {

using Kind = JournalledMessage::Kind;

class MessageJournalTest : public ::testing::Test {
 protected:
  ~MessageJournalTest() override {
    for (const char* part : {"", ".1", ".new"}) std::filesystem::remove(path_ + part);
  }
  std::unique_ptr<MessageJournal> open() {
    return std::make_unique<MessageJournal>(
        MessageJournal::Rule{path_, SimDuration::from_seconds(10), {channels::kModem}, {"SET_ENVIRONMENT"}});
  }
  static void hear(MessageJournal& journal, double time_s, const std::string& channel, std::uint8_t byte) {
    journal.hear(channel, &byte, 1);
    journal.write_heard(SimTime::from_seconds(time_s));
  }
  // "s12 CHANNEL 5": said or heard, seconds, channel, the only byte.
  static std::vector<std::string> inherited(MessageJournal& journal) {
    std::vector<std::string> all;
    for (const JournalledMessage& m : journal.take_inherited()) {
      all.push_back((m.kind == Kind::kSaid ? "s" : "h") + std::to_string(m.at.nanoseconds() / 1'000'000'000) +
                    ' ' + m.channel + ' ' + std::to_string(m.bytes.at(0)));
    }
    return all;
  }
  using Lines = std::vector<std::string>;

  const std::string path_ = ::testing::TempDir() + "halocline-message-journal-" + std::to_string(getpid());
};

TEST_F(MessageJournalTest, TheNextLifeIsToldWhatWasHeardAndSaid) {
  {
    const auto journal = open();
    hear(*journal, 1, "STATE.a", 5);
    journal->write_said(SimTime::from_seconds(2.0), "OUTCOME", {6});
  }
  EXPECT_EQ(inherited(*open()), (Lines{"h1 STATE.a 5", "s2 OUTCOME 6"}));
  EXPECT_EQ(inherited(*open()), (Lines{"h1 STATE.a 5", "s2 OUTCOME 6"})) << "and the one after it";
}

TEST_F(MessageJournalTest, WhatWasNotTakenByAStepIsNotTold) {
  {
    const auto journal = open();
    const std::uint8_t byte = 5;
    journal->hear("STATE.a", &byte, 1);
  }
  EXPECT_TRUE(inherited(*open()).empty());
}

TEST_F(MessageJournalTest, WhatAKillCutOffIsNoEntry) {
  {
    const auto journal = open();
    hear(*journal, 1, "STATE.a", 5);
    hear(*journal, 2, "STATE.a", 6);
  }
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 1);
  EXPECT_EQ(inherited(*open()), (Lines{"h1 STATE.a 5"}));
}

TEST_F(MessageJournalTest, AnEntryWhoseBytesChangedEndsWhatIsRead) {
  {
    const auto journal = open();
    hear(*journal, 1, "STATE.a", 5);
    hear(*journal, 2, "STATE.a", 6);
  }
  {
    std::FILE* file = std::fopen(path_.c_str(), "r+");
    std::fseek(file, -1, SEEK_END);
    std::fputc(99, file);
    std::fclose(file);
  }
  EXPECT_EQ(inherited(*open()), (Lines{"h1 STATE.a 5"}));
}

TEST_F(MessageJournalTest, ALongRunKeepsTheLastSecondsAndWhatIsCarriedAlong) {
  {
    const auto journal = open();
    hear(*journal, 0, "MODEM.a", 1);
    hear(*journal, 0, "MODEM.b", 2);
    hear(*journal, 1, "SET_ENVIRONMENT", 3);
    hear(*journal, 2, "SET_ENVIRONMENT", 4);
    hear(*journal, 3, "MODEM.a", 5);
    for (int second = 4; second <= 1000; ++second) hear(*journal, second, "STATE.a", 9);
  }
  EXPECT_LT(std::filesystem::file_size(path_) + std::filesystem::file_size(path_ + ".1"), 30u * 40u);
  const Lines told = inherited(*open());
  EXPECT_EQ(Lines(told.begin(), told.begin() + 4),
            (Lines{"h0 MODEM.b 2", "h1 SET_ENVIRONMENT 3", "h2 SET_ENVIRONMENT 4", "h3 MODEM.a 5"}));
  EXPECT_EQ(told.size(), 4u + 11u);
  EXPECT_EQ(told[4], "h990 STATE.a 9");
  EXPECT_EQ(told.back(), "h1000 STATE.a 9");
}

TEST_F(MessageJournalTest, AnotherRunForgetsAll) {
  {
    const auto journal = open();
    hear(*journal, 1, "MODEM.a", 5);
    journal->clear();
    hear(*journal, 0, "STATE.a", 6);
  }
  EXPECT_EQ(inherited(*open()), (Lines{"h0 STATE.a 6"}));
}

TEST_F(MessageJournalTest, APathThatCannotBeWrittenIsRefused) {
  EXPECT_THROW(MessageJournal({"/nowhere/journal", SimDuration::from_seconds(1), {}, {}}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::bus
