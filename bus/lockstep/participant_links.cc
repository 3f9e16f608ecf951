// SPDX-License-Identifier: BSD-3-Clause
#include "bus/lockstep/participant_links.h"

namespace halocline::conductor {

ParticipantLink& ParticipantLinks::of(const std::string& name) {
  ParticipantLink& link = links_[name];
  link.name = name;
  return link;
}

const ParticipantLink* ParticipantLinks::find(const std::string& name) const {
  const auto link = links_.find(name);
  return link == links_.end() ? nullptr : &link->second;
}

ParticipantLink* ParticipantLinks::of_incarnation(std::int64_t incarnation) {
  const auto link = connected_.find(incarnation);
  return link == connected_.end() ? nullptr : link->second;
}

void ParticipantLinks::connect(ParticipantLink& link, const lockstep_join_t& join, SimTime steady) {
  connected_.erase(link.incarnation);
  connected_[join.incarnation] = &link;
  link.incarnation = join.incarnation;
  link.join = join;
  link.turns_taken = join.turns_taken;
  link.wants_to_leave = join.wants_to_leave != 0;
  link.has_left = false;
  link.last_received = steady;
  link.timer = {};
  link.answer = {};
}

void ParticipantLinks::disconnect(ParticipantLink& link) {
  connected_.erase(link.incarnation);
  link.incarnation = 0;
  link.up_to_date = false;
  link.timer = {};
}

}  // namespace halocline::conductor
