// SPDX-License-Identifier: BSD-3-Clause
// Reads LCM logs event by event, whatever state they are in: sound events are read, the rest is reported with
// its place.
//
// What is an event and what is damage: log_scan.h. A log that a recorder rotated (bus/logs/log_recorder.h) is
// a series of files: run.lcm, run.0001.lcm, run.0002.lcm, ...; opening run.lcm reads all of it that is there,
// also when the oldest were deleted. Any other logs may be read as one by giving several paths. Files are
// mapped one at a time, so memory does not grow with the log; one that shrinks while it is read ends the
// program.
#pragma once

#include <cstdint>
#include <functional>
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
  std::int64_t stamp_us = 0;  // simulation time in our own logs, the wall clock in lcm-logger's
  std::string channel;
  std::vector<std::uint8_t> data;
  std::size_t file = 0;     // which of LogReader::files()
  std::int64_t offset = 0;  // of its first byte in that file
};

// Bytes of one file that belong to no event.
struct BadStretch {
  std::size_t file = 0;  // which of LogReader::files()
  std::int64_t offset = 0, bytes = 0;
  bool cut_short = false;  // the file ends within an event
};

class LogReader {
 public:
  static constexpr std::size_t kMaxStretchesKept = 10'000;

  // Throws InvalidArgument for a file that cannot be read, for one that is no LCM log, and where all of them
  // hold no event.
  explicit LogReader(const std::string& path) : LogReader(std::vector<std::string>{path}) {}
  explicit LogReader(const std::vector<std::string>& paths);

  // False at the end of the last file.
  [[nodiscard]] bool next(LoggedEvent& event);

  const std::vector<std::string>& files() const { return files_; }
  // What was met so far, in order; not more than kMaxStretchesKept.
  const std::vector<BadStretch>& bad_stretches() const { return bad_; }
  std::int64_t bytes_skipped() const {
    return bytes_skipped_;
  }                                                 // that belonged to no event; cut events' apart
  bool truncated() const { return truncated_; }     // a file ends within an event
  std::int64_t bytes() const { return bytes_; }     // of the files begun so far
  const LogFlows& flows() const { return flows_; }  // of the events read so far
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

// The files of the series that begins with `path`, in order; `path` alone where there is no other.
std::vector<std::string> series_of(const std::string& path);

// "FILE, byte OFFSET".
std::string place_of(const LogReader& log, const LoggedEvent& event);

// Writes a line about each bad stretch that was met so far (the first twenty, and how many more), what of the
// log cannot be read (log_contents.h) and what it lacks (log_flows.h). True when the log was sound and whole:
// then there is none, unless the log holds several sessions. Every program that reads a log calls this once
// it has read it all; what it computed is then of a part of the run, so its exit code is 1.
bool report_damage(std::ostream& out, const LogReader& log);

}  // namespace halocline::clients
