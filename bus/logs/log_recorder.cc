#include "bus/logs/log_recorder.h"

#include <stdexcept>
#include <utility>

namespace halocline::bus {

LogRecorder::LogRecorder(lcm::LCM& lcm, const std::string& path, std::function<SimTime()> now,
                         const LogRotation& rotation)
    : lcm_(lcm), path_(path), now_(std::move(now)), parts_(path, rotation) {
  subscription_ = lcm_.subscribe(".*", &LogRecorder::on_message, this);
  writer_ = std::thread([this] { write_batches(); });
}

LogRecorder::~LogRecorder() {
  try {
    close();
  } catch (const std::runtime_error&) {  // of a run that failed otherwise
  }
}

// Throws nothing: it is called through LCM's C frames.
void LogRecorder::on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  const SimTime stamp = now_();
  if (stamp >= whole_second_) {
    hand_over();
    whole_second_ = next_on_grid(stamp, SimDuration::from_milliseconds(1000));
  }
  const auto* data = static_cast<const std::uint8_t*>(buffer->data);
  filling_.bytes.insert(filling_.bytes.end(), data, data + buffer->data_size);
  filling_.messages.push_back({stamp, channel, filling_.bytes.size()});
  ++events_;
  if (filling_.bytes.size() >= kBatchBytes) hand_over();
}

void LogRecorder::hand_over() {
  if (filling_.messages.empty()) return;
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.size() < kMostBatches; });
  waiting_.push_back(std::exchange(filling_, {}));
  changed_.notify_all();
}

void LogRecorder::write_batches() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    Batch batch = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    changed_.notify_all();
    write(batch);
    lock.lock();
  }
}

void LogRecorder::write(Batch& batch) {
  std::size_t begin = 0;
  for (Batch::Message& message : batch.messages) {
    lcm::LogEvent event;
    event.timestamp = message.stamp.to_utime();
    event.channel = std::move(message.channel);
    event.datalen = static_cast<std::int32_t>(message.end - begin);
    event.data = batch.bytes.data() + begin;
    parts_.write(std::move(event));
    begin = message.end;
  }
}

void LogRecorder::close() {
  if (subscription_ == nullptr) return;
  lcm_.unsubscribe(std::exchange(subscription_, nullptr));
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
