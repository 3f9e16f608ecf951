// SPDX-License-Identifier: BSD-3-Clause
// Folder of a sweep: OUT/plan.toml, OUT/runs/<identity>/, and the tables of results.
//
// A run's folder is named by the computation: the XXH3 hash (64 bits) of its effective configuration and of
// this program's version. A run that is done thus stays done when a sweep is started again, or with more
// values, seeds or axes; it is repeated when the scenario changes. Files that the scenario names (terrain,
// profiles) are not part of the hash. result.json is written last and moved into place as a whole: a folder
// without it holds an unfinished run. The same holds when result.json does not match the checksum in
// result.xxh3 (XXH3 of the folder's name and of result.json): it was damaged or edited, or belongs to another
// run.
#pragma once

#include <optional>
#include <string>

#include "halocline/sweep/run_metrics.h"
#include "halocline/sweep/sweep_plan.h"

namespace halocline::clients {

// Returns the identity of a run: 16 hexadecimal digits.
std::string run_identity(const std::string& effective_configuration);

std::string run_folder(const std::string& out, const std::string& identity);
// Returns the result in a run's folder; empty when there is none or it is not valid.
[[nodiscard]] std::optional<RunMetrics> result_in(const std::string& folder);
void write_result(const std::string& folder, const RunMetrics& metrics);

std::string plan_path(const std::string& out);
void write_plan(const std::string& out, const SweepPlan& plan);

// Returns a job array for SLURM's sbatch with `tasks` tasks. Each does its share of the runs by calling
// `program` (absolute path). Its head comment explains how to submit it and how to gather the results.
std::string slurm_script(const std::string& program, const std::string& out, std::size_t tasks);

}  // namespace halocline::clients
