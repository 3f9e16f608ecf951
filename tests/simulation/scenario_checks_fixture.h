// SPDX-License-Identifier: BSD-3-Clause
// Scenarios as texts, and what the sanity checks find in them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "bus/config/config.h"
#include "core/atomic_file.h"
#include "simulation/composition.h"

namespace halocline::clients {

// Lines that a scenario is refused for, and lines that it is warned of.
struct Findings {
  std::vector<std::string> errors, warnings;
};

class ScenarioChecks : public ::testing::Test {
 protected:
  ScenarioChecks() { std::filesystem::create_directories(folder_); }
  ~ScenarioChecks() override { std::filesystem::remove_all(folder_); }

  Findings findings_in(const std::string& text) {
    replace_file(folder_ + "/sea.toml", text);
    try {
      return {{}, load_checked(folder_ + "/sea.toml", {}).warnings};
    } catch (const bus::ConfigErrors& errors) {
      return {errors.lines(), {}};
    }
  }
  // A flat bottom at 100 m, 4 km by 4 km, and one vehicle 20 m deep; `more` goes on in its table.
  std::vector<std::string> errors_with(const std::string& more, const std::string& model = "torpedo") {
    return findings_in(vehicle_with(more, model)).errors;
  }
  static std::string vehicle_with(const std::string& more, const std::string& model = "torpedo") {
    return "[[vehicle]]\nname = \"auv\"\nid = 1\nmodel = \"" + model + "\"\n" +
           (more.find("start_ned_m") == std::string::npos ? "start_ned_m = [0.0, 0.0, 20.0]\n" : "") + more;
  }

  // [terrain] of a raster of 100 m, 1 km by 1 km.
  [[nodiscard]] std::string level_raster() const {
    replace_file(folder_ + "/level.asc",
                 "ncols 2\nnrows 2\nxllcorner -1000\nyllcorner -1000\ncellsize 1000\n-100 -100\n-100 -100\n");
    return "[terrain]\nkind = \"raster\"\nwhole_file = true\n[terrain.raster]\npath = \"level.asc\"\n"
           "coordinate_system = \"local\"\n";
  }

  std::string folder_ = ::testing::TempDir() + "checks-" + std::to_string(getpid());
};

}  // namespace halocline::clients
