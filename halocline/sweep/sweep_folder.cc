// SPDX-License-Identifier: BSD-3-Clause
#include "halocline/sweep/sweep_folder.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "bus/version.h"
#include "core/atomic_file.h"
#include "core/hash.h"
#include "core/text/hex_digits.h"

namespace halocline::clients {
namespace {

namespace fs = std::filesystem;

std::string result_path(const std::string& folder) { return folder + "/result.json"; }
std::string check_sum_path(const std::string& folder) { return folder + "/result.xxh3"; }

std::optional<std::string> content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) return std::nullopt;
  return text.str();
}

// Returns the checksum of a result together with the name of its run's folder.
std::string check_sum(const std::string& folder, const std::string& text) {
  return hex_digits(xxh3(fs::path(folder).filename().string() + "\n" + text)) + "\n";
}

// Quotes a text for a shell, in single quotes.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

std::string run_identity(const std::string& effective_configuration) {
  return hex_digits(xxh3(std::string(bus::kVersion) + "\n" + effective_configuration));
}

std::string run_folder(const std::string& out, const std::string& identity) {
  return out + "/runs/" + identity;
}

std::optional<RunMetrics> result_in(const std::string& folder) {
  const auto text = content_of(result_path(folder));
  if (!text || content_of(check_sum_path(folder)) != check_sum(folder, *text)) return std::nullopt;
  try {
    return metrics_from_json(*text);
  } catch (const std::runtime_error&) {
    return std::nullopt;  // written by another version: the run is repeated
  }
}

void write_result(const std::string& folder, const RunMetrics& metrics) {
  const std::string text = to_json(metrics) + "\n";
  replace_file(check_sum_path(folder), check_sum(folder, text));
  replace_file(result_path(folder), text);
}

std::string plan_path(const std::string& out) { return out + "/plan.toml"; }

void write_plan(const std::string& out, const SweepPlan& plan) {
  std::error_code error;
  fs::create_directories(out, error);
  if (error) throw std::runtime_error("cannot make the folder " + out + ": " + error.message());
  replace_file(plan_path(out), to_toml(plan));
}

std::string slurm_script(const std::string& program, const std::string& out, std::size_t tasks) {
  constexpr const char* kScript = R"(#!/bin/bash
#SBATCH --job-name=halocline-sweep
#SBATCH --array=0-{last}
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --output=/dev/null
#
# Each task does its share of the runs; those that are done already are left out. Every node needs this
# program, the scenario's files and the folder at the same paths. Submit, then gather when all have ended:
#   job=$(sbatch --parsable THIS_FILE)
#   sbatch --dependency=afterany:$job --wrap {gather}
set -euo pipefail
task=${{SLURM_ARRAY_TASK_ID:?is set by sbatch}}
exec {sweep} --task "$task" --of {tasks} --jobs "${{SLURM_CPUS_PER_TASK:-1}}" \
  >{folder}/slurm-"$task".txt 2>&1
)";
  const std::string folder = fs::absolute(out).lexically_normal().string();
  const std::string sweep =
      quoted(program) + " sweep " + quoted(plan_path(folder)) + " --out " + quoted(folder);
  return fmt::format(kScript, fmt::arg("last", tasks - 1), fmt::arg("gather", quoted(sweep + " --gather")),
                     fmt::arg("sweep", sweep), fmt::arg("tasks", tasks), fmt::arg("folder", quoted(folder)));
}

}  // namespace halocline::clients
