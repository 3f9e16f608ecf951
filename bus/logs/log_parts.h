// SPDX-License-Identifier: BSD-3-Clause
// The file or files of a log that is written: events in their order, cut into parts.
//
// Rotated, a log is a series of files (log_series.h), each a whole LCM log (LCM numbers
// the events of each file from 0). Parts change before an event that would make one longer than `part_bytes`,
// and at multiples of `part_time`: the same events are cut at the same places. Not thread-safe.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <lcm/lcm-cpp.hpp>

#include "core/sim_time.h"

namespace halocline::bus {

// When the next part of a log begins, and how many are kept. 0 everywhere: one file, however long.
struct LogRotation {
  std::int64_t part_bytes = 0;  // 0: any size
  SimDuration part_time;        // 0: any time
  int parts_kept = 0;           // the newest, above 0; 0: all

  bool rotates() const { return part_bytes > 0 || part_time > SimDuration(); }
};

// kReplace: of the file that is there, and of the parts of an earlier series of that name. kAppend: to a log
// in one file; LCM numbers the events from 0 again.
enum class LogStart { kReplace, kAppend };

class LogParts {
 public:
  // Throws InvalidArgument when the file at `path` cannot be written.
  LogParts(const std::string& path, const LogRotation& rotation, LogStart start = LogStart::kReplace);

  // `event` but for its number.
  void write(lcm::LogEvent event);
  // Hands to the file what was written since the last call. False when the disk refused any of it: then all
  // of it is taken back, so that the file ends with a whole event and may go on when there is room again.
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
  std::int64_t sound_bytes_ = 0;  // of the file, up to the last flush
  bool is_refused_ = false;       // something since then
  SimTime part_ends_ = SimTime::never();
  std::int64_t events_ = 0;
  bool failed_ = false;
};

}  // namespace halocline::bus
