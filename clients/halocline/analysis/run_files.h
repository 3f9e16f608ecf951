// Where a run leaves what it makes.
#pragma once

#include <string>

namespace halocline::clients {

struct RunFiles {
  std::string log;     // LCM log
  std::string config;  // effective configuration, beside the log, its name ending in .toml
  std::string report;  // beside the log: report.html, or the name of a log that was named, ending in .html
  std::string csv;     // folder
};

// Names the files and makes their folders. `log` and `csv`: empty for the default within `out`. Throws
// std::runtime_error when a folder cannot be made.
RunFiles run_files(const std::string& out, const std::string& name, const std::string& log,
                   const std::string& csv);

// Whether a log of this name is there, or a part of one.
[[nodiscard]] bool has_log(const std::string& path);

// A new folder for the results of a run: `base`, or "base-2", "base-3", ..., the first that is not there yet. Throws
// std::runtime_error when it cannot be made.
std::string make_new_folder(const std::string& base);

// The log's name, ending in .html.
std::string report_beside(const std::string& log);

// The effective configuration that a run recorded beside its log.
std::string config_beside(const std::string& log);

// Replaces the file; throws std::runtime_error when it cannot be written.
void write_text(const std::string& path, const std::string& text);

}  // namespace halocline::clients
