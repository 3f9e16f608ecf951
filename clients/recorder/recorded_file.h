// SPDX-License-Identifier: BSD-3-Clause
// File that a recorder writes. It is locked against other recorders, and existing messages are never removed
// unless it is replaced.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "bus/logs/log_reader.h"
#include "bus/logs/log_recorder.h"

namespace halocline::clients {

class RecordedFile {
 public:
  // Treatment of an existing file that is not empty. kAppend is for the log of a recorder that was killed; an
  // incomplete event at its end is removed.
  enum class Existing { kRefuse, kReplace, kAppend };

  // Locks the file for the lifetime of this object. Throws InvalidArgument, which names the file and what is
  // allowed.
  RecordedFile(std::string path, Existing existing);
  ~RecordedFile();
  RecordedFile(const RecordedFile&) = delete;
  RecordedFile& operator=(const RecordedFile&) = delete;

  const std::string& path() const { return path_; }
  // Reads the messages of an earlier recorder; to be called before log().
  void read(const std::function<void(const LoggedEvent&)>& take) const;
  bool goes_on() const { return existing_ == Existing::kAppend; }  // appends to existing messages
  // Returns the log, which the first call opens.
  bus::LogRecorder& log();

 private:
  std::string path_;
  Existing existing_;
  int lock_ = -1;
  std::optional<bus::LogRecorder> log_;
};

}  // namespace halocline::clients
