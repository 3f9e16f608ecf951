// SPDX-License-Identifier: BSD-3-Clause
// A channel server and a bathymetry service for a log, made of its configuration: they answer LINK_QUERY and
// TERRAIN_QUERY, as those of the run would have. They run in a thread of their own, on a bus within the
// process.
//
// Ends of links are positions with the modems that the configuration gives the named vehicles. The water is
// that of the configuration's begin, until SET_ENVIRONMENT is posted.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "bus/config/config.h"
#include "bus/message_codec.h"
#include "clients/monitor/sources/handover.h"

namespace halocline::monitor {

class LogNodes {
 public:
  // Opens the configuration; what it throws becomes problem().
  using OpenConfiguration = std::function<bus::ConfigFile()>;
  explicit LogNodes(OpenConfiguration open);
  ~LogNodes();
  LogNodes(const LogNodes&) = delete;
  LogNodes& operator=(const LogNodes&) = delete;

  // Publishes on their bus.
  void post(const std::string& channel, bus::Bytes bytes);
  // What they published since the last call: replies to any client, SCENARIO and TERRAIN; and MODEM of each
  // vehicle.
  std::vector<BusMessage> take() { return handover_.take(); }

  bool is_ready() const { return is_ready_; }
  // Why they do not run; empty while they do, or may yet.
  std::string problem() const;

 private:
  void run();
  void serve();

  OpenConfiguration open_;
  Handover handover_;
  mutable std::mutex mutex_;
  std::condition_variable posted_or_ended_;
  std::vector<BusMessage> posted_;
  std::string problem_;
  bool ends_ = false;
  std::atomic<bool> is_ready_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace halocline::monitor
