// SPDX-License-Identifier: BSD-3-Clause
// The file that a recorder writes, which no other recorder writes meanwhile and nothing is taken from that
// was there.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "bus/logs/log_reader.h"
#include "bus/logs/log_recorder.h"

namespace halocline::clients {

class RecordedFile {
 public:
  // What to do with a file that is there and not empty. kAppend is for the log of a recorder that was killed;
  // an event that was cut short at its end is taken off.
  enum class Existing { kRefuse, kReplace, kAppend };

  // Locks the file until the process ends. Throws InvalidArgument that names the file, and what is allowed.
  RecordedFile(std::string path, Existing existing);
  ~RecordedFile();
  RecordedFile(const RecordedFile&) = delete;
  RecordedFile& operator=(const RecordedFile&) = delete;

  const std::string& path() const { return path_; }
  // What an earlier recorder left; before log().
  void read(const std::function<void(const LoggedEvent&)>& take) const;
  bool goes_on() const { return existing_ == Existing::kAppend; }  // behind what one left
  // Opened at the first call.
  bus::LogRecorder& log();

 private:
  std::string path_;
  Existing existing_;
  int lock_ = -1;
  std::optional<bus::LogRecorder> log_;
};

}  // namespace halocline::clients
