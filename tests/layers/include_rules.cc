#include "tests/layers/include_rules.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

namespace halocline::layers {
namespace {

using Words = std::vector<std::string_view>;

bool starts_with_any(std::string_view text, const Words& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](std::string_view prefix) { return text.starts_with(prefix); });
}

bool is_one_of(std::string_view text, const Words& words) {
  return std::find(words.begin(), words.end(), text) != words.end();
}

std::string_view folder_of(std::string_view path) { return path.substr(0, path.find('/')); }
std::string_view name_of(std::string_view path) { return path.substr(path.rfind('/') + 1); }
std::string_view stem_of(std::string_view path) {
  const std::string_view name = name_of(path);
  return name.substr(0, name.find('.'));
}

const Words kFolders{"core",           "acoustics", "bathymetry", "vehicle_sim",
                     "channel_server", "conductor", "bus",        "clients"};
const Words kFree{"tests", "bench"};  // they may look at everything

// What a pure file may not know: clocks, threads, files, logging, and random numbers that are drawn by turn.
const Words kImpure{"chrono", "ctime",   "thread",   "mutex",      "shared_mutex", "condition_variable",
                    "atomic", "future",  "barrier",  "latch",      "semaphore",    "stop_token",
                    "random", "fstream", "iostream", "filesystem", "csignal",      "syncstream",
                    "print"};
// The named readers of files, behind an interface that gives values.
const Words kReaders{"acoustics/profile_reader", "acoustics/profile_grid_reader", "bathymetry/terrain_loader",
                     "bathymetry/raster_", "bathymetry/gdal_"};
const Words kReaderHeaders{"fstream", "filesystem", "iostream", "mutex", "cstdio", "atomic"};

// Headers that pure files may include hold these all the same (<cstdio> has snprintf, and fopen).
const Words kImpureNames{"std::printf",   "std::puts",    "fprintf",     "fopen",
                         "std::cout",     "std::cerr",    "getenv",      "std::rand(",
                         "random_device", "steady_clock", "system_clock"};

struct Folder {
  Words ours;         // prefixes of our own files that its pure files may include
  Words third_party;  // prefixes of others' headers
};

const std::map<std::string_view, Folder>& pure_rules() {
  static const std::map<std::string_view, Folder> rules{
      {"core", {{"core/"}, {"Eigen/"}}},
      {"acoustics", {{"core/", "acoustics/"}, {"Eigen/"}}},
      {"bathymetry", {{"core/", "bathymetry/"}, {"Eigen/"}}},
      {"vehicle_sim", {{"core/", "vehicle_sim/", "bathymetry/terrain/terrain.h"}, {"Eigen/"}}},
      {"channel_server", {{"core/", "acoustics/", "channel_server/"}, {"Eigen/"}}}};
  return rules;
}

// Others' headers that single files of the pure folders are there to wrap.
bool wraps(std::string_view file, std::string_view header) {
  const bool geography = header.starts_with("GeographicLib/");
  const bool raster = starts_with_any(header, {"gdal", "ogr", "cpl_"});
  if (starts_with_any(file, kReaders)) return raster || geography;
  if (file.starts_with("bathymetry/local_frame")) return geography;
  return header.starts_with("ode/") &&
         starts_with_any(file, {"vehicle_sim/ode_", "vehicle_sim/vehicle_world"});
}

bool is_standard(std::string_view path) {
  return path.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string_view::npos;
}
bool is_ours(std::string_view path) {
  return path.find('/') != std::string_view::npos && is_one_of(folder_of(path), kFolders);
}
bool is_lcm(std::string_view path) { return path.starts_with("lcm/"); }
bool is_message_type(std::string_view path) { return starts_with_any(path, {"halocline/", "lcmtypes/"}); }

bool is_node_file(std::string_view path) {
  const std::string_view stem = stem_of(path);
  return stem == "main" || stem.ends_with("_node") || stem.ends_with("_config") ||
         stem.ends_with("_messages");
}

bool is_pure(std::string_view file) { return pure_rules().contains(folder_of(file)) && !is_node_file(file); }

std::string objection_of_pure_file(std::string_view file, std::string_view path, const Folder& rule) {
  if (is_lcm(path)) return "a pure file knows no LCM";
  if (is_message_type(path) || path == "bus/messages.h") return "a pure file knows no message types";
  if (is_ours(path)) {
    if (!starts_with_any(path, rule.ours)) return "a pure file of this folder may not stand on that";
    return is_node_file(path) ? "a pure file knows no node" : "";
  }
  if (is_standard(path)) {
    const bool excepted = starts_with_any(file, kReaders) && is_one_of(path, kReaderHeaders);
    return is_one_of(path, kImpure) && !excepted ? "a pure file has no clock, thread, file or log" : "";
  }
  return starts_with_any(path, rule.third_party) || wraps(file, path) ? "" : "not a library of this folder";
}

