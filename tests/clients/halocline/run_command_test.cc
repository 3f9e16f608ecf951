// What a person meets who starts `halocline run`: folders, silence, Ctrl-C, warnings.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/process.h"

namespace halocline::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const std::string kProgram = HALOCLINE_BIN_DIR "/halocline";

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class RunCommand : public ::testing::Test {
 protected:
  RunCommand() {
    fs::create_directories(folder_);
    std::ofstream(folder_ + "/pond.toml")
        << "[scenario]\nname = \"pond\"\nduration_s = 600\n"
           "[[vehicle]]\nname = \"a\"\nid = 1\nstart_ned_m = [0.0, 0.0, 20.0]\n"
           "[[vehicle]]\nname = \"b\"\nid = 2\nstart_ned_m = [0.0, 50.0, 20.0]\n"
           "[vehicle.traffic]\nperiod_s = 5\n";
  }
  ~RunCommand() override { fs::remove_all(folder_); }

  struct Ended {
    int code;
    std::string output;
  };
  // With the test's folder as the working folder.
  std::vector<std::string> command(const std::string& arguments) const {
    return {"/bin/sh", "-c", "cd '" + folder_ + "' && exec '" + kProgram + "' " + arguments};
  }
  Ended run(const std::string& arguments) {
    Process process(command(arguments));
    const int code = process.wait(std::chrono::seconds(60));
    return {code, process.output()};
  }
  // Signals once `text` is in the output and `file` holds something.
  Ended run_until(const std::string& arguments, const std::string& text, const std::string& file,
                  int signal) {
    Process process(command(arguments));
    for (int i = 0; i < 3000 && process.running(); ++i) {
      std::error_code error;
      const auto size = fs::file_size(folder_ + "/" + file, error);
      if (process.output().find(text) != std::string::npos && !error && size > 0) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    process.signal(signal);
    const int code = process.wait(std::chrono::seconds(60));
    return {code, process.output()};
  }

  std::string folder_ = ::testing::TempDir() + "run-" + std::to_string(getpid());
};

TEST_F(RunCommand, TheSecondRunHasAFolderOfItsOwn) {
  EXPECT_EQ(run("run pond.toml --duration 1 --no-csv").code, 0);
  const std::string first = bytes_of(folder_ + "/runs/pond/pond.lcm");
  EXPECT_THAT(first, Not(IsEmpty()));
  const Ended second = run("run pond.toml --duration 2 --no-csv");
  EXPECT_EQ(second.code, 0) << second.output;
  EXPECT_THAT(second.output, HasSubstr("runs/pond-2/pond.lcm"));
  EXPECT_EQ(bytes_of(folder_ + "/runs/pond/pond.lcm"), first);
  EXPECT_GT(fs::file_size(folder_ + "/runs/pond-2/pond.lcm"), first.size());
}

TEST_F(RunCommand, TheLastLineNamesTheReportWhichHasTheNumbersOfTheOutcomesCommand) {
  const Ended ended = run("run pond.toml --duration 60 --no-csv --out here");
  ASSERT_EQ(ended.code, 0) << ended.output;
  EXPECT_THAT(ended.output, EndsWith("report      here/report.html\n"));
  EXPECT_THAT(ended.output, HasSubstr("\npackets     "));
  const std::string report = bytes_of(folder_ + "/here/report.html");
  const std::string counts =
      run("outcomes here/pond.lcm --format csv").output;  // one pair, so one row an outcome
  std::istringstream rows(counts.substr(counts.find('\n') + 1));
  std::string from, to, outcome, packets;
  int found = 0;
  for (; std::getline(rows, from, ',') && std::getline(rows, to, ',') && std::getline(rows, outcome, ',') &&
         std::getline(rows, packets);
       ++found)
    EXPECT_THAT(report, HasSubstr(" " + outcome + "</td><td class=\"number\">" + packets + "</td>"));
  EXPECT_GT(found, 0) << counts;
  EXPECT_EQ(run("report here/pond.lcm").code, 0);
  EXPECT_EQ(bytes_of(folder_ + "/here/pond.html"), report);  // the page depends on the log alone
}

TEST_F(RunCommand, NoReportIsWrittenWhereNoneIsWanted) {
  EXPECT_THAT(run("run pond.toml --duration 1 --no-csv --no-report --out here").output,
              Not(HasSubstr("report ")));
  EXPECT_FALSE(fs::exists(folder_ + "/here/report.html"));
}

TEST_F(RunCommand, ALogThatIsThereIsReplacedByForceAlone) {
  EXPECT_EQ(run("run pond.toml --duration 1 --no-csv --out here").code, 0);
  const std::string first = bytes_of(folder_ + "/here/pond.lcm");
  for (const char* place : {"--out here", "--log here/pond.lcm"}) {
    const Ended again = run("run pond.toml --duration 2 --no-csv " + std::string(place));
    EXPECT_EQ(again.code, 2);
    EXPECT_THAT(again.output, HasSubstr("here/pond.lcm is there already"));
    EXPECT_THAT(again.output, HasSubstr("--force"));
    EXPECT_EQ(bytes_of(folder_ + "/here/pond.lcm"), first);
  }
  EXPECT_EQ(run("run pond.toml --duration 2 --no-csv --out here --force").code, 0);
  EXPECT_GT(fs::file_size(folder_ + "/here/pond.lcm"), first.size());
}

TEST_F(RunCommand, APartOfARotatedLogIsALogToo) {
  std::ofstream(folder_ + "/pond.0003.lcm") << "the newest parts alone are kept";
  EXPECT_EQ(run("run pond.toml --duration 1 --no-csv --log pond.lcm").code, 2);
}

TEST_F(RunCommand, ARunThatIsRefusedLeavesNoFolder) {
  EXPECT_EQ(run("run pond.toml --set 'vehicle.0.start_ned_m=[0.0,0.0,500.0]'").code, 2);
  EXPECT_FALSE(fs::exists(folder_ + "/runs"));
}

// Where each program is started by hand, the one that makes the terrain checks the starts on it.
TEST_F(RunCommand, TheVehicleSimulatorRefusesAStartUnderGroundToo) {
  Process process({HALOCLINE_BIN_DIR "/halocline-vehicle-sim", folder_ + "/pond.toml", "--time-source",
                   "lockstep", "--set", "vehicle.0.start_ned_m=[0.0,0.0,500.0]"});
  EXPECT_EQ(process.wait(), 2);
  EXPECT_THAT(process.output(), HasSubstr("vehicle a: that is under ground"));
}

TEST_F(RunCommand, QuietIsSilentButForErrors) {
  const Ended quiet = run("run pond.toml --duration 2 --quiet --set vehicle.1.traffic.period_s=1");
  EXPECT_EQ(quiet.code, 0);
  EXPECT_THAT(quiet.output, IsEmpty());
  const Ended wrong = run("run pond.toml --quiet --set vehicle.1.traffic.destination='\"b\"'");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.output, HasSubstr("traffic.destination is 'b'; a vehicle does not send to itself"));
}

