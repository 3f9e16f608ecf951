// SPDX-License-Identifier: BSD-3-Clause
// A file of the process in memory (/dev/shm), for readers that take a path.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <unistd.h>

namespace halocline::fuzz {

class ScratchFile {
 public:
  // `ending`: of its name, such as ".lcm".
  explicit ScratchFile(const std::string& ending)
      : folder_("/dev/shm/halocline-fuzz-" + std::to_string(getpid())), path_(folder_ + "/input" + ending) {
    std::filesystem::create_directories(folder_);
  }
  // With all files that a reader left beside it.
  ~ScratchFile() { std::filesystem::remove_all(folder_); }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  // Replaces it.
  const std::string& write(std::string_view bytes) {
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
    return path_;
  }
  const std::string& path() const { return path_; }

 private:
  std::string folder_, path_;
};

}  // namespace halocline::fuzz
