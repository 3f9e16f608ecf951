// SPDX-License-Identifier: BSD-3-Clause
#include "bus/logs/log_parts.h"

#include <cstdio>
#include <filesystem>

#include "bus/logs/log_series.h"
#include "core/check.h"

namespace halocline::bus {
namespace {

constexpr std::int64_t kHeaderBytes = 28;  // word, number, stamp, two lengths

void remove_earlier_series(const std::string& path) {
  for (const std::string& part : parts_of_log(path)) {
    std::error_code stays;  // then it would be read as a part of this log
    require(std::filesystem::remove(part, stays), "cannot replace " + part + ", a part of an earlier log");
  }
}

}  // namespace

LogParts::LogParts(const std::string& path, const LogRotation& rotation) : path_(path), rotation_(rotation) {
  require(rotation.part_bytes >= 0 && rotation.part_time >= SimDuration() && rotation.parts_kept >= 0,
          "sizes, times and numbers of a log's parts must not be negative");
  require(open_part(0), "cannot write the log " + path);
  remove_earlier_series(path);
  if (rotation_.part_time > SimDuration()) part_ends_ = SimTime() + rotation_.part_time;
}

bool LogParts::open_part(int part) {
  file_ = std::make_unique<lcm::LogFile>(part_of_log(path_, part), "w");
  part_ = part;
  part_bytes_ = 0;
  if (!file_->good()) file_.reset();
  return file_ != nullptr;
}

void LogParts::close() {
  if (!file_) return;
  if (std::fflush(file_->getFilePtr()) != 0) failed_ = true;
  file_.reset();
}

void LogParts::rotate_before(SimTime stamp, std::int64_t bytes) {
  const bool too_long =
      rotation_.part_bytes > 0 && part_bytes_ > 0 && part_bytes_ + bytes > rotation_.part_bytes;
  if (!too_long && stamp < part_ends_) return;
  if (stamp >= part_ends_) part_ends_ = next_on_grid(stamp, rotation_.part_time);
  close();
  if (!open_part(part_ + 1)) failed_ = true;
  std::error_code stays;  // no reason to stop a run
  if (rotation_.parts_kept > 0 && part_ >= rotation_.parts_kept)
    std::filesystem::remove(part_of_log(path_, part_ - rotation_.parts_kept), stays);
}

void LogParts::write(lcm::LogEvent event) {
  if (!file_) return;
  const std::int64_t bytes = kHeaderBytes + static_cast<std::int64_t>(event.channel.size()) + event.datalen;
  if (rotation_.rotates()) rotate_before(SimTime::from_utime(event.timestamp), bytes);
  if (!file_) return;
  event.eventnum = events_++;
  if (file_->writeEvent(&event) != 0) failed_ = true;
  part_bytes_ += bytes;
}

}  // namespace halocline::bus
