// SPDX-License-Identifier: BSD-3-Clause
// The working directory of a test that reads or writes files by relative paths.
#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

namespace halocline::testing {

// Works in `folder` as long as it exists.
class WorkingFolder {
 public:
  explicit WorkingFolder(const std::filesystem::path& folder) { std::filesystem::current_path(folder); }
  ~WorkingFolder() { std::filesystem::current_path(before_); }
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;

 private:
  std::filesystem::path before_ = std::filesystem::current_path();
};

// Works in a new folder that is removed with all files in it.
class TemporaryFolder {
 public:
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }

 private:
  static std::filesystem::path made() {
    const std::filesystem::path path = ::testing::TempDir() + "halocline-folder-" + std::to_string(getpid());
    std::filesystem::create_directories(path);
    return path;
  }
  std::filesystem::path path_ = made();
  WorkingFolder working_{path_};
};

}  // namespace halocline::testing
