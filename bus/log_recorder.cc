#include "bus/log_recorder.h"

#include <cstdio>
#include <stdexcept>

#include "core/check.h"

namespace halocline::bus {

LogRecorder::LogRecorder(lcm::LCM& lcm, const std::string& path, std::function<SimTime()> now)
    : lcm_(lcm), path_(path), now_(std::move(now)), file_(std::make_unique<lcm::LogFile>(path, "w")) {
  require(file_->good(), "cannot write the log " + path);
  subscription_ = lcm_.subscribe(".*", &LogRecorder::on_message, this);
}

LogRecorder::~LogRecorder() { lcm_.unsubscribe(subscription_); }

void LogRecorder::on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  if (!file_) return;
  lcm::LogEvent event;
  event.eventnum = events_++;
  event.timestamp = now_().to_utime();
  event.channel = channel;
  event.datalen = static_cast<std::int32_t>(buffer->data_size);
  event.data = buffer->data;
  if (file_->writeEvent(&event) != 0) failed_ = true;
}

void LogRecorder::close() {
  if (!file_) return;
  const bool flushed = std::fflush(file_->getFilePtr()) == 0;
  file_.reset();
  if (failed_ || !flushed)
    throw std::runtime_error("the log " + path_ + " could not be written whole (disk full?)");
}

}  // namespace halocline::bus
