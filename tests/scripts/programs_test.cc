// SPDX-License-Identifier: BSD-3-Clause
// What the programs link, and what all of them do with the files and numbers of their command lines.
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/process.h"

namespace halocline::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// GDAL brings 70 shared libraries and netCDF 40, which takes 80 ms at each start; modules load them where
// they are used.
TEST(Programs, LinkNeitherGdalNorNetcdf) {
  for (const char* program :
       {"halocline", "halocline-autopilot", "halocline-bathymetry", "halocline-channel-server",
        "halocline-conductor", "halocline-localiser", "halocline-modem-gateway", "halocline-network",
        "halocline-recorder", "halocline-traffic", "halocline-vehicle-sim"}) {
    Process ldd({"/usr/bin/ldd", std::string(HALOCLINE_BIN_DIR) + "/" + program});
    EXPECT_EQ(ldd.wait(), 0) << program;
    EXPECT_THAT(ldd.output(), HasSubstr("libc.so")) << program;
    EXPECT_THAT(ldd.output(), Not(HasSubstr("libgdal"))) << program;
    EXPECT_THAT(ldd.output(), Not(HasSubstr("libnetcdf"))) << program;
  }
}

std::string scratch(const std::string& name) {
  return ::testing::TempDir() + "programs-" + std::to_string(getpid()) + "-" + name;
}

std::string pipe_called(const std::string& name) {
  const std::string path = scratch(name);
  unlink(path.c_str());
  if (mkfifo(path.c_str(), 0600) != 0) throw std::runtime_error("no pipe " + path);
  return path;
}

const std::string kHalocline = std::string(HALOCLINE_BIN_DIR) + "/halocline";

// Nobody writes to the pipes: who opens one waits for ever.
TEST(Programs, NoFileThatAUserNamesIsWaitedFor) {
  const std::string table = pipe_called("pipe.csv"), any = pipe_called("pipe.nc"),
                    toml = pipe_called("pipe.toml"), out = scratch("out"),
                    scenario = std::string(HALOCLINE_SOURCE_DIR) + "/scenarios/ranging.toml";
  const std::vector<std::string> sea{kHalocline, "arrivals", "--bottom-depth-m", "100", "--range-m", "1000"};
  const auto with = [](std::vector<std::string> command, const std::vector<std::string>& more) {
    command.insert(command.end(), more.begin(), more.end());
    return command;
  };
  std::vector<std::vector<std::string>> commands{
      with(sea, {"--water", table}),
      with(sea, {"--water", any, "--latitude", "43", "--longitude", "7"}),
      {kHalocline, "arrivals", "--sound-speed-mps", "1500", "--range-m", "1", "--bottom", table},
      {kHalocline, "arrivals", "--sound-speed-mps", "1500", "--bottom-depth-m", "100", "--links", table},
      {kHalocline, "calc", "sound-speed", table},
      {kHalocline, "log", "info", any},
      {kHalocline, "outcomes", any},
      {kHalocline, "replay", any, "--log", out + ".lcm"},
      {kHalocline, "sweep", toml, "--out", out},
      {std::string(HALOCLINE_BIN_DIR) + "/halocline-bathymetry", toml}};
  for (const char* command : {"config", "run"}) commands.push_back({kHalocline, command, toml});
  commands.push_back({kHalocline, "link", toml, "--from", "a", "--to", "b"});
  for (const std::string& key :
       {"environment.profile_file='" + table + "'", "environment.profile_file='" + any + "'"})
    commands.push_back({kHalocline, "config", scenario, "--set", "environment.profile='file'", "--set", key});
  for (const std::string& key : {"ocean.file='" + any + "'", "environment.noise_file='" + table + "'",
                                 "vehicle.0.model='" + toml + "'", "vehicle.0.modem.profile='" + toml + "'",
                                 "propagation.replay='" + any + "'"})
    commands.push_back({kHalocline, "config", scenario, "--set", key});
  commands.push_back({kHalocline, "config", scenario, "--set", "terrain.kind='raster'", "--set",
                      "terrain.raster.path='" + any + "'"});
  for (const auto& command : commands) {
    Process process(command);
    const int code = process.wait();
    EXPECT_NE(code, 0) << command[1] << ' ' << command.back() << ": " << process.output();
    EXPECT_NE(code, -1) << "waits: " << command[1] << ' ' << command.back();
    EXPECT_THAT(process.output(), HasSubstr("it is a pipe")) << command[1] << ' ' << command.back();
  }
}

TEST(Programs, ArrivalsSayWhatARangeMayBe) {
  const auto said = [](const std::string& range_m) {
    Process process({kHalocline, "arrivals", "--sound-speed-mps", "1500", "--bottom-depth-m", "100",
                     "--source-depth-m", "10", "--receiver-depth-m", "60", "--range-m", range_m});
    process.wait();
    return process.output();
  };
  EXPECT_THAT(said("-5"), HasSubstr("range is -5 m; allowed is 0 and more"));
  EXPECT_THAT(said("0"), HasSubstr("note: at a range of 0 m paths steeper than 80 degrees were not searched; "
                                   "--max-launch-angle-deg 90 searches all"));
  EXPECT_THAT(said("1000"), Not(HasSubstr("note:")));
}

}  // namespace
}  // namespace halocline::testing
