// SPDX-License-Identifier: BSD-3-Clause
#include "bus/logs/log_parts.h"

#include <cstdio>
#include <filesystem>
#include <utility>

#include <stdio_ext.h>
#include <unistd.h>

#include "bus/logs/log_series.h"
#include "core/check.h"

namespace halocline::bus {
namespace {

constexpr std::int64_t kHeaderBytes = 28;  // sync word, number, time stamp, two lengths

void remove_earlier_series(const std::string& path) {
  for (const std::string& part : parts_of_log(path)) {
    std::error_code stays;  // a remaining file would be read as a part of this log
    require(std::filesystem::remove(part, stays), "cannot replace " + part + ", a part of an earlier log");
  }
}

}  // namespace

LogParts::LogParts(const std::string& path, const LogRotation& rotation, LogStart start)
    : path_(path), rotation_(rotation) {
  require(rotation.part_bytes >= 0 && rotation.part_time >= SimDuration() && rotation.parts_kept >= 0,
          "sizes, times and numbers of a log's parts must not be negative");
  require(start == LogStart::kReplace || !rotation.rotates(), "a log in parts cannot be appended to");
  require(open_part(0, start), "cannot write the log " + path);
  if (start == LogStart::kReplace) remove_earlier_series(path);
  if (rotation_.part_time > SimDuration()) part_ends_ = SimTime() + rotation_.part_time;
}

bool LogParts::open_part(int part, LogStart start) {
  file_ = std::make_unique<lcm::LogFile>(part_of_log(path_, part), start == LogStart::kAppend ? "a" : "w");
  part_ = part;
  part_bytes_ = sound_bytes_ = 0;
  if (!file_->good()) file_.reset();
  if (file_ && fseeko(file_->getFilePtr(), 0, SEEK_END) == 0) sound_bytes_ = ftello(file_->getFilePtr());
  return file_ != nullptr;
}

bool LogParts::flush() {
  if (!file_) return !is_refused_;
  std::FILE* file = file_->getFilePtr();
  if (std::fflush(file) != 0) is_refused_ = true;
  if (is_refused_) take_back();
  sound_bytes_ = ftello(file);
  return !std::exchange(is_refused_, false);
}

// A device cannot be truncated and stays unchanged.
void LogParts::take_back() {
  failed_ = true;
  std::FILE* file = file_->getFilePtr();
  __fpurge(file);
  std::clearerr(file);
  [[maybe_unused]] const int ignored = ftruncate(fileno(file), sound_bytes_);
  fseeko(file, sound_bytes_, SEEK_SET);
}

void LogParts::close() {
  if (!flush()) failed_ = true;
  file_.reset();
}

void LogParts::rotate_before(SimTime stamp, std::int64_t bytes) {
  const bool too_long =
      rotation_.part_bytes > 0 && part_bytes_ > 0 && part_bytes_ + bytes > rotation_.part_bytes;
  if (!too_long && stamp < part_ends_) return;
  if (stamp >= part_ends_) part_ends_ = next_on_grid(stamp, rotation_.part_time);
  close();
  if (!open_part(part_ + 1, LogStart::kReplace)) failed_ = is_refused_ = true;
  std::error_code stays;  // ignored: no reason to stop a run
  if (rotation_.parts_kept > 0 && part_ >= rotation_.parts_kept)
    std::filesystem::remove(part_of_log(path_, part_ - rotation_.parts_kept), stays);
}

void LogParts::write(lcm::LogEvent event) {
  if (!file_) {
    is_refused_ = true;
    return;
  }
  const std::int64_t bytes = kHeaderBytes + static_cast<std::int64_t>(event.channel.size()) + event.datalen;
  if (rotation_.rotates()) rotate_before(SimTime::from_utime(event.timestamp), bytes);
  if (!file_) return;
  event.eventnum = events_++;
  if (file_->writeEvent(&event) != 0) is_refused_ = true;
  part_bytes_ += bytes;
}

}  // namespace halocline::bus
