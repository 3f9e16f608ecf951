// SPDX-License-Identifier: BSD-3-Clause
// Publisher of commands and messages from pages to vehicles, which it checks as the bus does. It reads no
// clock: steady time is passed in.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "bus/messages/message_codec.h"
#include "bus/messages/messages.h"
#include "core/sim_time.h"
#include "runs/timeline/packet_book.h"
#include "runs/timeline/run_timeline.h"

namespace halocline::monitor {

class CommandDesk {
 public:
  static constexpr double kPeriod_s = 0.1, kMaxDuration_s = 60;
  using Post = std::function<void(const std::string& channel, bus::Bytes bytes)>;
  // Receives the key of the packet; empty when the bus did not show it.
  using Sent = std::function<void(const std::string& key)>;

  // `session` must differ for each start of the program.
  CommandDesk(std::int64_t session, Post post) : session_(session), post_(std::move(post)) {}

  // Repeats a command every kPeriod_s for the requested time; a new command for the vehicle replaces it.
  // Throws InvalidArgument for an invalid request.
  void command(const clients::RunTimeline& timeline, const nlohmann::json& request);
  // Publishes one SEND at `now`. Throws InvalidArgument for an invalid request.
  void send(const clients::RunTimeline& timeline, const nlohmann::json& request, SimTime now, Sent sent);

  void tick(double steady_s, const clients::RunTimeline& timeline, SimTime now);

 private:
  struct Command {
    vehicle_command_t message;
    double until_s = 0, next_s = 0;
  };
  struct Awaited {
    clients::PacketId name;
    double until_s;
    Sent sent;
  };

  std::int64_t session_;
  Post post_;
  double now_s_ = 0;
  std::map<std::string, Command> commands_;          // key: vehicle
  std::map<std::string, std::int64_t> next_number_;  // number of the next command; key: vehicle
  std::int64_t next_packet_ = 0;
  std::vector<Awaited> awaited_;
};

}  // namespace halocline::monitor
