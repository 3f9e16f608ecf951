// SPDX-License-Identifier: BSD-3-Clause
// Where a sweep keeps its runs: OUT/plan.toml, OUT/runs/<identity>/, and the gathered tables.
//
// A run's folder is named by what it computes: the XXH3 hash (64 bits) of its effective configuration and of
// this program's version. So a run that is done stays done when a sweep is started again, or with more
// values, seeds or axes; and is done anew when the scenario changes. Files that the scenario names (terrain,
// profiles) are not part of the hash. result.json is written last, and moved into place whole: a folder
// without it is a run that did not finish. So is one whose result.json does not have the check sum in
// result.xxh3 (XXH3 of the folder's name and of it): it was damaged or edited, or is that of another run.
#pragma once

#include <optional>
#include <string>

#include "clients/halocline/sweep/run_metrics.h"
#include "clients/halocline/sweep/sweep_plan.h"

namespace halocline::clients {

// 16 hexadecimal digits.
std::string run_identity(const std::string& effective_configuration);

std::string run_folder(const std::string& out, const std::string& identity);
// Empty while there is none, or none that is whole.
[[nodiscard]] std::optional<RunMetrics> result_in(const std::string& folder);
void write_result(const std::string& folder, const RunMetrics& metrics);

std::string plan_path(const std::string& out);
void write_plan(const std::string& out, const SweepPlan& plan);

// A job array for SLURM's sbatch: `tasks` tasks, each of which does its share of the runs by calling
// `program` (absolute path). Its head comment explains how to submit it and how to gather.
std::string slurm_script(const std::string& program, const std::string& out, std::size_t tasks);

}  // namespace halocline::clients
