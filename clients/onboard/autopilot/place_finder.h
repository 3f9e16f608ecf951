// SPDX-License-Identifier: BSD-3-Clause
// Queries of a vehicle that seeks a link: asks the channel server at which place it is best heard.
//
// A query refers to an instant and is sent once a period; its answer takes effect kAnswerAfter later. The
// vehicle's actions thus depend on simulation time, not on how long the answer took. A query that is not
// answered by then is sent again.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "bus/bus.h"
#include "clients/onboard/autopilot/link_seeker.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::clients {

class PlaceFinder {
 public:
  static constexpr SimDuration kAnswerAfter = SimDuration::from_milliseconds(1000);

  // The bus must outlive the PlaceFinder.
  PlaceFinder(bus::Bus& bus, std::string vehicle);
  PlaceFinder(const PlaceFinder&) = delete;
  PlaceFinder& operator=(const PlaceFinder&) = delete;

  // Advances to a command instant. `seeker`: null while the vehicle does something else. Returns true when
  // the chosen place has changed.
  [[nodiscard]] bool step(SimTime instant, LinkSeeker* seeker);
  void restart();
  void archive(Archive& a) { a(asked_at_, next_, request_id_, answer_); }

 private:
  void ask(SimTime instant, const LinkSeeker& seeker);

  bus::Bus& bus_;
  std::string vehicle_;
  std::optional<SimTime> asked_at_;  // instant of the query that awaits its answer
  SimTime next_;
  std::int64_t request_id_;  // starts at a value that differs between sessions
  std::optional<best_place_reply_t> answer_;
};

}  // namespace halocline::clients
