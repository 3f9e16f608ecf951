// SPDX-License-Identifier: BSD-3-Clause
#include "bus/logs/packet_account.h"

#include <algorithm>
#include <cmath>

namespace halocline::clients {
namespace {

constexpr std::int64_t kBegun_us = 1'000'000;    // before a departure, much longer than any state lag
constexpr std::int64_t kSilence_us = 2'500'000;  // between two STATEs, half the default state timeout
constexpr std::int64_t kRounding_us = 1;
constexpr std::int64_t kAnotherRun_us = 10'000'000;
// Upper bound on the delay between the vehicles that are furthest apart:
//
//   delay = kDetour distance / kSlowestSound + kMargin
//
// with the slowest sound speed in water, paths half as long again as the distance, and a second for later
// arrivals and the steps of the programs.
constexpr double kSlowestSound_mps = 1400, kDetour = 1.5, kMargin_s = 1;
constexpr double kLongestDelay_s = 120;  // 170 km: one wrong STATE does not excuse all packets

template <class Ids>
void insert(Ids& ids, std::int32_t id) {
  const auto place = std::lower_bound(ids.begin(), ids.end(), id);
  if (place == ids.end() || *place != id) ids.insert(place, id);
}

}  // namespace

PacketAccount::Vehicle& PacketAccount::vehicle(std::string_view name, std::int32_t id) {
  auto found = vehicles_.find(name);
  if (found == vehicles_.end()) found = vehicles_.emplace(std::string(name), Vehicle{}).first;
  if (id > 0) found->second.id = id;
  return found->second;
}

void PacketAccount::take(std::string_view name, const vehicle_state_t& state) {
  Vehicle& v = vehicle(name, state.vehicle_id);
  const bool goes_on = v.has_state && std::abs(state.utime - v.last_us) <= kSilence_us;
  if (!goes_on) v.since_us = state.utime;
  v.last_us = goes_on ? std::max(v.last_us, state.utime) : state.utime;
  v.has_state = true;
  end_us_ = std::max(end_us_, state.utime);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    least_ned_m_[axis] = std::min(least_ned_m_[axis], state.position_ned_m[axis]);
    greatest_ned_m_[axis] = std::max(greatest_ned_m_[axis], state.position_ned_m[axis]);
  }
}

void PacketAccount::take(std::string_view name, const vehicle_battery_t&) {
  vehicle(name, 0).has_battery = true;
}

void PacketAccount::take(std::string_view name, const modem_send_t& send) { vehicle(name, send.source_id); }

void PacketAccount::take(std::string_view name, const modem_receipt_t& receipt) {
  end_us_ = std::max(end_us_, receipt.utime);
  Vehicle& sender = vehicle(name, 0);
  const bool is_queued = receipt.receipt_result == modem_receipt_t::QUEUED;
  if (receipt.receipt_result != modem_receipt_t::ACCEPTED && !is_queued) return;
  sender.has_sent = true;
  if (is_queued && sender.has_battery) return;
  const Name packet{receipt.send_session, receipt.packet_sequence, receipt.start_utime};
  const auto [entry, is_new] = packets_.try_emplace({packet, &sender});
  if (is_new) entry->second = {&sender, receipt.duration_s, vehicles_there(receipt.start_utime)};
}

void PacketAccount::take(std::string_view, const packet_outcome_t& outcome) {
  end_us_ = std::max(end_us_, outcome.utime);
  auto& all = outcomes_[{outcome.send_session, outcome.packet_sequence, outcome.departure_utime}];
  auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& o) { return o.source_id == outcome.source_id; });
  if (found == all.end()) found = all.insert(found, {outcome.source_id, {}, 0});
  with_modem_.insert(outcome.source_id);
  if (outcome.receiver_id == 0) {
    found->several = std::max<std::int64_t>(found->several, outcome.num_receivers);
    return;
  }
  with_modem_.insert(outcome.receiver_id);
  insert(found->receivers, outcome.receiver_id);
  const double since_departure_s = static_cast<double>(outcome.utime - outcome.departure_utime) * 1e-6;
  longest_delay_s_ = std::max(longest_delay_s_, since_departure_s - outcome.duration_s);
}

