// SPDX-License-Identifier: BSD-3-Clause
// What the subcommands that read logs say of logs that are not whole, and what full disks and full memory
// cost.
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/halocline/command_fixture.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/process.h"

namespace halocline::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(RunCommand, EveryReaderOfALogSaysThatItIsCutOff) {
  ASSERT_EQ(run("run pond.toml --duration 5 --out here --quiet --no-csv").code, 0);
  fs::resize_file(folder_ + "/here/pond.lcm", fs::file_size(folder_ + "/here/pond.lcm") - 9);
  for (const std::string& reader : readers("here/pond.lcm")) {
    const Ended end = run(reader);
    EXPECT_EQ(end.code, 1) << reader;
    EXPECT_THAT(end.output, HasSubstr("ends within an event")) << reader;
  }
}

TEST_F(RunCommand, EveryReaderOfALogSaysWhatItCannotRead) {
  ASSERT_EQ(run("run pond.toml --duration 60 --out here --quiet --no-csv").code, 0);
  for (const std::string& reader : readers("here/pond.lcm")) {
    const Ended end = run(reader);
    EXPECT_EQ(end.code, 0) << reader << "\n" << end.output;
  }
  const std::string packet_outcome = "OUTCOME";  // in the log, a fingerprint follows the name of its channel
  std::string log = bytes_of(folder_ + "/here/pond.lcm");
  int outcomes = 0;
  for (std::size_t at = log.find(packet_outcome); at != std::string::npos;
       at = log.find(packet_outcome, at + 1)) {
    ++outcomes;
    log[at + packet_outcome.size()] ^= 0x55;
  }
  std::ofstream(folder_ + "/here/other.lcm", std::ios::binary) << log;
  const std::string version = std::to_string(outcomes) + " events on OUTCOME are of another version";
  for (const std::string& reader : readers("here/other.lcm")) {
    const Ended end = run(reader);
    if (reader.starts_with("log output")) {  // it is whole or it is none
      EXPECT_EQ(end.code, 2);
      EXPECT_THAT(end.output, HasSubstr("an event on OUTCOME does not decode"));
      continue;
    }
    EXPECT_EQ(end.code, 1) << reader;
    EXPECT_THAT(end.output, AllOf(HasSubstr(" accepted packets have no outcome; "), HasSubstr(version)))
        << reader;
    EXPECT_THAT(end.output, Not(HasSubstr("one for each"))) << reader;
  }
}

TEST_F(RunCommand, EveryReaderOfALogRefusesAFileWithoutAnyEvent) {
  std::ofstream(folder_ + "/empty.lcm").close();
  for (const std::string& reader : readers("empty.lcm")) {
    const Ended end = run(reader);
    EXPECT_EQ(end.code, 2) << reader;
    EXPECT_THAT(end.output, HasSubstr("empty.lcm holds no event")) << reader;
  }
}

TEST_F(RunCommand, TheReportTakesTheFolderOfARun) {
  ASSERT_EQ(run("run pond.toml --duration 5 --out here --quiet --no-csv --log-rotate 2s").code, 0);
  EXPECT_EQ(run("report here --force").code, 0);
  EXPECT_TRUE(fs::exists(folder_ + "/here/pond.html"));
  fs::copy_file(folder_ + "/here/pond.lcm", folder_ + "/here/other.lcm");
  const Ended two = run("report here --force");
  EXPECT_EQ(two.code, 2);
  EXPECT_THAT(two.output, HasSubstr("holds 2 logs (*.lcm)"));
  fs::create_directories(folder_ + "/none");
  EXPECT_THAT(run("report none").output, HasSubstr("holds 0 logs"));
}

TEST_F(RunCommand, AFullDiskLeavesTheOldReport) {
  ASSERT_EQ(run("run pond.toml --duration 5 --out here --quiet --no-csv").code, 0);
  const std::string before = bytes_of(folder_ + "/here/report.html");
  const FileSizeLimit full_disk(1000);  // children inherit it
  EXPECT_EQ(run("report here/pond.lcm --out here/report.html --force").code, 1);
  EXPECT_EQ(bytes_of(folder_ + "/here/report.html"), before);
}

TEST_F(RunCommand, GridsBeyondTheMemoryAreRefusedBeforeTheyAreMade) {
  const std::string large =
      "config pond.toml --set 'terrain.kind=\"seamount\"' --set terrain.size_north_m=32000 --set "
      "terrain.size_east_m=32000 "
      "--set terrain.spacing_m=1";
  Process limited(
      {"/bin/sh", "-c", "ulimit -v 2000000; cd '" + folder_ + "' && exec '" + kProgram + "' " + large});
  EXPECT_EQ(limited.wait(), 2);
  EXPECT_THAT(limited.output(), AllOf(HasSubstr("the terrain needs about 5.5 GB of memory, and "),
                                      HasSubstr("take a smaller domain or a wider spacing")));
}

}  // namespace
}  // namespace halocline::testing
