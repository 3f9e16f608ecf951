// SPDX-License-Identifier: BSD-3-Clause
// What a person meets who starts `halocline run`: folders, silence, Ctrl-C, warnings.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/halocline/command_fixture.h"
#include "tests/support/channel_file.h"
#include "tests/support/process.h"

namespace halocline::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST_F(RunCommand, TheSecondRunHasAFolderOfItsOwn) {
  EXPECT_EQ(run("run pond.toml --duration 1 --no-csv").code, 0);
  const std::string first = bytes_of(folder_ + "/results/pond/pond.lcm");
  EXPECT_THAT(first, Not(IsEmpty()));
  const Ended second = run("run pond.toml --duration 2 --no-csv");
  EXPECT_EQ(second.code, 0) << second.output;
  EXPECT_THAT(second.output, HasSubstr("results/pond-2/pond.lcm"));
  EXPECT_EQ(bytes_of(folder_ + "/results/pond/pond.lcm"), first);
  EXPECT_GT(fs::file_size(folder_ + "/results/pond-2/pond.lcm"), first.size());
}

TEST_F(RunCommand, TheLastLineNamesTheReportWhichHasTheNumbersOfTheOutcomesCommand) {
  const Ended ended = run("run pond.toml --duration 60 --no-csv --out here");
  ASSERT_EQ(ended.code, 0) << ended.output;
  EXPECT_THAT(ended.output, EndsWith("report      here/report.html\n"));
  EXPECT_THAT(ended.output, HasSubstr("\npackets     "));
  const std::string report = bytes_of(folder_ + "/here/report.html");
  const std::string texts = std::regex_replace(report, std::regex("</?a[^>]*>"), "");  // without links
  const std::string counts =
      run("outcomes here/pond.lcm --format csv").output;  // one pair, so one row an outcome
  std::istringstream rows(counts.substr(counts.find('\n') + 1));
  std::string from, to, outcome, packets;
  int found = 0;
  for (; std::getline(rows, from, ',') && std::getline(rows, to, ',') && std::getline(rows, outcome, ',') &&
         std::getline(rows, packets);
       ++found)
    EXPECT_THAT(texts, HasSubstr(" " + outcome + "</td><td class=\"number\">" + packets + "</td>"));
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
    EXPECT_THAT(again.output, HasSubstr("here/pond.lcm is there already; --force replaces it"));
    EXPECT_EQ(bytes_of(folder_ + "/here/pond.lcm"), first);
  }
  EXPECT_EQ(run("run pond.toml --duration 2 --no-csv --out here --force").code, 0);
  EXPECT_GT(fs::file_size(folder_ + "/here/pond.lcm"), first.size());
}

TEST_F(RunCommand, AMeasuredChannelThatItsLibraryDiesOfIsRefused) {
  const std::string channel = testing::write_channel_file(testing::channel_file(4, 1, 2), "no_names.mat");
  testing::lose_names(channel);
  for (const std::string command : {"config", "run"}) {
    const Ended end = run(command + " pond.toml --set 'propagation.replay=\"" + channel + "\"'");
    EXPECT_EQ(end.code, 2) << command;
    EXPECT_THAT(end.output, HasSubstr(channel + " is damaged: the library that reads it crashes on it"));
  }
}

TEST_F(RunCommand, APartOfARotatedLogIsALogToo) {
  fs::create_directory(folder_ + "/here");
  std::ofstream(folder_ + "/here/pond.0003.lcm") << "the newest parts alone are kept";
  const Ended end = run("run pond.toml --duration 1 --no-csv --log here/pond.lcm");
  EXPECT_EQ(end.code, 2);
  EXPECT_THAT(end.output, HasSubstr("here/pond.0003.lcm is there already"));
}

// Each command that writes files beside `run`, and what it writes into made/.
struct Writer {
  const char* arguments;
  std::vector<std::string> files;
};

