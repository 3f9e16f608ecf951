#include "clients/halocline/sweep/sweep_folder.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "bus/version.h"
#include "clients/halocline/analysis/run_files.h"
#include "core/hash.h"

namespace halocline::clients {
namespace {

namespace fs = std::filesystem;

std::string result_path(const std::string& folder) { return folder + "/result.json"; }

// For a shell: in single quotes.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

std::string run_identity(const std::string& effective_configuration) {
  char digits[20];
  const std::uint64_t hash = fnv1a(std::string(bus::kVersion) + "\n" + effective_configuration);
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash));
  return digits;
}

std::string run_folder(const std::string& out, const std::string& identity) {
  return out + "/runs/" + identity;
}

std::optional<RunMetrics> result_in(const std::string& folder) {
  std::ifstream file(result_path(folder));
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) return std::nullopt;
  try {
    return metrics_from_json(text.str());
  } catch (const std::runtime_error&) {
    return std::nullopt;  // of another version, or edited: to be done again
  }
}

void write_result(const std::string& folder, const RunMetrics& metrics) {
  replace_whole(result_path(folder), to_json(metrics) + "\n");
}

std::string plan_path(const std::string& out) { return out + "/plan.toml"; }

void write_plan(const std::string& out, const SweepPlan& plan) {
  std::error_code error;
  fs::create_directories(out, error);
  if (error) throw std::runtime_error("cannot make the folder " + out + ": " + error.message());
  replace_whole(plan_path(out), to_toml(plan));
}

std::string slurm_script(const std::string& program, const std::string& out, std::size_t tasks) {
  const std::string folder = fs::absolute(out).lexically_normal().string();
  const std::string sweep =
      quoted(program) + " sweep " + quoted(plan_path(folder)) + " --out " + quoted(folder);
  const std::string of = std::to_string(tasks);
  return "#!/bin/bash\n"
         "#SBATCH --job-name=halocline-sweep\n"
         "#SBATCH --array=0-" +
         std::to_string(tasks - 1) +
         "\n"
         "#SBATCH --ntasks=1\n"
         "#SBATCH --cpus-per-task=1\n"
         "#SBATCH --output=/dev/null\n"
         "#\n"
         "# Each task does its share of the runs; those that are done already are left out. Every node needs "
         "this\n"
         "# program, the scenario's files and the folder at the same paths. Submit, then gather when all "
         "have ended:\n"
         "#   job=$(sbatch --parsable THIS_FILE)\n"
         "#   sbatch --dependency=afterany:$job --wrap " +
         quoted(sweep + " --gather") +
         "\n"
         "set -euo pipefail\n"
         "task=${SLURM_ARRAY_TASK_ID:?is set by sbatch}\n"
         "exec " +
         sweep + " --task \"$task\" --of " + of +
         " --jobs \"${SLURM_CPUS_PER_TASK:-1}\" \\\n"
         "  >" +
         quoted(folder) + "/slurm-\"$task\".txt 2>&1\n";
}

}  // namespace halocline::clients
