#include "bus/logs/log_recorder.h"

#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "bus/logs/log_series.h"
#include "core/check.h"

namespace halocline::bus {
namespace {

constexpr std::int64_t kHeaderBytes = 28;  // word, number, stamp, two lengths

void remove_earlier_series(const std::string& path) {
  for (const std::string& part : parts_of_log(path)) {
    std::error_code stays;  // then it would be read as a part of this log
    require(std::filesystem::remove(part, stays), "cannot replace " + part + ", a part of an earlier log");
  }
}

}  // namespace

LogRecorder::LogRecorder(lcm::LCM& lcm, const std::string& path, std::function<SimTime()> now,
                         const LogRotation& rotation)
    : lcm_(lcm), path_(path), now_(std::move(now)), rotation_(rotation) {
  require(rotation.part_bytes >= 0 && rotation.part_time >= SimDuration() && rotation.parts_kept >= 0,
          "sizes, times and numbers of a log's parts must not be negative");
  require(open_part(0), "cannot write the log " + path);
  remove_earlier_series(path);
  if (rotation_.part_time > SimDuration()) part_ends_ = SimTime() + rotation_.part_time;
  subscription_ = lcm_.subscribe(".*", &LogRecorder::on_message, this);
}

LogRecorder::~LogRecorder() { lcm_.unsubscribe(subscription_); }

bool LogRecorder::open_part(int part) {
  file_ = std::make_unique<lcm::LogFile>(part_of_log(path_, part), "w");
  part_ = part;
  part_bytes_ = 0;
  if (!file_->good()) file_.reset();
  return file_ != nullptr;
}

void LogRecorder::end_part() {
  if (std::fflush(file_->getFilePtr()) != 0) failed_ = true;
  file_.reset();
}

void LogRecorder::rotate_before(SimTime stamp, std::int64_t bytes) {
  const bool too_long =
      rotation_.part_bytes > 0 && part_bytes_ > 0 && part_bytes_ + bytes > rotation_.part_bytes;
  if (!too_long && stamp < part_ends_) return;
  if (stamp >= part_ends_) part_ends_ = next_on_grid(stamp, rotation_.part_time);
  end_part();
  if (!open_part(part_ + 1)) failed_ = true;
  std::error_code stays;  // no reason to stop a run
  if (rotation_.parts_kept > 0 && part_ >= rotation_.parts_kept)
    std::filesystem::remove(part_of_log(path_, part_ - rotation_.parts_kept), stays);
}

// Throws nothing: it is called through LCM's C frames.
void LogRecorder::on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  if (!file_) return;
  const std::int64_t bytes = kHeaderBytes + static_cast<std::int64_t>(channel.size() + buffer->data_size);
  const SimTime stamp = now_();
  if (rotation_.rotates()) rotate_before(stamp, bytes);
  if (!file_) return;
  lcm::LogEvent event;
  event.eventnum = events_++;
  event.timestamp = stamp.to_utime();
  event.channel = channel;
  event.datalen = static_cast<std::int32_t>(buffer->data_size);
  event.data = buffer->data;
  if (file_->writeEvent(&event) != 0) failed_ = true;
  part_bytes_ += bytes;
}

void LogRecorder::close() {
  if (file_) end_part();
  if (std::exchange(failed_, false))
    throw std::runtime_error("the log " + path_ + " could not be written whole (disk full?)");
}

}  // namespace halocline::bus