const std::vector<Writer>& writers() {
  static const std::vector<Writer> kWriters{
      {"replay here/pond.lcm --log made/again.lcm --quiet",
       {"again.lcm", "again.toml", "again.comparison.csv", "again.comparison.json"}},
      {"report here/pond.lcm --out made/page.html", {"page.html"}},
      {"log export here/pond.lcm --out made/csv", {"csv"}},
      {"log export here/pond.lcm --out made/run.mcap --format mcap", {"run.mcap"}},
      {"log export here/pond.lcm --out made/run.nc --format netcdf", {"run.nc"}},
      {"log export here/pond.lcm --out made/run.gpx --format gpx --origin 43.5,7.25", {"run.gpx"}},
      {"log export here/pond.lcm --out made/run.json --format geojson --origin 43.5,7.25", {"run.json"}},
      {"log output here/pond.lcm --out made/output.lcm", {"output.lcm"}},
      {"outcomes here/pond.lcm --plot made/outcomes.svg", {"outcomes.svg"}},
      {"link pond.toml --from a --to b --arrivals --plot made/link.svg", {"link.svg"}},
      {"arrivals --sound-speed-mps 1500 --bottom-depth-m 100 --source-depth-m 30 --receiver-depth-m 50 "
       "--range-m 2000 --out made/paths.csv --plot made/paths.svg",
       {"paths.csv", "paths.svg"}},
      {"calc sound-speed table.csv --model mackenzie --out made/table.csv", {"table.csv"}},
      {"vehicle replay --model torpedo --duration-s 1 --out made/vehicle.csv", {"vehicle.csv"}},
      {"sweep pond.toml --axis environment.wind_mps=2,5 --out made/wind --slurm made/wind.sh", {"wind.sh"}},
  };
  return kWriters;
}

TEST_F(RunCommand, NoCommandReplacesWhatIsThereButByForce) {
  ASSERT_EQ(run("run pond.toml --duration 20 --out here --quiet").code, 0);
  std::ofstream(folder_ + "/table.csv") << "T_degC,S_ppt,depth_m\n25,35,1000\n";
  fs::create_directory(folder_ + "/made");
  for (const Writer& writer : writers()) {
    const Ended first = run(writer.arguments);
    ASSERT_EQ(first.code, 0) << writer.arguments << "\n" << first.output;
    for (const std::string& name : writer.files) {
      const std::string path = folder_ + "/made/" + name, file = fs::is_directory(path) ? path + "/x" : path;
      for (const std::string& other : writer.files) fs::remove_all(folder_ + "/made/" + other);
      if (file != path) fs::create_directory(path);
      std::ofstream(file) << "an earlier result";
      const Ended second = run(writer.arguments);
      EXPECT_EQ(second.code, 2) << writer.arguments;
      EXPECT_THAT(second.output, HasSubstr("made/" + name + " is there already; --force replaces it"))
          << writer.arguments;
      EXPECT_EQ(bytes_of(file), "an earlier result") << writer.arguments;
      const Ended forced = run(writer.arguments + std::string(" --force"));
      EXPECT_EQ(forced.code, 0) << writer.arguments << "\n" << forced.output;
      for (const std::string& made : writer.files)
        EXPECT_TRUE(fs::exists(folder_ + "/made/" + made)) << writer.arguments;
      if (file == path) {
        EXPECT_NE(bytes_of(file), "an earlier result") << writer.arguments;
      }
    }
  }
}

TEST_F(RunCommand, WhatIsReadIsNeverWritten) {
  const std::string scenario = bytes_of(folder_ + "/pond.toml");
  std::ofstream(folder_ + "/pond.html") << scenario;
  for (const char* command : {"run pond.toml --duration 1 --no-csv --log pond.toml --force",
                              "run pond.html --duration 1 --no-csv --log pond.lcm --force"}) {
    EXPECT_EQ(run(command).code, 2) << command;
    EXPECT_EQ(bytes_of(folder_ + "/pond.toml"), scenario);
    EXPECT_EQ(bytes_of(folder_ + "/pond.html"), scenario);
  }
  ASSERT_EQ(run("run pond.toml --duration 20 --out here --quiet --no-csv").code, 0);
  const std::string log = bytes_of(folder_ + "/here/pond.lcm");
  for (const char* command : {"replay here/pond.lcm --log here/../here/pond.lcm --force",
                              "log output here/pond.lcm --out here/pond.lcm --force",
                              "log export here/pond.lcm --format mcap --out here/pond.lcm --force",
                              "report here/pond.lcm --out here/pond.lcm --force"}) {
    EXPECT_EQ(run(command).code, 2) << command;
    EXPECT_EQ(bytes_of(folder_ + "/here/pond.lcm"), log) << command;
  }
}

