// SPDX-License-Identifier: BSD-3-Clause
#include "tests/layers/room_rules.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/layers/room_table.h"
#include "tests/layers/source_tree.h"

namespace halocline::layers {
namespace {

bool starts_with_any(std::string_view text, const Words& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](std::string_view prefix) { return text.starts_with(prefix); });
}

bool is_one_of(std::string_view text, const Words& words) {
  return std::find(words.begin(), words.end(), text) != words.end();
}

std::string_view stem_of(std::string_view path) {
  const std::string_view name = path.substr(path.rfind('/') + 1);
  return name.substr(0, name.find('.'));
}

const Room* room_of(std::string_view folder) {
  const auto found =
      std::find_if(rooms().begin(), rooms().end(), [&](const Room& room) { return room.path == folder; });
  return found == rooms().end() ? nullptr : &*found;
}

bool is_exempt(std::string_view file, std::string_view header) {
  return std::any_of(exemptions().begin(), exemptions().end(), [&](const Exemption& exempt) {
    return file.starts_with(exempt.file) && header.starts_with(exempt.header);
  });
}

const Words kFree{"tests", "bench"};  // they may include everything

// What a pure file may not know: clocks, threads, files, logging, and random numbers that are drawn by turn.
const Words kImpure{"chrono", "ctime",   "thread",   "mutex",      "shared_mutex", "condition_variable",
                    "atomic", "future",  "barrier",  "latch",      "semaphore",    "stop_token",
                    "random", "fstream", "iostream", "filesystem", "csignal",      "syncstream",
                    "print"};
// The named readers of files, behind an interface that gives values.
const Words kReaders{"acoustics/noise/noise_table_reader", "acoustics/fading/channel_record_",
                     "acoustics/sea/profile_reader",       "acoustics/sea/profile_grid_reader",
                     "bathymetry/rasters/raster_",         "bathymetry/rasters/gdal_"};
const Words kReaderHeaders{"fstream", "filesystem", "iostream", "mutex", "cstdio", "atomic"};

// Headers that pure files may include hold these all the same (<cstdio> has snprintf, and fopen).
const Words kImpureNames{"std::printf",   "std::puts",    "fprintf",     "fopen",
                         "std::cout",     "std::cerr",    "getenv",      "std::rand(",
                         "random_device", "steady_clock", "system_clock"};

// Rooms of models: values in, values out.
const Words kPureRooms{"core",
                       "acoustics/",
                       "bathymetry/terrain",
                       "bathymetry/rasters",
                       "vehicle_sim/dynamics",
                       "vehicle_sim/sensors",
                       "vehicle_sim/world",
                       "channel_server/vehicles",
                       "channel_server/propagation",
                       "channel_server/packets",
                       "channel_server/links"};
// Models beside the node that they belong to.
const Words kPureFiles{"bathymetry/ray_service.",     "vehicle_sim/faults.",
                       "vehicle_sim/fleet.",          "vehicle_sim/model_library.",
                       "vehicle_sim/pending_echoes.", "vehicle_sim/sensor_station."};

bool is_pure(std::string_view file) {
  return starts_with_any(folder_of(file), kPureRooms) || starts_with_any(file, kPureFiles);
}

bool is_standard(std::string_view path) {
  return path.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string_view::npos;
}
bool is_lcm(std::string_view path) { return path.starts_with("lcm/"); }
bool is_message_type(std::string_view path) {
  return path.starts_with("lcmtypes/") || (path.starts_with("halocline/") && path.ends_with(".hpp"));
}
bool is_of_the_system(std::string_view path) {  // POSIX and Linux
  return starts_with_any(path, {"sys/", "linux/", "arpa/", "net/", "netinet/"}) ||
         is_one_of(path, {"unistd.h", "fcntl.h", "poll.h", "spawn.h", "signal.h", "dirent.h", "sched.h",
                          "malloc.h", "stdio_ext.h"});
}

std::string_view first_element(std::string_view path) { return path.substr(0, path.find('/')); }

bool is_ours(std::string_view path) {
  if (path.find('/') == std::string_view::npos || is_message_type(path)) return false;
  return std::any_of(rooms().begin(), rooms().end(),
                     [&](const Room& room) { return first_element(room.path) == first_element(path); });
}

bool stands_on(const Room& room, std::string_view path) {
  const std::string_view folder = folder_of(path);
  const auto is_part_of = [&](std::string_view whole, const Words& parts) {
    return (room.path == whole || is_one_of(whole, room.stands_on)) && is_one_of(folder, parts);
  };
  return folder == room.path || is_part_of("core", {"core/files", "core/memory", "core/text"}) ||
         is_part_of("bus", {"bus/messages", "bus/transport", "bus/repair"}) ||
         is_part_of("acoustics/sea", {"acoustics/sea/surface"}) ||
         is_part_of("acoustics/rays", {"acoustics/rays/search"}) ||
         is_part_of("channel_server", {"channel_server/messages"}) || is_one_of(folder, room.stands_on) ||
         is_one_of(path, room.stands_on);
}

