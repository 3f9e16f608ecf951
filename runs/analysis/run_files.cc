// SPDX-License-Identifier: BSD-3-Clause
#include "runs/analysis/run_files.h"

#include <filesystem>
#include <iostream>
#include <set>
#include <stdexcept>

#include "bus/logs/log_series.h"
#include "core/atomic_file.h"
#include "core/check.h"

namespace halocline::clients {
namespace {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
  std::error_code error;
  if (!folder.empty()) fs::create_directories(folder, error);
  if (error) throw std::runtime_error("cannot make the folder " + folder.string() + ": " + error.message());
}

bool holds_something(const fs::path& path) {
  std::error_code error;
  return (fs::is_regular_file(path, error) || fs::is_directory(path, error)) && !fs::is_empty(path, error);
}

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;  // set when one of them does not exist
  return fs::equivalent(a, b, error);
}

}  // namespace

RunFiles run_files(const std::string& out, const std::string& name, const std::string& log,
                   const std::string& csv, const std::string& scenario) {
  RunFiles files;
  files.log = log.empty() ? (fs::path(out) / (name + ".lcm")).string() : log;
  files.csv = csv.empty() ? (fs::path(out) / "csv").string() : csv;
  files.config = config_beside(files.log);
  files.report =
      log.empty() ? (fs::path(files.log).parent_path() / "report.html").string() : report_beside(files.log);
  require(files.log != files.config && files.log != files.report && fs::path(files.log).extension() != ".csv",
          "the log is to be " + files.log +
              "; what lies beside a log is called so: allowed is another name, such as NAME.lcm");
  make_folder(fs::path(files.log).parent_path());
  if (is_same_file(files.config, scenario)) files.config.clear();
  return files;
}

void require_free(const OutputFiles& outputs, const std::vector<std::string>& inputs) {
  for (const std::string& path : outputs.paths) {
    if (path.empty() || path == "-" || !holds_something(path)) continue;
    for (const std::string& input : inputs)
      require(!is_same_file(path, input), path + " is what is read; allowed is another place to write to");
    require(outputs.may_replace, path + " is there already; --force replaces it");
  }
}

std::vector<std::string> files_of_log(const std::string& path) {
  std::vector<std::string> files = bus::parts_of_log(path);
  files.insert(files.begin(), path);
  return files;
}

std::string make_new_folder(const std::string& base) {
  make_folder(fs::path(base).parent_path());
  for (int number = 1;; ++number) {
    const std::string folder = number == 1 ? base : base + "-" + std::to_string(number);
    std::error_code error;
    if (fs::create_directory(folder, error)) return folder;  // no other run uses this new folder
    if (!fs::is_directory(folder))
      throw std::runtime_error("cannot make the folder " + folder + ": " + error.message());
  }
}

std::string log_of_run(const std::string& path) {
  if (!fs::is_directory(path)) return path;
  std::set<std::string> logs;
  for (const auto& entry : fs::directory_iterator(path)) {
    if (entry.path().extension() == ".lcm" && entry.is_regular_file())
      logs.insert(bus::first_part_of_log(entry.path().string()));
  }
  std::string names;
  for (const std::string& log : logs) names += (names.empty() ? ": " : ", ") + log;
  require(logs.size() == 1, path + " is a folder that holds " + std::to_string(logs.size()) +
                                " logs (*.lcm); allowed is a log, or a folder with one" + names);
  return *logs.begin();
}

std::string report_beside(const std::string& log) {
  return fs::path(log).replace_extension(".html").string();
}

std::string config_beside(const std::string& log) {
  return fs::path(log).replace_extension(".toml").string();
}

void write_output(const std::string& path, const std::string& text) {
  if (path.empty() || path == "-") {
    std::cout << text << std::flush;
  } else {
    replace_file(path, text);
  }
}

}  // namespace halocline::clients
