// SPDX-License-Identifier: BSD-3-Clause
#include "bus/logs/log_recorder.h"

#include <stdexcept>
#include <utility>

namespace halocline::bus {

LogRecorder::LogRecorder(const std::string& path, const LogRotation& rotation, LogStart start)
    : path_(path), parts_(path, rotation, start), writer_([this] { write_batches(); }) {}

LogRecorder::~LogRecorder() {
  try {
    close();
  } catch (const std::runtime_error&) {  // the run has failed for another reason
  }
}

void LogRecorder::record(SimTime stamp, std::string_view channel, std::span<const std::uint8_t> message) {
  if (is_closed_) return;
  if (stamp >= whole_second_) {
    hand_over();
    whole_second_ = next_on_grid(stamp, SimDuration::from_milliseconds(1000));
  }
  filling_.add(stamp, channel, message);
  ++events_;
  if (filling_.size_bytes() >= kBatchBytes) hand_over();
}

void LogRecorder::hand_over() {
  if (filling_.empty()) return;
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.size() < kMaxBatches; });
  waiting_.push_back(std::exchange(filling_, {}));
  changed_.notify_all();
}

void LogRecorder::flush() {
  hand_over();
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.empty() && !writes_; });
}

void LogRecorder::write_batches() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    const MessageBatch batch = std::move(waiting_.front());
    waiting_.pop_front();
    writes_ = true;
    lock.unlock();
    changed_.notify_all();
    write(batch);
    lock.lock();
    writes_ = false;
    changed_.notify_all();
  }
}

void LogRecorder::write(const MessageBatch& batch) {
  std::int64_t events = 0;
  batch.for_each([&](SimTime stamp, const std::string& channel, std::span<const std::uint8_t> message) {
    lcm::LogEvent event{};
    event.timestamp = stamp.to_utime();
    event.channel = channel;
    event.datalen = static_cast<std::int32_t>(message.size());
    event.data = const_cast<std::uint8_t*>(message.data());  // LCM only reads it
    parts_.write(std::move(event));
    ++events;
  });
  if (!parts_.flush()) events_refused_ += events;
}

void LogRecorder::close() {
  if (std::exchange(is_closed_, true)) return;
  hand_over();
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  writer_.join();
  parts_.close();
  if (parts_.has_failed())
    throw std::runtime_error("the log " + path_ + " could not be written whole (disk full?)");
}

}  // namespace halocline::bus
