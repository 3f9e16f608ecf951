// SPDX-License-Identifier: BSD-3-Clause
// Receiver thread of a bus: receives every message and publishes those posted to it. It never waits for the
// reader: messages go to a queue of bounded size. A bus that cannot be opened is retried.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "bus/messages/message_codec.h"
#include "bus/transport/receive_filter.h"
#include "core/sim_time.h"
#include "viewer/sources/handover.h"

namespace lcm {
class LCM;
}

namespace halocline::monitor {

class BusReceiver {
 public:
  // `node` is the name of the thread in its log messages.
  BusReceiver(std::string lcm_url, bus::AcceptedHosts hosts, std::string node);
  ~BusReceiver();
  BusReceiver(const BusReceiver&) = delete;
  BusReceiver& operator=(const BusReceiver&) = delete;

  // Returns the messages since the last call. A message without a channel marks the beginning of another run.
  std::vector<BusMessage> take() { return handover_.take(); }
  std::int64_t dropped() const { return handover_.dropped(); }

  // Queues a message, which the thread publishes within some hundredths of a second.
  void post(std::string channel, bus::Bytes bytes);

  bool is_open() const { return is_open_; }
  // Returns the simulation time according to the conductor's CLOCK; nothing until one was received.
  std::optional<SimTime> conductor_time() const;

 private:
  void run();
  void receive(lcm::LCM& lcm);
  void publish_posted(lcm::LCM& lcm);
  void sleep_for(int milliseconds) const;

  std::string url_, node_;
  bus::AcceptedHosts hosts_;
  Handover handover_;
  std::mutex posted_mutex_;
  std::vector<BusMessage> posted_;
  std::atomic<bool> is_open_ = false, stop_ = false;
  std::atomic<std::int64_t> conductor_ns_;
  std::thread thread_;  // last member: it uses the others
};

}  // namespace halocline::monitor
