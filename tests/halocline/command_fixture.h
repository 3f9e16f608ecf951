// SPDX-License-Identifier: BSD-3-Clause
// The command `halocline` in a folder of the test's own, with a scenario of two vehicles.
#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/process.h"

namespace halocline::testing {

inline const std::string kProgram = HALOCLINE_BIN_DIR "/halocline";

inline std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class RunCommand : public ::testing::Test {
 protected:
  RunCommand() {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ + "/pond.toml")
        << "[scenario]\nname = \"pond\"\nduration_s = 600\n"
           "[[vehicle]]\nname = \"a\"\nid = 1\nstart_ned_m = [0.0, 0.0, 20.0]\n"
           "[[vehicle]]\nname = \"b\"\nid = 2\nstart_ned_m = [0.0, 50.0, 20.0]\n"
           "[vehicle.traffic]\nperiod_s = 5\n";
  }
  ~RunCommand() override { std::filesystem::remove_all(folder_); }

  struct Ended {
    int code;
    std::string output;
  };
  // With the test's folder as the working folder, and its folder tmp, if it has one, for temporary files.
  std::vector<std::string> command(const std::string& arguments) const {
    return {"/bin/sh", "-c",
            "cd '" + folder_ + "' && [ ! -d tmp ] || export TMPDIR=$PWD/tmp; exec '" + kProgram + "' " +
                arguments};
  }
  Ended run(const std::string& arguments) {
    Process process(command(arguments));
    const int code = process.wait();
    return {code, process.output()};
  }
  // A command for each that reads a log.
  std::vector<std::string> readers(const std::string& log) const {
    std::vector<std::string> all{"log info " + log,
                                 "log info --json " + log,
                                 "outcomes " + log,
                                 "outcomes --format json " + log,
                                 "compare " + log + " " + log,
                                 "report --force --out x.html " + log,
                                 "log export --force --out x.csv " + log,
                                 "log output --force --out x.lcm " + log,
                                 "replay --force --scenario pond.toml --log x/replayed.lcm " + log};
    for (const char* format : {"mcap", "netcdf", "geojson", "gpx"})
      all.push_back(std::string("log export --force --origin 1,1 --out x.bin --format ") + format + " " +
                    log);
    return all;
  }
  // Signals once `text` is in the output and `file` holds something.
  Ended run_until(const std::string& arguments, const std::string& text, const std::string& file,
                  int signal) {
    Process process(command(arguments));
    while (process.running()) {
      std::error_code error;
      const auto size = std::filesystem::file_size(folder_ + "/" + file, error);
      if (process.output().find(text) != std::string::npos && !error && size > 0) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    process.signal(signal);
    const int code = process.wait();
    return {code, process.output()};
  }

  std::string folder_ = ::testing::TempDir() + "run-" + std::to_string(getpid());
};

}  // namespace halocline::testing
