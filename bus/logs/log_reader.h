// SPDX-License-Identifier: BSD-3-Clause
// Reads LCM logs event by event, whatever their state: intact events are returned, damage is reported with
// its place.
//
// log_scan.h defines intact and damaged events. A log that a recorder rotated (bus/logs/log_recorder.h) is a
// series of files: run.lcm, run.0001.lcm, run.0002.lcm, ... Opening run.lcm reads all files that exist, even
// if the oldest were deleted. Any other logs can be read as one by giving several paths. Files are mapped one
// at a time, so memory does not grow with the log; a file that shrinks while it is read ends the program.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "bus/logs/log_contents.h"
#include "bus/logs/log_flows.h"
#include "bus/logs/log_scan.h"

namespace halocline::clients {

struct LoggedEvent {
  std::int64_t number = 0;
  std::int64_t stamp_us = 0;  // simulation time in Halocline's logs, wall clock in lcm-logger's
  std::string channel;
  std::vector<std::uint8_t> data;
  std::size_t file = 0;     // index in LogReader::files()
  std::int64_t offset = 0;  // position of its first byte in that file
};

// Bytes of a file that belong to no event.
struct BadStretch {
  std::size_t file = 0;  // index in LogReader::files()
  std::int64_t offset = 0, bytes = 0;
  bool cut_short = false;  // the file ends within an event
};

class LogReader {
 public:
  static constexpr std::size_t kMaxStretchesKept = 10'000;

  // Throws InvalidArgument for a file that cannot be read, for a file that is no LCM log, and if none of the
  // files holds an event.
  explicit LogReader(const std::string& path) : LogReader(std::vector<std::string>{path}) {}
  explicit LogReader(const std::vector<std::string>& paths);

  // Reads the next event; returns false at the end of the last file.
  [[nodiscard]] bool next(LoggedEvent& event);

  const std::vector<std::string>& files() const { return files_; }
  // Damage found so far, in order; at most kMaxStretchesKept.
  const std::vector<BadStretch>& bad_stretches() const { return bad_; }
  // Bytes that belonged to no event, without those of events that were cut off.
  std::int64_t bytes_skipped() const { return bytes_skipped_; }
  bool truncated() const { return truncated_; }     // a file ends within an event
  std::int64_t bytes() const { return bytes_; }     // total size of the files opened so far
  const LogFlows& flows() const { return flows_; }  // flows in the events read so far
  const LogContents& contents() const { return contents_; }

 private:
  [[nodiscard]] bool open_next_file();
  void note(const Damage& damage);

  std::vector<std::string> files_;
  std::size_t next_file_ = 0;
  std::shared_ptr<const std::uint8_t> mapping_;
  LogBytes log_;
  std::size_t at_ = 0;
  LogFlows flows_;
  LogContents contents_;
  std::vector<BadStretch> bad_;
  std::int64_t bytes_skipped_ = 0, bytes_ = 0;
  bool truncated_ = false;
};

// Returns the files of the series that begins with `path`, in order; only `path` if there is no other.
std::vector<std::string> series_of(const std::string& path);

// Returns "FILE, byte OFFSET".
std::string place_of(const LogReader& log, const LoggedEvent& event);

// Writes a line about each damaged stretch found so far (the first twenty, and the number of others), about
// contents that cannot be read (log_contents.h) and about missing messages (log_flows.h). Returns true when
// the log was intact and complete; then nothing is written, unless the log holds several sessions. Every
// program that reads a log calls this at the end, and exits with 1 if it returns false, because its results
// are then those of a part of the run.
bool report_damage(std::ostream& out, const LogReader& log);

}  // namespace halocline::clients
