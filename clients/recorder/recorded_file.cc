// SPDX-License-Identifier: BSD-3-Clause
#include "clients/recorder/recorded_file.h"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "bus/logs/log_parts.h"
#include "core/check.h"

namespace halocline::clients {
namespace {

namespace fs = std::filesystem;

// Returns the size of the file, bytes; 0 when it does not exist.
std::uintmax_t size_of(const std::string& path) {
  std::error_code none;
  const std::uintmax_t size = fs::file_size(path, none);
  return none ? 0 : size;
}

// Returns a descriptor that locks the file until it is closed. On a file system without locks the file is not
// locked.
int lock_of(const std::string& path) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666);
  require(file >= 0, "cannot write the log " + path + ": " + std::strerror(errno));
  if (flock(file, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return file;
  close(file);
  throw InvalidArgument("another recorder writes " + path + "; allowed is another file");
}

void take_off_what_is_cut_short(const std::string& path, const LogReader& log) {
  if (log.bad_stretches().empty() || !log.bad_stretches().back().cut_short) return;
  std::error_code stays;  // on an error, the end counts as damage of the log
  fs::resize_file(path, static_cast<std::uintmax_t>(log.bad_stretches().back().offset), stays);
}

}  // namespace

RecordedFile::RecordedFile(std::string path, Existing existing)
    : path_(std::move(path)), existing_(existing) {
  require(!path_.empty(), "--log is missing: the file to write");
  std::error_code none;
  const fs::file_status status = fs::status(path_, none);
  require(!fs::exists(status) || fs::is_regular_file(status),
          path_ + " is no file that a log could be written to");
  const bool is_there = size_of(path_) > 0;
  require(!is_there || existing != Existing::kRefuse,
          path_ + " is there already; --force replaces it, --append goes on behind it");
  if (!is_there && existing == Existing::kAppend) existing_ = Existing::kReplace;
  lock_ = lock_of(path_);
}

RecordedFile::~RecordedFile() { close(lock_); }

void RecordedFile::read(const std::function<void(const LoggedEvent&)>& take) const {
  LogReader log(std::vector<std::string>{path_});
  for (LoggedEvent event; log.next(event);) take(event);
  take_off_what_is_cut_short(path_, log);
}

bus::LogRecorder& RecordedFile::log() {
  if (!log_) {
    const auto start = goes_on() ? bus::LogStart::kAppend : bus::LogStart::kReplace;
    log_.emplace(path_, bus::LogRotation(), start);
  }
  return *log_;
}

}  // namespace halocline::clients