// The configuration beside the log would be the modem's file.
TEST_F(RunCommand, WhatTheScenarioNamesIsNeverWritten) {
  const std::string modem = "family = \"own\"\nsource_level_db = 175\n";
  std::ofstream(folder_ + "/modem.toml") << modem;
  for (const char* place : {"--log modem.lcm", "--log modem.toml"}) {
    const Ended ended = run("run pond.toml --duration 1 --no-csv --force --set modem.profile=modem.toml " +
                            std::string(place));
    EXPECT_EQ(ended.code, 2) << ended.output;
    EXPECT_EQ(bytes_of(folder_ + "/modem.toml"), modem);
  }
  ASSERT_EQ(run("run pond.toml --duration 20 --no-csv --out here").code, 0);
  EXPECT_THAT(run("replay here/pond.lcm --log modem.lcm --force --set modem.profile=modem.toml").output,
              HasSubstr("modem.toml is what is read"));
  EXPECT_EQ(bytes_of(folder_ + "/modem.toml"), modem);
}

// The log holds the configuration that it was made with, overrides too.
TEST_F(RunCommand, ALogMayLieBesideItsScenarioUnderItsName) {
  const std::string scenario = bytes_of(folder_ + "/pond.toml");
  const Ended made = run("run pond.toml --duration 30 --seed 5 --no-csv --log pond.lcm");
  EXPECT_EQ(made.code, 0) << made.output;
  EXPECT_EQ(bytes_of(folder_ + "/pond.toml"), scenario);
  EXPECT_EQ(run("run pond.toml --duration 30 --seed 5 --no-csv --log ./pond.lcm").code, 2);  // a log is there
  const Ended again = run("replay pond.lcm --log again.lcm");
  EXPECT_EQ(again.code, 0) << again.output;
  EXPECT_THAT(again.output, HasSubstr(": 0 changed their outcome"));
  EXPECT_EQ(run("replay again.lcm --scenario pond.toml --log pond.lcm").code, 2);
  EXPECT_EQ(bytes_of(folder_ + "/pond.toml"), scenario);
}

// A bay whose every file is its own: modem with another rate, vehicle, cast, noise, terrain.
void write_bay(const fs::path& bay) {
  fs::create_directories(bay / "modems");
  std::ofstream(bay / "modems/own.toml")
      << "family = \"own\"\nsource_level_db = 175\nrates = \"../fast.toml janus\"\n";
  std::ofstream(bay / "fast.toml") << "family = \"own\"\nbit_rate_bps = 1000\nrate_number = 7\n";
  std::ofstream(bay / "auv.toml") << "based_on = \"torpedo\"\nname = \"own auv\"\n";
  std::ofstream(bay / "cast.csv") << "depth_m,temperature_degC,salinity_psu\n0,18,35\n60,12,35\n";
  std::ofstream(bay / "noise.csv") << "t_s,frequency_khz,level_db\n0,1,70\n0,100,40\n";
  std::ofstream ground(bay / "ground.asc");
  ground << "ncols 5\nnrows 5\nxllcorner -2500\nyllcorner -2500\ncellsize 1000\n";
  for (int i = 0; i < 25; ++i) ground << "-60 ";
  std::ofstream(bay / "bay.toml")
      << "[scenario]\nname = \"bay\"\nduration_s = 40\n[modem]\nprofile = \"modems/own.toml\"\n"
         "[environment]\nprofile = \"file\"\nprofile_file = \"cast.csv\"\nnoise_file = \"noise.csv\"\n"
         "[terrain]\nkind = \"raster\"\nsize_north_m = 2000\nsize_east_m = 2000\n"
         "[terrain.raster]\npath = \"ground.asc\"\ncoordinate_system = \"local\"\n"
         "[[vehicle]]\nname = \"a\"\nid = 1\nmodel = \"auv.toml\"\nstart_ned_m = [0.0, 0.0, 20.0]\n"
         "[[vehicle]]\nname = \"b\"\nid = 2\nmodel = \"fixed\"\nstart_ned_m = [0.0, 300.0, 20.0]\n"
         "[vehicle.traffic]\nperiod_s = 5\npayload_bytes = 4\n";
}

