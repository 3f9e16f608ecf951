// SPDX-License-Identifier: BSD-3-Clause
#include "runs/foxglove/foxglove_messages.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "runs/timeline/packet_reasons.h"

namespace halocline::clients {
namespace {

using nlohmann::json;

constexpr double kRadians = std::numbers::pi / 180;
constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr SimDuration kLinksShown = SimDuration::from_milliseconds(10'000);

json vector_of(double x, double y, double z) { return {{"x", x}, {"y", y}, {"z", z}}; }
json enu(const Vec3& ned_m) { return vector_of(ned_m.y(), ned_m.x(), -ned_m.z()); }
json colour(double r, double g, double b, double a) { return {{"r", r}, {"g", g}, {"b", b}, {"a", a}}; }

// Converts an attitude to a quaternion of the axes x forward, y left, z up in east, north, up.
json orientation(const EulerAngles& attitude) {
  const EulerAngles turned{attitude.roll, -attitude.pitch, std::numbers::pi / 2 - attitude.yaw};
  const Quaternion q = to_quaternion(turned);
  return {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}};
}

json upright() { return {{"x", 0}, {"y", 0}, {"z", 0}, {"w", 1}}; }

json entity(const std::string& id, SimTime at) {
  return {{"timestamp", foxglove_time(at)},
          {"frame_id", "world"},
          {"id", id},
          {"lifetime", {{"sec", 2}, {"nsec", 0}}},
          {"frame_locked", false},
          {"metadata", json::array()},
          {"arrows", json::array()},
          {"spheres", json::array()},
          {"lines", json::array()},
          {"texts", json::array()}};
}

json vehicle_entity(const VehicleRecord& vehicle, const TrackPoint& point, SimTime at) {
  constexpr double kLength_m = 20;
  json shown = entity("vehicle-" + vehicle.name, at);
  shown["arrows"].push_back(
      {{"pose", {{"position", enu(point.position_ned_m)}, {"orientation", orientation(point.attitude)}}},
       {"shaft_length", kLength_m},
       {"shaft_diameter", kLength_m / 5},
       {"head_length", kLength_m / 2},
       {"head_diameter", kLength_m / 2},
       {"color", colour(0.9, 0.6, 0, 1)}});
  const Vec3 above = point.position_ned_m - Vec3(0, 0, kLength_m);
  shown["texts"].push_back({{"pose", {{"position", enu(above)}, {"orientation", upright()}}},
                            {"billboard", true},
                            {"font_size", 14},
                            {"scale_invariant", true},
                            {"color", colour(1, 1, 1, 1)},
                            {"text", vehicle.name}});
  return shown;
}

// Colour of a link by its SNR: red for -10 dB and less, white for 10 dB, blue for 30 dB and more.
json colour_of_snr(double snr_db) {
  constexpr double kCenter_db = 10, kHalf_db = 20;
  const double share = std::clamp((snr_db - kCenter_db) / kHalf_db, -1.0, 1.0);
  const double faded = 1 - std::abs(share);
  return share < 0 ? colour(0.84, 0.37 + 0.6 * faded, faded, 0.7)
                   : colour(faded, 0.45 + 0.5 * faded, 0.7 + 0.3 * faded, 0.7);
}

json links_entity(const RunTimeline& timeline, SimTime at) {
  json points = json::array(), colours = json::array();
  for (const link_t* row : timeline.links().rows_at(at, kLinksShown)) {
    const auto *from = timeline.find(row->transmitter_id), *to = timeline.find(row->receiver_id);
    if (from == nullptr || to == nullptr || row->receivable == 0) continue;
    const auto here = state_at(from->track, at), there = state_at(to->track, at);
    if (!here || !there) continue;
    points.push_back(enu(here->point.position_ned_m));
    points.push_back(enu(there->point.position_ned_m));
    for (int end = 0; end < 2; ++end) colours.push_back(colour_of_snr(row->snr_db));
  }
  constexpr int kLineList = 2;
  json shown = entity("links", at);
  shown["lines"].push_back({{"type", kLineList},
                            {"pose", {{"position", vector_of(0, 0, 0)}, {"orientation", upright()}}},
                            {"thickness", 2},
                            {"scale_invariant", true},
                            {"points", std::move(points)},
                            {"color", colour(1, 1, 1, 1)},
                            {"colors", std::move(colours)},
                            {"indices", json::array()}});
  return shown;
}

json wave_entity(const RunTimeline& timeline, const PacketRecord& packet, SimTime at) {
  constexpr double kSoundSpeed_mps = 1500;
  const VehicleRecord* source = timeline.find(packet.name.source_id);
  const auto place = source == nullptr ? std::nullopt : state_at(source->track, packet.at());
  if (!place) return nullptr;
  const double size_m = 2 * kSoundSpeed_mps * (at - packet.at()).seconds();
  json shown = entity("packet-" + std::to_string(packet.number), at);
  shown["lifetime"] = {{"sec", 0}, {"nsec", kSecond_ns / 2}};
  shown["spheres"].push_back(
      {{"pose", {{"position", enu(place->point.position_ned_m)}, {"orientation", upright()}}},
       {"size", vector_of(size_m, size_m, size_m)},
       {"color", colour(0.34, 0.71, 0.91, 0.15)}});
  return shown;
}

}  // namespace

json foxglove_time(SimTime at) {
  const std::int64_t ns = std::max<std::int64_t>(at.nanoseconds(), 0);
  return {{"sec", ns / kSecond_ns}, {"nsec", ns % kSecond_ns}};
}

json foxglove_scene(const RunTimeline& timeline, SimTime at, std::span<const PacketRecord* const> packets) {
  json entities = json::array();
  for (const VehicleRecord& vehicle : timeline.vehicles()) {
    if (const auto state = state_at(vehicle.track, at))
      entities.push_back(vehicle_entity(vehicle, state->point, at));
  }
  entities.push_back(links_entity(timeline, at));
  for (const PacketRecord* packet : packets) {
    if (packet->is_refused() || packet->at() > at || packet->end() < at) continue;
    json wave = wave_entity(timeline, *packet, at);
    if (!wave.is_null()) entities.push_back(std::move(wave));
  }
  return {{"deletions", json::array()}, {"entities", std::move(entities)}};
}

std::optional<bathymetry::LocalFrame> frame_of(const RunTimeline& timeline) {
  const auto& origin = timeline.scenario().origin;
  if (!origin) return std::nullopt;
  return bathymetry::LocalFrame(bathymetry::FrameMode::kFlat, origin->latitude_deg * kRadians,
                                origin->longitude_deg * kRadians);
}

PlaceOnEarth place_of(const bathymetry::LocalFrame& frame, const Vec3& position_ned_m) {
  const bathymetry::GeodeticPoint point = frame.to_geodetic(position_ned_m);
  return {point.latitude_rad / kRadians, point.longitude_rad / kRadians, -point.depth_m};
}

json foxglove_fix(const VehicleRecord& vehicle, const bathymetry::LocalFrame& frame, SimTime at) {
  const auto state = state_at(vehicle.track, at);
  if (!state) return nullptr;
  const PlaceOnEarth point = place_of(frame, state->point.position_ned_m);
  return {{"timestamp", foxglove_time(at)}, {"frame_id", vehicle.name},
          {"latitude", point.latitude_deg}, {"longitude", point.longitude_deg},
          {"altitude", point.height_m},     {"position_covariance", json::array({0, 0, 0, 0, 0, 0, 0, 0, 0})},
          {"position_covariance_type", 0}};
}

json foxglove_log(SimTime at, bool is_loss, const std::string& name, const std::string& message) {
  constexpr int kInfo = 2, kWarning = 3;
  return {{"timestamp", foxglove_time(at)},
          {"level", is_loss ? kWarning : kInfo},
          {"message", message},
          {"name", name},
          {"file", ""},
          {"line", 0}};
}

json foxglove_log_of(const RunTimeline& timeline, const packet_outcome_t& outcome) {
  const auto name = [&](std::int32_t id) { return timeline.name(id); };
  const std::string packet =
      "Packet " + std::to_string(outcome.packet_sequence) + " of " + name(outcome.source_id) + ": ";
  return foxglove_log(SimTime::from_utime(outcome.utime), outcome.outcome != packet_outcome_t::RECEIVED,
                      name(outcome.receiver_id), packet + sentence(outcome, name));
}

}  // namespace halocline::clients
