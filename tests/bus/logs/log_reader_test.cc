// SPDX-License-Identifier: BSD-3-Clause
#include "bus/logs/log_reader.h"

#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>

#include "bus/logs/log_series.h"
#include "core/check.h"
#include "tests/bus/logs/log_fixture.h"

namespace halocline::clients {
namespace {

using testing::all_of;
using testing::TemporaryLog;

TEST(LogReader, ReadsWhatLcmWrites) {
  TemporaryLog file;
  file.add_bytes(1'500'000, "ANYTHING", {1, 2, 3});
  file.add_bytes(2'500'000, "ELSE", {});
  LogReader log(file.path());
  const auto events = all_of(log);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].channel, "ANYTHING");
  EXPECT_EQ(events[0].stamp_us, 1'500'000);
  EXPECT_EQ(events[0].data, (std::vector<std::uint8_t>{1, 2, 3}));
  EXPECT_EQ(events[1].number, 1);
  EXPECT_TRUE(events[1].data.empty());
  EXPECT_FALSE(log.truncated());
  EXPECT_EQ(log.bytes_skipped(), 0);
}

TEST(LogReader, EveryTruncationYieldsTheEventsBeforeIt) {
  TemporaryLog file;
  for (std::uint8_t i = 0; i < 3; ++i) file.add_bytes(i, "CHANNEL", {i, i});
  const std::string whole = file.bytes();
  const std::size_t event_bytes = whole.size() / 3;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    file.replace_bytes(whole.substr(0, size));
    if (size < event_bytes) {
      EXPECT_THROW(LogReader(file.path()), InvalidArgument);
      continue;
    }
    LogReader log(file.path());
    EXPECT_EQ(all_of(log).size(), size / event_bytes) << "of " << size << " bytes";
  }
}

TEST(LogReader, ContinuesBehindBytesThatAreNoEvent) {
  TemporaryLog file;
  file.add_bytes(1, "A", {1});
  file.add_bytes(2, "B", {2});
  const std::string whole = file.bytes();
  file.replace_bytes(whole.substr(0, whole.size() / 2) + "rubbish" + whole.substr(whole.size() / 2));
  LogReader log(file.path());
  EXPECT_EQ(all_of(log).size(), 2u);
  EXPECT_EQ(log.bytes_skipped(), 7);
}

TEST(LogReader, CorruptLengthCostsOneEventAndNoMemory) {
  TemporaryLog file;
  file.add_bytes(1, "A", {1});
  file.add_bytes(2, "B", {2});
  std::string bytes = file.bytes();
  constexpr std::size_t kDataLength = 24;  // sync 4, number 8, stamp 8, channel length 4
  bytes[kDataLength] = 0x0f;
  file.replace_bytes(bytes);
  LogReader log(file.path());
  const auto events = all_of(log);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].channel, "B");
}

TEST(LogReader, DamageIsReportedWithFileAndOffset) {
  TemporaryLog file;
  for (std::uint8_t i = 0; i < 3; ++i) file.add_bytes(i, "CHANNEL", {i, i});
  std::string bytes = file.bytes();
  const std::size_t event_bytes = bytes.size() / 3;
  bytes[event_bytes] = 'X';  // the word of the second event
  bytes.resize(bytes.size() - 1);
  file.replace_bytes(bytes);
  LogReader log(file.path());
  EXPECT_EQ(all_of(log).size(), 1u);
  ASSERT_EQ(log.bad_stretches().size(), 1u);
  EXPECT_EQ(log.bad_stretches()[0].offset, static_cast<std::int64_t>(event_bytes));
  std::ostringstream report;
  report_damage(report, log);
  EXPECT_NE(report.str().find(file.path() + ", byte " + std::to_string(event_bytes)), std::string::npos)
      << report.str();
}

TEST(LogReader, EventsKnowTheirPlace) {
  TemporaryLog file;
  file.add_bytes(1, "A", {1});
  file.add_bytes(2, "B", {2});
  LogReader log(file.path());
  const auto events = all_of(log);
  EXPECT_EQ(place_of(log, events[1]), file.path() + ", byte 30");  // 28 of header, a channel, a byte of data
}

TEST(LogReader, ASeriesOfPartsIsReadAsOne) {
  TemporaryLog file;
  for (std::uint8_t i = 0; i < 3; ++i) file.add_bytes(i, "CHANNEL", {i});
  const std::string whole = file.bytes();
  const std::size_t event_bytes = whole.size() / 3;
  const std::string second = bus::part_of_log(file.path(), 1), third = bus::part_of_log(file.path(), 12);
  std::ofstream(second, std::ios::binary) << whole.substr(event_bytes, event_bytes);
  std::ofstream(third, std::ios::binary) << whole.substr(2 * event_bytes);
  file.replace_bytes(whole.substr(0, event_bytes));
  LogReader log(file.path());
  const auto events = all_of(log);
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[2].number, 2);
  EXPECT_EQ(place_of(log, events[2]), third + ", byte 0");
  std::remove(file.path().c_str());  // the oldest part was deleted
  LogReader rest(file.path());
  EXPECT_EQ(all_of(rest).size(), 2u);
  std::remove(second.c_str());
  std::remove(third.c_str());
}

TEST(LogReader, AnotherFileIsRefusedByName) {
  TemporaryLog file;
  file.replace_bytes("[scenario]\nname = \"seamount\"\n");
  try {
    LogReader log(file.path());
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_NE(std::string(error.what()).find(file.path() + " is no LCM log"), std::string::npos);
  }
}

TEST(LogReader, AFileWithoutAnyEventIsRefused) {
  for (const std::string& bytes : {std::string(), std::string("\xED\xA1\xDA\x01\x00", 5)}) {
    TemporaryLog file;
    file.replace_bytes(bytes);
    EXPECT_THROW(LogReader log(file.path()), InvalidArgument);
  }
}

// A recorder that was killed as it began another part.
TEST(LogReader, AnEmptyPartOfALogIsNone) {
  TemporaryLog file;
  file.add(0, "CLOCK", testing::clock_at(0));
  const std::string second = bus::part_of_log(file.path(), 1);
  std::ofstream(second).close();
  LogReader log(file.path());
  EXPECT_EQ(all_of(log).size(), 1u);
  std::remove(second.c_str());
}

TEST(LogReader, WhatIsNoReadableFileIsRefusedWithTheReason) {
  for (const auto& [path, reason] : {std::pair("/nonexistent/log.lcm", "there is no such file"),
                                     std::pair("/", "it is a folder; allowed is a regular file")}) {
    try {
      const LogReader log(path);
      FAIL() << path;
    } catch (const InvalidArgument& error) {
      EXPECT_STREQ(error.what(), (std::string("cannot read the log ") + path + ": " + reason).c_str());
    }
  }
}

}  // namespace
}  // namespace halocline::clients