TEST_F(RunCommand, ALogReplaysWhereNoneOfItsFilesIs) {
  write_bay(folder_ + "/bay");
  fs::create_directories(folder_ + "/away/tmp");
  const Ended made = run("run bay/bay.toml --log bay/made.lcm --no-csv --set modem.source_level_db=180");
  ASSERT_EQ(made.code, 0) << made.output;
  fs::rename(folder_ + "/bay/made.lcm", folder_ + "/away/made.lcm");
  fs::remove_all(folder_ + "/bay");
  folder_ += "/away";
  for (const std::string log : {"made", "again"}) {
    const std::string next = log == "made" ? "again" : "third";
    const Ended replayed = run("replay " + log + ".lcm --log " + next + ".lcm");
    EXPECT_EQ(replayed.code, 0) << replayed.output;
    EXPECT_THAT(replayed.output, HasSubstr(": 0 changed their outcome")) << replayed.output;
    EXPECT_EQ(run("report " + log + ".lcm --out " + log + ".html").code, 0);
  }
  EXPECT_EQ(run("compare made.lcm again.lcm").code, 0);
  EXPECT_THAT(bytes_of(folder_ + "/made.html"), HasSubstr("It carries the files that it names."));
  EXPECT_THAT(bytes_of(folder_ + "/made.html"), Not(HasSubstr("[[file]]")));
  // The configuration beside the log is whole as well, and nothing stays in the folder of temporary files.
  const Ended config = run("config again.toml");
  EXPECT_EQ(config.code, 0) << config.output;
  EXPECT_TRUE(fs::is_empty(folder_ + "/tmp"));
  folder_ = fs::path(folder_).parent_path().string();
}