TEST_F(RunCommand, AWarningIsPrintedOnce) {
  const std::string output =
      run("run pond.toml --duration 2 --no-csv --set vehicle.1.traffic.period_s=1").output;
  const auto at = output.find("warning: command line: vehicle[1].traffic.period_s is 1");
  ASSERT_NE(at, std::string::npos) << output;
  EXPECT_EQ(output.find("warning:", at + 1), std::string::npos);
}

TEST_F(RunCommand, InterruptedItExitsWith130AndLeavesASoundLog) {
  const Ended end = run_until("run pond.toml --rate 1 --out cut", "terrain", "cut/pond.lcm", SIGINT);
  EXPECT_EQ(end.code, 130) << end.output;
  EXPECT_THAT(end.output, HasSubstr("(interrupted)"));
  const Ended info = run("log info cut/pond.lcm");
  EXPECT_EQ(info.code, 0);
  EXPECT_THAT(info.output, HasSubstr("STATE"));
}

TEST_F(RunCommand, TerminatedItEndsInOrder) {
  EXPECT_EQ(run_until("run pond.toml --rate 1 --out cut", "terrain", "cut/pond.lcm", SIGTERM).code, 0);
}

TEST_F(RunCommand, AnInterruptedReplayExitsWith130) {
  ASSERT_EQ(run("run pond.toml --duration 300 --no-csv --out here --quiet").code, 0);
  const Ended end =
      run_until("replay here/pond.lcm --log again.lcm --set channel_server.link_rate_hz=50 --no-comparison",
                "", "again.lcm", SIGINT);
  EXPECT_EQ(end.code, 130) << end.output;
  EXPECT_THAT(end.output, HasSubstr("(interrupted)"));
}

TEST_F(RunCommand, AnInterruptedSweepExitsWith130) {
  const Ended end =
      run_until("sweep pond.toml --axis environment.wind_mps=2,5 --duration 100000 --out wind --jobs 1",
                "to do here", "wind/sweep.toml", SIGINT);
  EXPECT_EQ(end.code, 130) << end.output;
}

TEST_F(RunCommand, AnEnormousLogIsAnnounced) {
  const Ended end =
      run_until("run pond.toml --rate 1 --duration 3e7 --out long", "terrain", "long/pond.lcm", SIGINT);
  EXPECT_EQ(end.code, 130);
  EXPECT_THAT(end.output, HasSubstr("warning: the log will have about "));
  EXPECT_THAT(end.output, HasSubstr(" GB"));
  EXPECT_THAT(run("run pond.toml --duration 1 --no-csv --out short").output,
              Not(HasSubstr("the log will have")));
}

}  // namespace
}  // namespace halocline::testing
