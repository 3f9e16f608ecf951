// SPDX-License-Identifier: BSD-3-Clause
#include "core/atomic_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace halocline {
namespace {

void check(bool done, const std::string& path) {
  if (!done) throw std::runtime_error("cannot write " + path + ": " + std::strerror(errno));
}

// Forces a file or a folder to disk.
void force_to_disk(const std::string& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  check(descriptor >= 0, path);
  const bool done = fsync(descriptor) == 0;
  const int error = errno;
  close(descriptor);
  errno = error;
  check(done, path);
}

}  // namespace

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  std::error_code error;
  if (std::filesystem::is_symlink(path_, error)) {
    const auto target = std::filesystem::canonical(path_, error);
    if (!error) path_ = target.string();
  }
  temporary_path_ = path_;
  const std::filesystem::file_status status = std::filesystem::status(path_, error);
  if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status))
    temporary_path_ += ".unfinished";
}

AtomicFile::~AtomicFile() {
  if (!committed_ && !is_direct()) std::remove(temporary_path().c_str());
}

void AtomicFile::commit() {
  if (is_direct()) return;
  force_to_disk(temporary_path());
  check(std::rename(temporary_path().c_str(), path_.c_str()) == 0, path_);
  committed_ = true;
  const std::string folder = std::filesystem::path(path_).parent_path().string();
  force_to_disk(folder.empty() ? "." : folder);
}

void replace_file(const std::string& path, std::string_view content) {
  AtomicFile file(path);
  std::ofstream out(file.temporary_path(), std::ios::binary);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  check(!out.fail(), path);
  file.commit();
}

}  // namespace halocline