void PacketAccount::take(std::string_view, const link_table_t& links) {
  with_modem_.insert(links.vehicle_id);
}

void PacketAccount::take(std::string_view, const sim_clock_t& clock) {
  if (clock_us_ && clock.utime < *clock_us_ - kAnotherRun_us) {
    PacketAccount next;
    next.settled_ = missing();
    *this = std::move(next);
  }
  clock_us_ = clock.utime;
  end_us_ = std::max(end_us_, clock.utime);
}

std::shared_ptr<const PacketAccount::Ids> PacketAccount::vehicles_there(std::int64_t departure_us) {
  Ids ids;
  for (const auto& [name, v] : vehicles_) {
    if (v.id && v.has_state && v.since_us <= departure_us - kBegun_us &&
        v.last_us >= departure_us - kSilence_us)
      ids.push_back(*v.id);
  }
  std::sort(ids.begin(), ids.end());
  if (!there_ || *there_ != ids) there_ = std::make_shared<const Ids>(std::move(ids));
  return there_;
}

// Some of the vehicles present may have no modem, or disappear later: only those with a modem and later
// STATEs count.
PacketAccount::Ids PacketAccount::receivers_of(const Packet& packet, std::int64_t departure_us) const {
  Ids ids;
  for (const auto& [name, v] : vehicles_) {
    if (&v != packet.sender && v.id && (v.has_sent || has_modem(*v.id)) && v.last_us >= departure_us &&
        std::binary_search(packet.there->begin(), packet.there->end(), *v.id))
      ids.push_back(*v.id);
  }
  return ids;
}

// Any vehicle may have a modem in a log without messages about modems, and any may be present in a log
// without STATEs.
bool PacketAccount::has_possible_receiver(const Packet& packet) const {
  const bool has_states = least_ned_m_[0] <= greatest_ned_m_[0];
  return !has_states || std::any_of(packet.there->begin(), packet.there->end(), [&](std::int32_t id) {
    return (with_modem_.empty() || has_modem(id)) && (!packet.sender->id || id != *packet.sender->id);
  });
}

const PacketAccount::Outcomes* PacketAccount::outcomes_of(const Name& name, const Vehicle& sender) const {
  Name near = name;
  for (near.departure_us -= kRounding_us; near.departure_us <= name.departure_us + kRounding_us;
       ++near.departure_us) {
    const auto found = outcomes_.find(near);
    if (found == outcomes_.end()) continue;
    for (const Outcomes& outcomes : found->second) {
      if (!sender.id || outcomes.source_id == *sender.id) return &outcomes;
    }
  }
  return nullptr;
}

double PacketAccount::longest_delay_s() const {
  double squares = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double side_m = std::max(0.0, greatest_ned_m_[axis] - least_ned_m_[axis]);
    squares += side_m * side_m;
  }
  const double apart_s = kDetour * std::sqrt(squares) / kSlowestSound_mps + kMargin_s;
  return std::min(std::max(longest_delay_s_, apart_s), kLongestDelay_s);
}

PacketAccount::Missing PacketAccount::missing() const {
  Missing missing = settled_;
  const double delay_s = longest_delay_s();
  for (const auto& [key, packet] : packets_) {
    const Name& name = key.first;
    ++missing.accepted;
    const Outcomes* outcomes = outcomes_of(name, *packet.sender);
    const double left_s = static_cast<double>(end_us_ - name.departure_us) * 1e-6;
    if (left_s < packet.duration_s + delay_s) {
      ++missing.under_way;
      continue;
    }
    const auto wanted = static_cast<std::int64_t>(receivers_of(packet, name.departure_us).size());
    const std::int64_t there =
        outcomes == nullptr ? 0 : static_cast<std::int64_t>(outcomes->receivers.size()) + outcomes->several;
    if (outcomes == nullptr && has_possible_receiver(packet)) {
      ++missing.without_outcome;
    } else if (there < wanted) {
      ++missing.lack_some;
      missing.outcomes_lacking += wanted - there;
    }
  }
  return missing;
}

}  // namespace halocline::clients
