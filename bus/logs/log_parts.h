// SPDX-License-Identifier: BSD-3-Clause
// Writer of a log in one or several files: events in order, divided into parts.
//
// With rotation a log is a series of files (log_series.h), each a complete LCM log (LCM numbers the events of
// each file from 0). A new part begins before an event that would make the current one longer than
// `part_bytes`, and at multiples of `part_time`, so the same events are always divided at the same places.
// Not thread-safe.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <lcm/lcm-cpp.hpp>

#include "core/sim_time.h"

namespace halocline::bus {

// Rule for beginning the next part of a log, and the number of parts kept. All 0: one file of any length.
struct LogRotation {
  std::int64_t part_bytes = 0;  // 0: any size
  SimDuration part_time;        // 0: any time
  int parts_kept = 0;           // number of newest parts that are kept; 0: all

  bool rotates() const { return part_bytes > 0 || part_time > SimDuration(); }
};

// kReplace: replaces the existing file, and deletes the parts of an earlier series of that name. kAppend:
// appends to a log in one file; LCM numbers the new events from 0.
enum class LogStart { kReplace, kAppend };

class LogParts {
 public:
  // Throws InvalidArgument when the file at `path` cannot be written.
  LogParts(const std::string& path, const LogRotation& rotation, LogStart start = LogStart::kReplace);

  // Writes `event`; its number is assigned here.
  void write(lcm::LogEvent event);
  // Hands the events written since the last call to the file. Returns false when the disk refused any of
  // them. All of them are then removed again, so that the file ends with a complete event and can be
  // continued when there is room.
  [[nodiscard]] bool flush();
  void close();

  int parts() const { return part_ + 1; }      // begun so far
  bool has_failed() const { return failed_; }  // the disk refused something

 private:
  void rotate_before(SimTime stamp, std::int64_t bytes);
  [[nodiscard]] bool open_part(int part, LogStart start);
  void take_back();

  std::string path_;
  LogRotation rotation_;
  std::unique_ptr<lcm::LogFile> file_;
  int part_ = 0;
  std::int64_t part_bytes_ = 0;   // written to this part
  std::int64_t sound_bytes_ = 0;  // size of the file at the last flush
  bool is_refused_ = false;       // something was refused since the last flush
  SimTime part_ends_ = SimTime::never();
  std::int64_t events_ = 0;
  bool failed_ = false;
};

}  // namespace halocline::bus