std::string with_reason(std::string_view objection, const Room& room) {
  return std::string(objection) + ": " + std::string(room.reason);
}

std::string objection_of_pure_file(std::string_view file, std::string_view path) {
  if (is_lcm(path)) return "a pure file knows no LCM";
  if (is_message_type(path) || first_element(path) == "bus") return "a pure file knows no messages";
  if (is_of_the_system(path)) return "a pure file has no clock, thread, file or log";
  if (is_standard(path) && is_one_of(path, kImpure)) {
    const bool reads = starts_with_any(file, kReaders) && is_one_of(path, kReaderHeaders);
    return reads ? "" : "a pure file has no clock, thread, file or log";
  }
  const std::string_view stem = stem_of(path);
  const bool node = stem.ends_with("_node") || stem.ends_with("_config") || stem.ends_with("_messages");
  return is_ours(path) && node ? "a pure file knows no node" : "";
}

void visit_room(const std::map<std::string, std::set<std::string>>& edges, const std::string& room,
                std::vector<std::string>& trail, std::set<std::string>& done, std::string& cycle) {
  if (!cycle.empty() || done.contains(room)) return;
  const auto seen = std::find(trail.begin(), trail.end(), room);
  if (seen != trail.end()) {
    for (auto step = seen; step != trail.end(); ++step) cycle += *step + " -> ";
    cycle += room;
    return;
  }
  trail.push_back(room);
  const auto found = edges.find(room);
  if (found != edges.end()) {
    for (const std::string& next : found->second) visit_room(edges, next, trail, done, cycle);
  }
  trail.pop_back();
  done.insert(room);
}

// The first `depth` elements of a folder.
std::string cut(std::string_view folder, int depth) {
  std::size_t end = 0;
  for (int i = 0; i < depth && end != std::string_view::npos; ++i) end = folder.find('/', end + (i > 0));
  return std::string(folder.substr(0, end));
}

}  // namespace

std::string objection(std::string_view file, std::string_view path) {
  if (path.ends_with(".cc") || stem_of(path) == "main") return "no file includes a main or a source file";
  if (path.find("..") != std::string_view::npos) return "paths start at the root of the repository";
  if (is_one_of(first_element(file), kFree)) return "";
  if (path.starts_with("tests/") || path.starts_with("bench/")) return "tests are not part of the programs";
  if (path.find_first_of("/.") == std::string_view::npos && !is_standard(path)) return "no path can be read";
  const Room* room = room_of(folder_of(file));
  if (room == nullptr) return "the folder has no rule in tests/layers";
  if (is_exempt(file, path)) return "";
  if (is_pure(file)) {
    const std::string reason = objection_of_pure_file(file, path);
    if (!reason.empty()) return reason;
  }
  if (is_ours(path)) return stands_on(*room, path) ? "" : with_reason("not a room to stand on", *room);
  if (is_standard(path) || is_message_type(path) || is_of_the_system(path)) return "";
  return starts_with_any(path, room->libraries) ? "" : with_reason("not a library of this room", *room);
}

std::string impure_name(std::string_view file, std::string_view source) {
  // Its last words before it aborts; readers read.
  if (!is_pure(file) || file == "core/check.cc" || starts_with_any(file, kReaders)) return "";
  const std::string text = without_comments(source);
  const auto found = std::find_if(kImpureNames.begin(), kImpureNames.end(), [&](std::string_view name) {
    return text.find(name) != std::string::npos;
  });
  return found == kImpureNames.end() ? "" : std::string(*found);
}

std::vector<std::string> breaches(const std::vector<SourceFile>& sources) {
  std::vector<std::string> found;
  for (const SourceFile& source : sources) {
    const std::string name = impure_name(source.path, source.text);
    if (!name.empty())
      found.push_back(source.path + ": uses " + name + ": a pure file has no clock, file or log");
    for (const Include& include : includes_of(source.text)) {
      const std::string reason = objection(source.path, include.path);
      if (reason.empty()) continue;
      found.push_back(source.path + ":" + std::to_string(include.line) + ": includes " + include.path + ": " +
                      reason);
    }
  }
  return found;
}

std::string room_cycle(const std::vector<SourceFile>& sources, int depth) {
  std::map<std::string, std::set<std::string>> edges;
  for (const SourceFile& source : sources) {
    if (is_one_of(first_element(source.path), kFree)) continue;
    const std::string from = cut(folder_of(source.path), depth);
    for (const Include& include : includes_of(source.text)) {
      const std::string to = cut(folder_of(include.path), depth);
      if (is_ours(include.path) && to != from) edges[from].insert(to);
    }
  }
  std::string cycle;
  std::set<std::string> done;
  for (const auto& [room, unused] : edges) {
    std::vector<std::string> trail;
    visit_room(edges, room, trail, done, cycle);
  }
  return cycle;
}

}  // namespace halocline::layers
