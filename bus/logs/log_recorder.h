// Writes everything that passes on an lcm::LCM into an LCM log (log_parts.h), stamped with simulation time: the canonical
// log of a run. The same run writes the same bytes.
//
// A thread of its own writes them: batches of kBatchBytes, and at every whole second of the run. While it has kMostBatches to
// write, the run waits.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "bus/logs/log_parts.h"
#include "core/sim_time.h"

namespace halocline::bus {

class LogRecorder {
 public:
  static constexpr std::size_t kBatchBytes = 256 << 10, kMostBatches = 64;

  // Of the file, see LogParts. `now` gives the stamp of each message as it is dispatched. `lcm` must outlive the recorder.
  LogRecorder(lcm::LCM& lcm, const std::string& path, std::function<SimTime()> now,
              const LogRotation& rotation = {});
  ~LogRecorder();
  LogRecorder(const LogRecorder&) = delete;
  LogRecorder& operator=(const LogRecorder&) = delete;

  std::int64_t events() const { return events_; }
  // Begun when close() has returned.
  int parts() const { return parts_.parts(); }
  // Writes out what is buffered; nothing more is recorded. Throws std::runtime_error when the disk refused any of it.
  void close();

 private:
  // Messages one after the other.
  struct Batch {
    struct Message {
      SimTime stamp;
      std::string channel;
      std::size_t end;  // of its bytes; they begin where those of the message before end
    };
    std::vector<Message> messages;
    std::vector<std::uint8_t> bytes;
  };

  void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  void hand_over();
  void write_batches();
  void write(Batch& batch);

  lcm::LCM& lcm_;
  std::string path_;
  std::function<SimTime()> now_;
  lcm::Subscription* subscription_ = nullptr;
  std::int64_t events_ = 0;
  Batch filling_;
  SimTime whole_second_;  // from which the batch is handed over

  std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  std::deque<Batch> waiting_;
  bool ends_ = false;

  LogParts parts_;  // of the thread, until it has ended
  std::thread writer_;
};

}  // namespace halocline::bus
