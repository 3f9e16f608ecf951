// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/pages/packet_json.h"

#include <algorithm>
#include <iterator>

#include "core/csv_table.h"
#include "core/frames.h"
#include "runs/timeline/packet_reasons.h"
#include "runs/timeline/vehicle_record.h"

namespace halocline::monitor {
namespace {

using nlohmann::json;

const char* result_name(const clients::PacketRecord& packet) {
  constexpr const char* kNames[] = {"accepted",
                                    "refused_busy",
                                    "refused_too_large",
                                    "refused_unknown_vehicle",
                                    "refused_wrong_source",
                                    "refused_stale",
                                    "refused_too_early",
                                    "queued",
                                    "refused_queue_full",
                                    "refused_no_rate",
                                    "refused_no_kind"};
  if (!packet.receipt || *packet.receipt < 0 || *packet.receipt >= static_cast<int>(std::size(kNames)))
    return "unknown";
  return kNames[*packet.receipt];
}

json index_of(const clients::RunTimeline& timeline, std::int32_t id) {
  const clients::VehicleRecord* vehicle = id == 0 ? nullptr : timeline.find(id);
  return vehicle == nullptr ? json(-1) : json(vehicle->index);
}

json outcome_json(const clients::RunTimeline& timeline, const packet_outcome_t& outcome) {
  const bool has_sinr = outcome.acquisition_probability > 0 || outcome.success_probability > 0;
  return {{"receiver", index_of(timeline, outcome.receiver_id)},
          {"code", static_cast<int>(outcome.outcome)},
          {"arrive_s", clients::arrival_of(outcome).seconds()},
          {"end_s", clients::end_of(outcome).seconds()},
          {"range_m", outcome.range_m},
          {"sinr_db", has_sinr ? json(outcome.sinr_db) : json()}};
}

}  // namespace

void PacketIndex::refresh(const clients::PacketBook& book) {
  if (revision_ == book.revision()) return;
  revision_ = book.revision();
  entries_.clear();
  for (const clients::PacketRecord& packet : book.all()) entries_.push_back({packet.at(), packet.number});
  std::sort(entries_.begin(), entries_.end());
}

std::vector<const clients::PacketRecord*> PacketIndex::departing(const clients::PacketBook& book,
                                                                 SimTime from, SimTime to) const {
  std::vector<const clients::PacketRecord*> found;
  for (auto entry = std::lower_bound(entries_.begin(), entries_.end(), Entry{from, 0});
       entry != entries_.end() && entry->at <= to; ++entry) {
    if (const clients::PacketRecord* packet = book.find(entry->number)) found.push_back(packet);
  }
  return found;
}

std::string packet_key(const clients::PacketRecord& packet) { return "p" + std::to_string(packet.number); }

std::optional<std::uint64_t> packet_number(std::string_view key) {
  return key.starts_with('p') ? parse_number<std::uint64_t>(key.substr(1)) : std::nullopt;
}

double sound_speed_at(const clients::RunTimeline& timeline, double depth_m, SimTime at) {
  constexpr double kUnknown = 1500;
  const auto* water = timeline.water().at_or_before(std::max(at, SimTime()));
  if (water == nullptr || water->value.layer_depth_m.empty()) return kUnknown;
  const std::vector<double>&depths = water->value.layer_depth_m, &speeds = water->value.layer_sound_speed_mps;
  const auto below = std::lower_bound(depths.begin(), depths.end(), depth_m);
  if (below == depths.begin()) return speeds.front();
  if (below == depths.end()) return speeds.back();
  const auto i = static_cast<std::size_t>(below - depths.begin());
  const double share = (depth_m - depths[i - 1]) / (depths[i] - depths[i - 1]);
  return speeds[i - 1] + share * (speeds[i] - speeds[i - 1]);
}

json packet_json(const clients::RunTimeline& timeline, const clients::PacketRecord& packet) {
  const bool refused = packet.is_refused();
  const clients::VehicleRecord* sender = timeline.find(packet.name.source_id);
  const auto place = sender == nullptr ? std::nullopt : state_at(sender->track, packet.at());
  json outcomes = json::array();
  for (const packet_outcome_t& outcome : packet.outcomes) outcomes.push_back(outcome_json(timeline, outcome));
  json shown = {{"key", packet_key(packet)},
                {"source", index_of(timeline, packet.name.source_id)},
                {"destination", index_of(timeline, packet.destination_id)},
                {"kind", clients::packet_kind_name(packet.name.kind)},
                {"bytes", packet.payload_bytes < 0 ? json() : json(packet.payload_bytes)},
                {"depart_s", packet.at().seconds()},
                {"duration_s", refused ? 0 : packet.duration_s},
                {"result", result_name(packet)},
                {"outcomes", std::move(outcomes)},
                {"north_m", nullptr},
                {"east_m", nullptr},
                {"down_m", nullptr}};
  double depth_m = 0;
  if (place) {
    const Vec3& position = place->point.position_ned_m;
    shown["north_m"] = position.x();
    shown["east_m"] = position.y();
    shown["down_m"] = position.z();
    depth_m = position.z() - timeline.scenario().sea_surface_z_m;
  }
  shown["wave_speed_mps"] = sound_speed_at(timeline, depth_m, packet.at());
  return shown;
}

json packets_json(const clients::RunTimeline& timeline,
                  std::span<const clients::PacketRecord* const> packets) {
  json items = json::array();
  for (const clients::PacketRecord* packet : packets) items.push_back(packet_json(timeline, *packet));
  return items;
}

}  // namespace halocline::monitor
