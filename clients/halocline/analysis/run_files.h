// SPDX-License-Identifier: BSD-3-Clause
// Where commands leave what they make: the files of a run, and the rule that no command replaces what is
// there unasked.
#pragma once

#include <string>
#include <vector>

namespace halocline::clients {

struct RunFiles {
  std::string log;  // LCM log
  // Effective configuration, beside the log, its name ending in .toml; empty: not written.
  std::string config;
  std::string report;  // beside the log: report.html, or the name of a log that was named, ending in .html
  std::string csv;     // folder
};

// Names the files and makes their folders. `log` and `csv`: empty for the default within `out`. Where the
// `scenario` that is read has the configuration's place it stays: the log holds what it was made with. Throws
// std::runtime_error when a folder cannot be made.
RunFiles run_files(const std::string& out, const std::string& name, const std::string& log,
                   const std::string& csv, const std::string& scenario = "");

// What a command is about to write, and whether --force allows that it replaces what is there.
struct Outputs {
  std::vector<std::string> paths;  // files and folders; empty and "-" (standard output) count as none
  bool may_replace = false;
};

// Throws InvalidArgument where one of `outputs` holds something already and may not be replaced, and always
// where it is one of `inputs`, the files that the command reads. Devices and pipes may be written, and what
// is empty.
void require_free(const Outputs& outputs, const std::vector<std::string>& inputs = {});

// The log of this name and the parts of it that are there (rotated logs have several).
std::vector<std::string> files_of_log(const std::string& path);

// A new folder for the results of a run: `base`, or "base-2", "base-3", ..., the first that is not there yet.
// Throws std::runtime_error when it cannot be made.
std::string make_new_folder(const std::string& base);

// The log of a run's folder: of `path` where that is a folder, otherwise `path` as it is. Throws
// InvalidArgument, with the logs that are there, unless there is just one.
std::string log_of_run(const std::string& path);

// The log's name, ending in .html.
std::string report_beside(const std::string& log);

// The effective configuration that a run recorded beside its log.
std::string config_beside(const std::string& log);

// Replaces the file as replace_file does; writes to standard output where `path` is empty or "-".
void write_output(const std::string& path, const std::string& text);

}  // namespace halocline::clients
