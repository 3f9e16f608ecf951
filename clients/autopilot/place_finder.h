// SPDX-License-Identifier: BSD-3-Clause
// Asks the channel server where a vehicle that seeks a link is best heard, and hands on what it answers.
//
// A question is asked of an instant, once a period, and its answer counts kAnswerAfter later: so what the
// vehicle does depends on simulation time, not on how long the answer took. A question without an answer by
// then is asked again.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "bus/bus.h"
#include "clients/autopilot/link_seeker.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::clients {

class PlaceFinder {
 public:
  static constexpr SimDuration kAnswerAfter = SimDuration::from_milliseconds(1000);

  // The bus must outlive it.
  PlaceFinder(bus::Bus& bus, std::string vehicle);
  PlaceFinder(const PlaceFinder&) = delete;
  PlaceFinder& operator=(const PlaceFinder&) = delete;

  // At each instant of commands; `seeker` is null while the vehicle does something else. True when it changed
  // its mind.
  [[nodiscard]] bool step(SimTime instant, LinkSeeker* seeker);
  void restart();
  void archive(Archive& a) { a(asked_at_, next_, request_id_, answer_); }

 private:
  void ask(SimTime instant, const LinkSeeker& seeker);

  bus::Bus& bus_;
  std::string vehicle_;
  std::optional<SimTime> asked_at_;  // while an answer is awaited
  SimTime next_;
  std::int64_t request_id_;  // other sessions have others
  std::optional<best_place_reply_t> answer_;
};

}  // namespace halocline::clients
