// SPDX-License-Identifier: BSD-3-Clause
// Writes messages into an LCM log (log_parts.h). Stamped with simulation time, it is the canonical log of a
// run: the same run writes the same bytes.
//
// A thread of its own writes them: batches of kBatchBytes, and at every whole second of the stamps. While it
// has kMostBatches to write, the run waits. After each batch the file is a log up to there, whatever happens
// to the process; of a batch that the disk refuses nothing is in it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <thread>

#include "bus/logs/log_parts.h"
#include "bus/message_batch.h"
#include "core/sim_time.h"

namespace halocline::bus {

class LogRecorder {
 public:
  static constexpr std::size_t kBatchBytes = 256 << 10, kMostBatches = 64;

  // Of the file, see LogParts.
  explicit LogRecorder(const std::string& path, const LogRotation& rotation = {},
                       LogStart start = LogStart::kReplace);
  ~LogRecorder();
  LogRecorder(const LogRecorder&) = delete;
  LogRecorder& operator=(const LogRecorder&) = delete;

  // Nothing after close(). `stamp` is not before that of the message before.
  void record(SimTime stamp, std::string_view channel, std::span<const std::uint8_t> message);

  // What was recorded is written next; returns at once unless kMostBatches wait.
  void hand_over();
  // Returns when all that was recorded has been handed to the file.
  void flush();

  std::int64_t events() const { return events_; }
  // Of these, those in batches that the disk refused so far.
  std::int64_t events_refused() const { return events_refused_; }
  // Begun when close() has returned.
  int parts() const { return parts_.parts(); }
  // Writes out what is buffered; nothing more is recorded. Throws std::runtime_error when the disk refused
  // any of it.
  void close();

 private:
  void write_batches();
  void write(const MessageBatch& batch);

  std::string path_;
  bool is_closed_ = false;
  std::int64_t events_ = 0;
  std::atomic<std::int64_t> events_refused_ = 0;
  MessageBatch filling_;
  SimTime whole_second_;  // from which the batch is handed over

  std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  std::deque<MessageBatch> waiting_;
  bool writes_ = false, ends_ = false;

  LogParts parts_;  // of the thread, until it has ended
  std::thread writer_;
};

}  // namespace halocline::bus