// A raster above 1 MB.
TEST_F(RunCommand, ALargeFileIsNamedByItsPlaceAndMissedByIt) {
  write_bay(folder_ + "/bay");
  std::ofstream ground(folder_ + "/bay/ground.asc");
  ground << "ncols 700\nnrows 700\nxllcorner -2500\nyllcorner -2500\ncellsize 7.142857142857143\n";
  for (int i = 0; i < 490'000; ++i) ground << "-60 ";
  ground.close();
  ASSERT_EQ(run("run bay/bay.toml --log away/made.lcm --no-csv --no-report --quiet").code, 0);
  EXPECT_EQ(run("replay away/made.lcm --log away/1.lcm").code, 0);
  std::ofstream(folder_ + "/bay/ground.asc", std::ios::app) << " ";
  EXPECT_THAT(run("replay away/made.lcm --log away/2.lcm").output,
              HasSubstr("it is another file than the one of"));
  fs::rename(folder_ + "/bay/ground.asc", folder_ + "/away/moved.asc");
  const Ended missed = run("replay away/made.lcm --log away/3.lcm");
  EXPECT_EQ(missed.code, 2);
  EXPECT_THAT(missed.output, HasSubstr("terrain.raster.path is 'ground.asc'; cannot read"));
  EXPECT_THAT(missed.output, HasSubstr("bay/ground.asc: there is no such file; a file of 19"));
  EXPECT_EQ(run("replay away/made.lcm --log away/4.lcm --set terrain.raster.path=away/moved.asc").code, 0);
}

TEST_F(RunCommand, APathOfTheCommandLineStartsAtTheWorkingDirectory) {
  fs::create_directory(folder_ + "/casts");
  std::ofstream(folder_ + "/here.csv") << "depth_m,temperature_degC,salinity_psu\n0,18,35\n60,12,35\n";
  fs::rename(folder_ + "/pond.toml", folder_ + "/casts/pond.toml");
  const Ended found =
      run("config casts/pond.toml --set environment.profile=file --set environment.profile_file=here.csv");
  EXPECT_EQ(found.code, 0) << found.output;
  EXPECT_THAT(found.output,
              HasSubstr("profile_file = \"" + fs::canonical(folder_ + "/here.csv").string() + "\""));
  EXPECT_EQ(run("config casts/pond.toml --set modem.profile=janus").code, 0);
}

TEST_F(RunCommand, NumbersOutOfRangeAreShownShort) {
  for (const std::string& arguments :
       {std::string("run pond.toml --duration 1e300"),
        std::string("config pond.toml --set scenario.duration_s=1e300"),
        "config pond.toml --set scenario.duration_s=1" + std::string(300, '0')}) {
    const Ended refused = run(arguments);
    EXPECT_EQ(refused.code, 2) << arguments;
    EXPECT_LT(refused.output.size(), 400u) << refused.output;
  }
}

TEST_F(RunCommand, DevicesAndEmptyFilesAreWritten) {
  ASSERT_EQ(run("run pond.toml --duration 1 --out here --quiet --no-csv").code, 0);
  std::ofstream(folder_ + "/empty.html").close();
  EXPECT_EQ(run("report here/pond.lcm --out /dev/null").code, 0);
  EXPECT_EQ(run("report here/pond.lcm --out empty.html").code, 0);
}

TEST_F(RunCommand, TheOriginOfAnExportIsThatOfTheScenario) {
  ASSERT_EQ(
      run("run pond.toml --duration 1 --out placed --quiet --no-csv --set scenario.origin_latitude_deg=43.5")
          .code,
      0);
  for (const char* format : {"gpx", "geojson"}) {
    const Ended end =
        run("log export placed/pond.lcm --out placed." + std::string(format) + " --format " + format);
    EXPECT_EQ(end.code, 0) << end.output;
    EXPECT_THAT(bytes_of(folder_ + "/placed." + format), HasSubstr("43.5"));
  }
  ASSERT_EQ(
      run("run pond.toml --duration 1 --out zero --quiet --no-csv --set scenario.origin_latitude_deg=0").code,
      0);
  EXPECT_EQ(run("log export zero/pond.lcm --out zero.gpx --format gpx").code, 0);
  EXPECT_THAT(bytes_of(folder_ + "/zero.gpx"), HasSubstr("lat=\"0.00"));
  ASSERT_EQ(run("run pond.toml --duration 1 --out nowhere --quiet --no-csv").code, 0);
  const Ended end = run("log export nowhere/pond.lcm --out nowhere.gpx --format gpx");
  EXPECT_EQ(end.code, 2);
  EXPECT_THAT(end.output, HasSubstr("--origin LATITUDE,LONGITUDE"));
  ASSERT_EQ(run("replay nowhere/pond.lcm --log again.lcm --quiet").code,
            0);  // from the configuration beside it
  EXPECT_EQ(run("log export again.lcm --out nowhere.gpx --format gpx").code, 2);
}

TEST_F(RunCommand, ForceLeavesNothingOfAnEarlierExport) {
  ASSERT_EQ(run("run pond.toml --duration 20 --out here --quiet").code, 0);
  ASSERT_TRUE(fs::exists(folder_ + "/here/csv/outcome.csv"));
  std::ofstream(folder_ + "/here/csv/notes.csv") << "mine";
  EXPECT_EQ(run("log export here/pond.lcm --out here/csv --channel CLOCK --force").code, 0);
  EXPECT_FALSE(fs::exists(folder_ + "/here/csv/outcome.csv"));
  EXPECT_TRUE(fs::exists(folder_ + "/here/csv/clock.csv"));
  EXPECT_TRUE(fs::exists(folder_ + "/here/csv/notes.csv"));
}

TEST_F(RunCommand, ARunThatIsRefusedLeavesNoFolder) {
  EXPECT_EQ(run("run pond.toml --set 'vehicle.0.start_ned_m=[0.0,0.0,500.0]'").code, 2);
  EXPECT_FALSE(fs::exists(folder_ + "/results"));
}

// Where each program is started by hand, the one that makes the terrain checks the starts on it.
TEST_F(RunCommand, ALogIsNotCalledAsWhatLiesBesideIt) {
  for (const std::string log : {"a.html", "a.toml", "b/csv/packets.csv"}) {
    const Ended refused = run("run pond.toml --duration 1 --log " + log);
    EXPECT_EQ(refused.code, 2) << log;
    EXPECT_THAT(refused.output, HasSubstr("allowed is another name"));
  }
}

TEST_F(RunCommand, NanIsNoNumberOfAnyOption) {
  for (const std::string arguments :
       {"run pond.toml --duration nan", "run pond.toml --rate -NaN", "sweep pond.toml --out s --duration nan",
        "outcomes a.lcm --window-s nan"}) {
    const Ended refused = run(arguments);
    EXPECT_EQ(refused.code, 2) << arguments;
    EXPECT_THAT(refused.output, HasSubstr("is no number"));
  }
}

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
                "to do here", "pond.toml", SIGINT);
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
