// SPDX-License-Identifier: BSD-3-Clause
#include "runs/export/run_export.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bathymetry/terrain/local_frame.h"
#include "core/atomic_file.h"
#include "core/check.h"
#include "core/csv_table.h"
#include "core/shared_module.h"
#include "core/sim_time.h"
#include "runs/export/date_line.h"
#include "runs/export/mcap_writer.h"
#include "runs/foxglove/foxglove_messages.h"
#include "runs/foxglove/foxglove_schemas.h"
#include "runs/timeline/packet_book.h"
#include "runs/timeline/packet_reasons.h"
#include "runs/timeline/vehicle_record.h"

namespace halocline::clients {
namespace {

using nlohmann::json;

// Message to be written at an instant; all are sorted by time first.
struct Writing {
  SimTime at;
  std::uint16_t channel = 0;
  const VehicleRecord* vehicle = nullptr;     // position to be written
  const packet_outcome_t* outcome = nullptr;  // otherwise this outcome
  const PacketRecord* refused = nullptr;      // otherwise this refusal, otherwise the scene
};

std::string text_of(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

bathymetry::LocalFrame required_frame(const RunTimeline& timeline) {
  const auto frame = frame_of(timeline);
  require(frame.has_value(),
          "the log does not hold the origin of its coordinates; give it by --origin LATITUDE,LONGITUDE");
  return *frame;
}

// Returns the times at which states and packets were received, and both ends of the run, sorted.
std::vector<SimTime> times_received(const RunTimeline& timeline) {
  std::vector<SimTime> all{timeline.begin(), timeline.end()};
  for (const VehicleRecord& vehicle : timeline.vehicles()) {
    for (const auto& entry : vehicle.track.all()) all.push_back(entry.at);
  }
  for (const PacketRecord& packet : timeline.packets().all()) {
    all.push_back(packet.at());
    for (const packet_outcome_t& outcome : packet.outcomes) all.push_back(SimTime::from_utime(outcome.utime));
  }
  std::sort(all.begin(), all.end());
  return all;
}

// Adds the scenes. There are none from a minute after the last message until just before the next one: a
// state that is a year late must not add a year of scenes.
void add_scenes(const RunTimeline& timeline, std::uint16_t channel, std::vector<Writing>& all) {
  constexpr SimDuration kPeriod = SimDuration::from_milliseconds(500);
  constexpr SimDuration kLongestSilence = SimDuration::from_milliseconds(60'000);
  const std::vector<SimTime> received = times_received(timeline);
  auto next = received.begin();
  for (SimTime at = timeline.begin(); at <= timeline.end(); at = at + kPeriod) {
    while (next != received.end() && *next <= at) ++next;
    if (next != received.end() && at - *(next - 1) > kLongestSilence)
      at = at + kPeriod * ((*next - at).nanoseconds() / kPeriod.nanoseconds());
    all.push_back({.at = at, .channel = channel});
  }
}

void add_packets(const RunTimeline& timeline, std::uint16_t channel, std::vector<Writing>& all) {
  for (const PacketRecord& packet : timeline.packets().all()) {
    if (packet.is_refused()) all.push_back({.at = packet.at(), .channel = channel, .refused = &packet});
    for (const packet_outcome_t& outcome : packet.outcomes)
      all.push_back({.at = SimTime::from_utime(outcome.utime), .channel = channel, .outcome = &outcome});
  }
}

// Returns the packets of `by_departure` that may be under way.
std::vector<const PacketRecord*> under_way(const std::vector<const PacketRecord*>& by_departure, SimTime at) {
  constexpr SimDuration kLongest = SimDuration::from_milliseconds(120'000);
  const auto first = std::lower_bound(by_departure.begin(), by_departure.end(), at - kLongest,
                                      [](const PacketRecord* packet, SimTime t) { return packet->at() < t; });
  const auto last = std::upper_bound(first, by_departure.end(), at,
                                     [](SimTime t, const PacketRecord* packet) { return t < packet->at(); });
  return {first, last};
}

json message_of(const RunTimeline& timeline, const std::optional<bathymetry::LocalFrame>& frame,
                const std::vector<const PacketRecord*>& by_departure, const Writing& writing) {
  if (writing.vehicle != nullptr) return foxglove_fix(*writing.vehicle, *frame, writing.at);
  if (writing.outcome != nullptr) return foxglove_log_of(timeline, *writing.outcome);
  if (writing.refused != nullptr)
    return foxglove_log(writing.at, true, timeline.name(writing.refused->name.source_id),
                        refusal(writing.refused->receipt.value_or(0)));
  return foxglove_scene(timeline, writing.at, under_way(by_departure, writing.at));
}

std::int64_t floor_division(std::int64_t value, std::int64_t by) {
  return value / by - (value % by < 0 ? 1 : 0);
}

// Formats a time to the nearest millisecond.
std::string iso_time(SimTime at) {
  const std::int64_t rounded_ms = floor_division(at.nanoseconds() + 500'000, 1'000'000);
  const std::time_t seconds = floor_division(rounded_ms, 1000);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  const std::int64_t milliseconds = rounded_ms - seconds * 1000;
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", utc.tm_year + 1900, utc.tm_mon + 1,
                     utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec, milliseconds);
}

std::vector<LinePlace> line_of(const bathymetry::LocalFrame& frame, const VehicleRecord& vehicle) {
  std::vector<LinePlace> line;
  for (const auto& [at, point] : vehicle.track.all()) {
    const auto place = place_of(frame, point.position_ned_m);
    line.push_back({place.longitude_deg, place.latitude_deg, place.height_m, at.seconds()});
  }
  return line;
}

// Coordinates and times of a GeoJSON feature: of one place, of a line, or of its pieces.
struct TrackJson {
  const char* type;
  json coordinates = json::array(), time_s = json::array();
};

TrackJson line_json(const std::vector<LinePlace>& line) {
  TrackJson track{"LineString"};
  for (const LinePlace& place : line) {
    track.coordinates.push_back({place.longitude_deg, place.latitude_deg, place.height_m});
    track.time_s.push_back(place.time_s);
  }
  return track;
}

TrackJson track_json(const std::vector<LinePlace>& line) {
  const auto pieces = cut_at_date_line(line);
  TrackJson track = line_json(pieces.front());
  if (line.size() == 1) {
    track.type = "Point";
    track.coordinates = json(track.coordinates[0]);
  } else if (pieces.size() > 1) {
    track = {"MultiLineString"};
    for (const auto& piece : pieces) {
      TrackJson part = line_json(piece);
      track.coordinates.push_back(std::move(part.coordinates));
      track.time_s.push_back(std::move(part.time_s));
    }
  }
  return track;
}

// GPX has no longitude of 180 degrees east: its range ends just below.
double gpx_longitude_deg(double longitude_deg) {
  constexpr double kRounding_deg = 0.5e-8;
  return longitude_deg >= 180 - kRounding_deg ? -180 : longitude_deg;
}

// Escapes a text for XML. A vehicle's name is [a-z0-9_-], but a scenario's is any text.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

}  // namespace

void set_origin(RunTimeline& timeline, const std::string& text) {
  RunScenario scenario = timeline.scenario();
  const std::size_t comma = text.find(',');
  const auto latitude_deg = parse_number(text.substr(0, comma), -90.0, 90.0);
  const auto longitude_deg =
      comma == std::string::npos ? std::nullopt : parse_number(text.substr(comma + 1), -360.0, 360.0);
  require(latitude_deg && longitude_deg && std::abs(*latitude_deg) < 90,
          "--origin is '" + text + "'; allowed is LATITUDE,LONGITUDE in degrees, as 43.5,7.25");
  scenario.origin = {*latitude_deg, *longitude_deg};
  timeline.set_scenario(std::move(scenario));
}

void export_mcap(const RunTimeline& timeline, const std::string& path) {
  McapWriter out(path);
  const auto channel = [&](const std::string& topic, const FoxgloveSchema& schema) {
    return out.add_channel(topic, std::string(schema.name), schema.json_schema);
  };
  std::vector<Writing> all;
  add_scenes(timeline, channel("/scene", kSceneUpdateSchema), all);
  add_packets(timeline, channel("/log", kLogSchema), all);
  const auto frame = frame_of(timeline);
  if (frame) {
    for (const VehicleRecord& vehicle : timeline.vehicles()) {
      const std::uint16_t fixes = channel("/vehicles/" + vehicle.name + "/position", kLocationFixSchema);
      for (const auto& entry : vehicle.track.all())
        all.push_back({.at = entry.at, .channel = fixes, .vehicle = &vehicle});
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Writing& a, const Writing& b) { return a.at < b.at; });
  std::vector<const PacketRecord*> by_departure;
  for (const PacketRecord& packet : timeline.packets().all()) by_departure.push_back(&packet);
  std::stable_sort(by_departure.begin(), by_departure.end(),
                   [](const PacketRecord* a, const PacketRecord* b) { return a->at() < b->at(); });
  for (const Writing& writing : all)
    out.write(writing.channel, writing.at, text_of(message_of(timeline, frame, by_departure, writing)));
  out.close();
}

void export_geojson(const RunTimeline& timeline, const std::string& path) {
  const auto frame = required_frame(timeline);
  json features = json::array();
  for (const VehicleRecord& vehicle : timeline.vehicles()) {
    if (vehicle.track.all().empty()) continue;
    TrackJson track = track_json(line_of(frame, vehicle));
    features.push_back(
        {{"type", "Feature"},
         {"geometry", {{"type", track.type}, {"coordinates", std::move(track.coordinates)}}},
         {"properties", {{"name", vehicle.name}, {"id", vehicle.id}, {"time_s", std::move(track.time_s)}}}});
  }
  replace_file(path, text_of({{"type", "FeatureCollection"}, {"features", std::move(features)}}) + "\n");
}

void export_gpx(const RunTimeline& timeline, const std::string& path) {
  const auto frame = required_frame(timeline);
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<gpx version=\"1.1\" creator=\"halocline\" "
      "xmlns=\"http://www.topografix.com/GPX/1/1\">\n";
  text += fmt::format("<metadata><name>{}</name></metadata>\n", escaped(timeline.scenario().name));
  for (const VehicleRecord& vehicle : timeline.vehicles()) {
    text += fmt::format("<trk><name>{}</name><trkseg>\n", escaped(vehicle.name));
    for (const auto& [at, point] : vehicle.track.all()) {
      const auto place = place_of(frame, point.position_ned_m);
      text += fmt::format("<trkpt lat=\"{:.8f}\" lon=\"{:.8f}\"><ele>{:.2f}</ele><time>{}</time></trkpt>\n",
                          place.latitude_deg, gpx_longitude_deg(place.longitude_deg), place.height_m,
                          iso_time(at));
    }
    text += "</trkseg></trk>\n";
  }
  replace_file(path, text + "</gpx>\n");
}

void export_netcdf(const RunTimeline& timeline, const std::string& path) {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): a symbol's type is known by its name
  const auto write = reinterpret_cast<TracksWriter*>(
      module_symbol("halocline_tracks_netcdf.so", "halocline_write_tracks_netcdf"));
  write(timeline, path);
}

}  // namespace halocline::clients
