// Writes everything that passes on an lcm::LCM into an LCM log, stamped with simulation time: the canonical
// log of a run. The same run writes the same bytes.
//
// Rotated, a log is a series of files (log_series.h), each a whole LCM log (LCM numbers
// the events of each file from 0). Parts change before an event that would make one longer than `part_bytes`,
// and at multiples of `part_time`: the same run is cut at the same events.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <lcm/lcm-cpp.hpp>

#include "core/sim_time.h"

namespace halocline::bus {

// When the next part of a log begins, and how many are kept. 0 everywhere: one file, however long.
struct LogRotation {
  std::int64_t part_bytes = 0;  // 0: any size
  SimDuration part_time;        // 0: any time
  int parts_kept = 0;           // the newest, above 0; 0: all

  bool rotates() const { return part_bytes > 0 || part_time > SimDuration(); }
};

class LogRecorder {
 public:
  // Replaces the file at `path`, and the parts of an earlier series of that name; throws InvalidArgument when it
  // cannot be written. `now` gives the stamp of each message as it is dispatched. `lcm` must outlive the recorder.
  LogRecorder(lcm::LCM& lcm, const std::string& path, std::function<SimTime()> now,
              const LogRotation& rotation = {});
  ~LogRecorder();
  LogRecorder(const LogRecorder&) = delete;
  LogRecorder& operator=(const LogRecorder&) = delete;

  std::int64_t events() const { return events_; }
  int parts() const { return part_ + 1; }  // begun so far
  // Writes out what is buffered; throws std::runtime_error when the disk refused any of it.
  void close();

 private:
  void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  void rotate_before(SimTime stamp, std::int64_t bytes);
  [[nodiscard]] bool open_part(int part);
  void end_part();

  lcm::LCM& lcm_;
  std::string path_;
  std::function<SimTime()> now_;
  std::unique_ptr<lcm::LogFile> file_;
  lcm::Subscription* subscription_ = nullptr;
  LogRotation rotation_;
  int part_ = 0;
  std::int64_t part_bytes_ = 0;  // written to this part
  SimTime part_ends_ = SimTime::never();
  std::int64_t events_ = 0;
  bool failed_ = false;
};

}  // namespace halocline::bus