// What holds for nodes, bus and clients alike.
std::string objection_to_library(std::string_view file, std::string_view path) {
  const std::string_view folder = folder_of(file);
  if (is_lcm(path) && folder != "bus") return "only bus/ includes LCM's headers: include bus/bus.h";
  if (path.starts_with("spdlog/") && folder != "bus") return "only bus/ logs through spdlog: use EventLog";
  if (path.starts_with("toml++/") && file != "bus/config/config_document.h")
    return "only bus/config/config_document.h does";
  if (path == "xxhash.h" && file != "clients/halocline/sweep/sweep_folder.cc")
    return "only the identity of stored runs is an XXH3";
  if (path.starts_with("boost/") && file != "clients/halocline/sweep/confidence.cc")
    return "only the confidence intervals use Boost.Math here";
  if (path.starts_with("fmt/") && folder != "bus" && folder != "clients") return "only bus/ and clients/ do";
  if (path == "netcdf.h" && file != "clients/halocline/sweep/sweep_netcdf.cc")
    return "only the sweep's writer does";
  if (path.starts_with("CLI/") && folder != "bus" && folder != "clients") return "only bus/ and clients/ do";
  if (starts_with_any(path, {"gtest/", "gmock/", "benchmark/"})) return "only tests and benchmarks do";
  if (starts_with_any(path, {"ode/", "gdal", "ogr", "cpl_"})) return "only the pure files that wrap it do";
  return "";
}

std::string objection_of_client(std::string_view file, std::string_view path) {
  if (file.find("foreign") != std::string_view::npos) {
    return is_ours(path) ? "the foreign vehicle shows that message types are enough" : "";
  }
  const bool library = starts_with_any(
      file, {"clients/modem/", "clients/autopilot/", "clients/traffic/", "clients/localiser/"});
  if (library && is_ours(path) && is_node_file(path) && folder_of(path) != "clients") {
    return "only the halocline command includes other processes' nodes";
  }
  return objection_to_library(file, path);
}

// The vehicle simulator touches the ground that the bathymetry service answers from: its main makes the same terrain.
bool makes_the_same_terrain(std::string_view file, std::string_view path) {
  return file == "vehicle_sim/main.cc" && path == "bathymetry/bathymetry_config.h";
}

std::string objection_of_node_file(std::string_view file, std::string_view path) {
  if (makes_the_same_terrain(file, path)) return "";
  const std::string_view folder = folder_of(file);
  if (is_ours(path)) {
    const auto pure = pure_rules().find(folder);
    const bool own = folder_of(path) == folder || is_one_of(folder_of(path), {"core", "bus"}) ||
                     (pure != pure_rules().end() && starts_with_any(path, pure->second.ours));
    return own ? "" : "a node stands on bus and its own pure part";
  }
  return objection_to_library(file, path);
}

std::string objection_of_bus(std::string_view file, std::string_view path) {
  if (is_ours(path) && !starts_with_any(path, {"bus/", "core/"})) return "bus stands on core alone";
  return objection_to_library(file, path);
}

void visit_folder(const std::map<std::string, std::set<std::string>>& edges, const std::string& folder,
                  std::vector<std::string>& trail, std::string& cycle) {
  const auto seen = std::find(trail.begin(), trail.end(), folder);
  if (!cycle.empty()) return;
  if (seen != trail.end()) {
    for (auto step = seen; step != trail.end(); ++step) cycle += *step + " -> ";
    cycle += folder;
    return;
  }
  trail.push_back(folder);
  const auto found = edges.find(folder);
  if (found != edges.end()) {
    for (const std::string& next : found->second) visit_folder(edges, next, trail, cycle);
  }
  trail.pop_back();
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace

std::string objection(std::string_view file, std::string_view path) {
  const std::string_view folder = folder_of(file);
  if (path.ends_with(".cc") || stem_of(path) == "main") return "nobody includes a main or a source file";
  if (path.find("..") != std::string_view::npos) return "paths start at the root of the repository";
  if (is_one_of(folder, kFree)) return "";
  if (path.starts_with("tests/") || path.starts_with("bench/")) return "tests are not part of the programs";
  if (path.find_first_of("/.") == std::string_view::npos && !is_standard(path)) return "no path can be read";
  if (is_pure(file)) return objection_of_pure_file(file, path, pure_rules().at(folder));
  if (folder == "bus") return objection_of_bus(file, path);
  if (folder == "clients") return objection_of_client(file, path);
  if (is_one_of(folder, kFolders)) return objection_of_node_file(file, path);
  return "the folder has no rule in tests/layers";
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

std::vector<SourceFile> sources_below(const std::string& root) {
  std::vector<SourceFile> sources;
  for (const std::string_view folder : {"core", "acoustics", "bathymetry", "vehicle_sim", "channel_server",
                                        "conductor", "bus", "clients", "tests", "bench"}) {
    const std::filesystem::path start = std::filesystem::path(root) / folder;
    if (!std::filesystem::exists(start)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(start)) {
      const std::string extension = entry.path().extension().string();
      if (!entry.is_regular_file() || !is_one_of(extension, {".h", ".hpp", ".cc", ".cpp", ".c", ".in"}))
        continue;
      sources.push_back(
          {std::filesystem::relative(entry.path(), root).generic_string(), text_of(entry.path())});
    }
  }
  std::sort(sources.begin(), sources.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
  return sources;
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

std::string folder_cycle(const std::vector<SourceFile>& sources) {
  std::map<std::string, std::set<std::string>> edges;
  for (const SourceFile& source : sources) {
    const std::string from(folder_of(source.path));
    if (is_one_of(from, kFree)) continue;
    for (const Include& include : includes_of(source.text)) {
      const std::string to(folder_of(include.path));
      if (is_ours(include.path) && to != from) edges[from].insert(to);
    }
  }
  std::string cycle;
  for (const auto& [folder, unused] : edges) {
    std::vector<std::string> trail;
    visit_folder(edges, folder, trail, cycle);
  }
  return cycle;
}

}  // namespace halocline::layers
