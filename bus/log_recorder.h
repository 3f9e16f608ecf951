// Writes everything that passes on an lcm::LCM into an LCM log, stamped with simulation time: the canonical
// log of a run. The same run writes the same bytes.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <lcm/lcm-cpp.hpp>

#include "core/sim_time.h"

namespace halocline::bus {

class LogRecorder {
 public:
  // Replaces the file at `path`; throws InvalidArgument when it cannot be written. `now` gives the stamp of
  // each message as it is dispatched. `lcm` must outlive the recorder.
  LogRecorder(lcm::LCM& lcm, const std::string& path, std::function<SimTime()> now);
  ~LogRecorder();
  LogRecorder(const LogRecorder&) = delete;
  LogRecorder& operator=(const LogRecorder&) = delete;

  std::int64_t events() const { return events_; }
  // Writes out what is buffered; throws std::runtime_error when the disk refused any of it.
  void close();

 private:
  void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel);

  lcm::LCM& lcm_;
  std::string path_;
  std::function<SimTime()> now_;
  std::unique_ptr<lcm::LogFile> file_;
  lcm::Subscription* subscription_ = nullptr;
  std::int64_t events_ = 0;
  bool failed_ = false;
};

}  // namespace halocline::bus
