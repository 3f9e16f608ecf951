// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/sensors/usbl_fix_assembler.h"

#include <algorithm>

#include "core/random.h"

namespace halocline::vehicle_sim {
namespace {

constexpr std::size_t kMaxWaiting = 1000;

std::uint64_t draw_of(const PacketKey& p) {
  return identity_of({static_cast<std::uint64_t>(p.source_id), static_cast<std::uint64_t>(p.kind),
                      static_cast<std::uint64_t>(p.session), static_cast<std::uint64_t>(p.sequence)});
}

}  // namespace

UsblFixAssembler::Waiting& UsblFixAssembler::entry_of(const PacketKey& packet) {
  const auto found =
      std::find_if(waiting_.begin(), waiting_.end(), [&](const Waiting& w) { return w.packet == packet; });
  if (found != waiting_.end()) return *found;
  if (waiting_.size() >= kMaxWaiting) waiting_.pop_front();
  waiting_.push_back({packet, {}, false, {}, poses_.empty() ? SimTime() : poses_.back().when});
  return waiting_.back();
}

void UsblFixAssembler::on_arrival(const PacketKey& packet, const SoundArrival& arrival) {
  entry_of(packet).arrival = arrival;
}

void UsblFixAssembler::on_packet(const PacketKey& packet, std::optional<double> travel_time_s) {
  Waiting& entry = entry_of(packet);
  entry.received = true;
  entry.travel_time_s = travel_time_s;
}

void UsblFixAssembler::clear() {
  poses_.clear();
  waiting_.clear();
}

void UsblFixAssembler::note_pose(SimTime when, const Quaternion& orientation) {
  if (!poses_.empty() && poses_.back().when >= when) return;
  poses_.push_back({when, orientation});
  while (poses_.size() > 2 && poses_[1].when < when - kTimeout) poses_.pop_front();
}

std::optional<Quaternion> UsblFixAssembler::orientation_at(SimTime when) const {
  const auto after = std::lower_bound(poses_.begin(), poses_.end(), when,
                                      [](const Pose& pose, SimTime t) { return pose.when < t; });
  if (after == poses_.end()) return std::nullopt;
  if (after == poses_.begin()) return after->orientation;  // before the first recorded pose
  const Pose& before = *(after - 1);
  const double share = (when - before.when).seconds() / (after->when - before.when).seconds();
  return between(before.orientation, after->orientation, share);
}

std::vector<UsblFix> UsblFixAssembler::take(bool is_dead) {
  std::vector<UsblFix> fixes;
  if (waiting_.empty() || poses_.empty()) return fixes;
  const SimTime now = poses_.back().when;
  std::erase_if(waiting_, [&](const Waiting& w) {
    if (w.received && w.arrival) {
      const auto orientation = orientation_at(w.arrival->when);
      if (!orientation) return false;
      const bool lost = is_dead || (settings_.errors.dropout > 0 &&
                                    uniform_at({.seed = identity_.seed,
                                                .purpose = purpose_of("usbl-dropout"),
                                                .who = static_cast<std::uint32_t>(identity_.vehicle_id),
                                                .which = draw_of(w.packet)}) < settings_.errors.dropout);
      if (!lost) fixes.push_back(fix_of(w, *orientation));
      return true;
    }
    return w.since < now - kTimeout;
  });
  return fixes;
}

UsblFix UsblFixAssembler::fix_of(const Waiting& w, const Quaternion& orientation) const {
  return {w.packet, w.arrival->when,
          read_usbl(settings_, identity_, draw_of(w.packet), w.arrival->azimuth_rad, w.arrival->elevation_rad,
                    orientation),
          w.travel_time_s};
}

}  // namespace halocline::vehicle_sim
