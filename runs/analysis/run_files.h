// SPDX-License-Identifier: BSD-3-Clause
// Files that commands write: the files of a run, and the rule that no command replaces an existing file
// unless it is told to.
#pragma once

#include <string>
#include <vector>

namespace halocline::clients {

struct RunFiles {
  std::string log;  // LCM log
  // Effective configuration, beside the log, with a name that ends in .toml; empty: not written.
  std::string config;
  // Report beside the log: report.html, or the name of a log that the user named, ending in .html.
  std::string report;
  std::string csv;  // folder of CSV files
};

// Names the files and creates their folders. Empty `log` and `csv` select the defaults within `out`. When the
// `scenario` that was read is the file where the configuration would go, it is kept: the log holds the
// configuration as well. Throws std::runtime_error when a folder cannot be created.
RunFiles run_files(const std::string& out, const std::string& name, const std::string& log,
                   const std::string& csv, const std::string& scenario = "");

// OutputFiles of a command, and whether --force allows it to replace existing ones.
struct OutputFiles {
  std::vector<std::string> paths;  // files and folders; empty and "-" (standard output) are ignored
  bool may_replace = false;
};

// Throws InvalidArgument when one of `outputs` exists with content and may not be replaced, and always when
// it is one of `inputs`, the files that the command reads. Devices, pipes and empty files may be written.
void require_free(const OutputFiles& outputs, const std::vector<std::string>& inputs = {});

// Returns the log with this name and its existing parts (rotated logs have several).
std::vector<std::string> files_of_log(const std::string& path);

// Creates a new folder for the results of a run and returns its name: `base`, or "base-2", "base-3", ..., the
// first that does not exist. Throws std::runtime_error when it cannot be created.
std::string make_new_folder(const std::string& base);

// Returns the log in a run's folder when `path` is a folder, otherwise `path` itself. Throws InvalidArgument
// that lists the logs found unless there is exactly one.
std::string log_of_run(const std::string& path);

// Returns the log's name with the ending .html.
std::string report_beside(const std::string& log);

// Returns the name of the effective configuration that a run writes beside its log.
std::string config_beside(const std::string& log);

// Replaces the file as replace_file does; writes to standard output when `path` is empty or "-".
void write_output(const std::string& path, const std::string& text);

}  // namespace halocline::clients
