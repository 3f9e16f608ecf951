// SPDX-License-Identifier: BSD-3-Clause
// Channel server and bathymetry service for a log, made from its configuration: they answer LINK_QUERY and
// TERRAIN_QUERY as those of the run would have. They run in a thread of their own, on a bus within the
// process.
//
// Ends of links are given as positions, with the modems that the configuration gives the named vehicles. The
// water is that at the beginning of the configuration until a SET_ENVIRONMENT is posted.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "bus/config/config.h"
#include "bus/messages/message_codec.h"
#include "viewer/sources/handover.h"

namespace halocline::monitor {

class LogNodes {
 public:
  // Opens the configuration. An exception that it throws becomes problem().
  using OpenConfiguration = std::function<bus::ConfigFile()>;
  explicit LogNodes(OpenConfiguration open);
  ~LogNodes();
  LogNodes(const LogNodes&) = delete;
  LogNodes& operator=(const LogNodes&) = delete;

  // Publishes a message on their bus.
  void post(const std::string& channel, bus::Bytes bytes);
  // Returns what they published since the last call: replies to any client, SCENARIO, TERRAIN, and MODEM of
  // each vehicle.
  std::vector<BusMessage> take() { return handover_.take(); }

  bool is_ready() const { return is_ready_; }
  // Returns why they do not run; empty while they run or start.
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
  std::thread thread_;  // last member: it uses the others
};

}  // namespace halocline::monitor
