// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/packets/receiver_state.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace halocline::channel_server {
namespace {

// Sounds are dropped only when at least this many are new, because a pass visits all of them.
constexpr std::size_t kFewSounds = 64;

// A packet without a duration counts at its single instant.
bool overlap(const PacketInterval& span, SimTime begin, SimTime end) {
  return begin < span.end && (span.begin < end || span.begin == begin);
}

// True when both packets answer one ping to all. Each transponder has a frequency or a code of its own, and
// receivers have a filter for each: such answers neither disturb one another nor keep each other from being
// acquired.
bool answer_one_ping(const Packet& a, const Packet& b) {
  const SendRequest &one = a.request, &other = b.request;
  return one.kind == PacketKind::kPingReply && other.kind == PacketKind::kPingReply &&
         one.source_id != other.source_id && one.destination_id == other.destination_id &&
         one.session == other.session && one.packet_sequence == other.packet_sequence;
}

}  // namespace

bool ReceiverState::overlaps_decided(const PacketInterval& span, SimTime decided_by) const {
  if (span.begin >= decided_by) return false;
  return std::any_of(sounds_.begin(), sounds_.end(), [&](const AudiblePacket& sound) {
    return overlap(span, sound.begin, sound.end) && sound.end <= decided_by && !sound.paths.empty() &&
           band_share(sound.packet->modem.band(), span.packet->modem.band()) > 0;
  });
}

bool ReceiverState::transmit(const PacketInterval& span, SimTime decided_by) {
  transmissions_.push_back(span);
  return overlaps_decided(span, decided_by);
}

bool ReceiverState::open(AudiblePacket packet, SimTime decided_by) {
  const bool conflicts_with_past =
      !packet.paths.empty() && overlaps_decided({packet.packet, packet.begin, packet.end}, decided_by);
  open_.insert(std::upper_bound(open_.begin(), open_.end(), packet.begin), packet.begin);
  longest_ = std::max(longest_, packet.end - packet.begin);
  const auto place = std::upper_bound(sounds_.begin(), sounds_.end(), packet.begin,
                                      [](SimTime begin, const AudiblePacket& h) { return begin < h.begin; });
  sounds_.insert(place, std::move(packet));
  return conflicts_with_past;
}

void ReceiverState::close(SimTime begin, SimTime now) {
  open_.erase(std::lower_bound(open_.begin(), open_.end(), begin));
  if (size() > 2 * size_at_forgetting_ + kFewSounds) forget(now);
}

std::vector<PacketPointer> ReceiverState::transmitted_during(SimTime begin, SimTime end) const {
  std::vector<PacketInterval> spans;
  for (const PacketInterval& span : transmissions_) {
    if (overlap(span, begin, end)) spans.push_back(span);
  }
  std::sort(spans.begin(), spans.end(),
            [](const PacketInterval& a, const PacketInterval& b) { return a.begin < b.begin; });
  std::vector<PacketPointer> packets;
  for (PacketInterval& span : spans) packets.push_back(std::move(span.packet));
  return packets;
}

std::shared_ptr<const Packet> ReceiverState::followed_at(SimTime instant, const Packet& other) const {
  for (const Acquisition& acquisition : acquisitions_) {
    if (acquisition.instant > instant || acquisition.reception.end <= instant) continue;
    if (answer_one_ping(*acquisition.reception.packet, other)) continue;
    const auto sends = [&](const PacketInterval& span) {
      return overlap(span, acquisition.reception.begin, instant);
    };
    if (std::none_of(transmissions_.begin(), transmissions_.end(), sends))
      return acquisition.reception.packet;
  }
  return nullptr;
}

Interferers ReceiverState::interferers_of(const Packet& packet, SimTime begin, SimTime end) const {
  Interferers found;
  const acoustics::Band band = packet.modem.band();
  auto sound = std::lower_bound(sounds_.begin(), sounds_.end(), begin - longest_,
                                [](const AudiblePacket& h, SimTime time) { return h.begin < time; });
  for (; sound != sounds_.end() && sound->begin < end; ++sound) {
    if (sound->end <= begin || sound->packet.get() == &packet || answer_one_ping(*sound->packet, packet))
      continue;
    const double share = band_share(sound->packet->modem.band(), band);
    if (share == 0) continue;
    for (const AudiblePath& path : sound->paths) {
      if (path.end <= begin || path.begin >= end) continue;
      found.paths.push_back({path.begin, path.end, path.power * share, found.packets.size()});
    }
    found.packets.push_back(sound->packet);
  }
  std::sort(found.paths.begin(), found.paths.end(), [](const Interference& a, const Interference& b) {
    return std::tie(a.begin, a.end, a.power) < std::tie(b.begin, b.end, b.power);
  });
  return found;
}

SimTime ReceiverState::transmission_end(SimTime instant) const {
  for (const PacketInterval& span : transmissions_) {
    if (span.begin <= instant && instant < span.end) return span.end;
  }
  return SimTime::never();
}

PowerCrossing ReceiverState::next_crossing(SimTime from, const acoustics::Band& band, double level,
                                           bool is_above) const {
  std::vector<std::pair<SimTime, double>> changes{{from, 0}};
  for (const AudiblePacket& sound : sounds_) {
    if (sound.end <= from) continue;
    const double share = band_share(sound.packet->modem.band(), band);
    if (share == 0) continue;
    for (const AudiblePath& path : sound.paths) {
      if (path.end <= from) continue;
      changes.emplace_back(std::max(path.begin, from), path.power * share);
      changes.emplace_back(path.end, -path.power * share);
    }
  }
  std::sort(changes.begin(), changes.end());
  double power = 0;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    power += changes[i].second;
    const bool is_last = i + 1 == changes.size() || changes[i + 1].first > changes[i].first;
    if (is_last && (power > level) == is_above) return {changes[i].first, std::max(power, 0.0)};
  }
  return {};
}

void ReceiverState::forget(SimTime now) {
  SimTime oldest = now - kept_longer_;
  if (!open_.empty()) oldest = std::min(oldest, open_.front());
  std::erase_if(sounds_, [&](const AudiblePacket& packet) { return packet.end < oldest; });
  std::erase_if(transmissions_, [&](const PacketInterval& span) { return span.end < oldest; });
  std::erase_if(acquisitions_,
                [&](const Acquisition& acquisition) { return acquisition.reception.end < oldest; });
  size_at_forgetting_ = size();
}

}  // namespace halocline::channel_server
