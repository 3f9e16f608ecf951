// SPDX-License-Identifier: BSD-3-Clause
// Recorder of messages into an LCM log (log_parts.h). Stamped with simulation time, this is the canonical log
// of a run: the same run writes the same bytes.
//
// A separate thread writes the messages in batches: of kBatchBytes, and at every whole second of the time
// stamps. While kMaxBatches are waiting to be written, the run waits. After each batch the file is a valid
// log, whatever happens to the process; a batch that the disk refuses is left out completely.
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
#include "bus/messages/message_batch.h"
#include "core/sim_time.h"

namespace halocline::bus {

class LogRecorder {
 public:
  static constexpr std::size_t kBatchBytes = 256 << 10, kMaxBatches = 64;

  // See LogParts for the arguments.
  explicit LogRecorder(const std::string& path, const LogRotation& rotation = {},
                       LogStart start = LogStart::kReplace);
  ~LogRecorder();
  LogRecorder(const LogRecorder&) = delete;
  LogRecorder& operator=(const LogRecorder&) = delete;

  // Records a message; ignored after close(). `stamp` must not decrease.
  void record(SimTime stamp, std::string_view channel, std::span<const std::uint8_t> message);

  // Passes the current batch to the writing thread; returns at once unless kMaxBatches are waiting.
  void hand_over();
  // Returns when every recorded message has been handed to the file.
  void flush();

  std::int64_t events() const { return events_; }
  // Number of events in batches that the disk refused so far.
  std::int64_t events_refused() const { return events_refused_; }
  // Number of parts begun; valid once close() has returned.
  int parts() const { return parts_.parts(); }
  // Writes the remaining batches and ends recording. Throws std::runtime_error when the disk refused any
  // event.
  void close();

 private:
  void write_batches();
  void write(const MessageBatch& batch);

  std::string path_;
  bool is_closed_ = false;
  std::int64_t events_ = 0;
  std::atomic<std::int64_t> events_refused_ = 0;
  MessageBatch filling_;
  SimTime whole_second_;  // time stamp at which the batch is handed over

  std::mutex mutex_;  // guards the members up to parts_
  std::condition_variable changed_;
  std::deque<MessageBatch> waiting_;
  bool writes_ = false, ends_ = false;

  LogParts parts_;  // used by writer_ until it has ended
  std::thread writer_;
};

}  // namespace halocline::bus
