// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <mutex>
#include <optional>
#include <sstream>
#include <thread>
#include <vector>

#include "bus/logs/log_reader.h"
#include "bus/runtime/node_process.h"
#include "bus/runtime/thread_pool.h"
#include "bus/transport/event_log.h"
#include "core/atomic_file.h"
#include "core/check.h"
#include "core/files/input_file.h"
#include "core/memory/memory_budget.h"
#include "halocline/commands.h"
#include "halocline/sweep/child_program.h"
#include "halocline/sweep/run_metrics.h"
#include "halocline/sweep/sweep_folder.h"
#include "halocline/sweep/sweep_plan.h"
#include "halocline/sweep/sweep_summary.h"
#include "runs/analysis/run_files.h"
#include "simulation/composition.h"
#include "simulation/log_estimate.h"

namespace halocline::clients {
namespace {

namespace fs = std::filesystem;

struct SweepOptions {
  std::string plan, out, seeds, slurm;
  std::vector<std::string> axes, overrides;
  double duration_s = 0, level = 0;
  std::size_t jobs = 0, task = 0, of = 0, slurm_tasks = 1000;
  bool gather = false, keep_logs = false, list = false, quiet = false, force = false;
};

std::string text_of(const std::string& path) {
  std::ifstream file = open_input(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

bool is_plan(const std::string& path) {
  const std::string text = "\n" + text_of(path);
  return text.find("\n[sweep]") != std::string::npos || text.find("\n[[axis]]") != std::string::npos;
}

// Returns the plan: the plan file or scenario with the additions of the command line; without a file, the
// plan of an earlier start.
SweepPlan plan_of(const SweepOptions& options) {
  SweepPlan plan;
  const std::string file = options.plan.empty() ? plan_path(options.out) : options.plan;
  require(fs::exists(file), options.plan.empty()
                                ? "there is no " + file + "; name a scenario or a plan"
                                : file + ": cannot be read; a scenario or a plan (TOML) is needed");
  if (is_plan(file))
    plan = load_plan(file);
  else
    plan.scenario = file;
  for (const std::string& axis : options.axes) plan.axes.push_back(parse_axis(axis));
  plan.overrides.insert(plan.overrides.end(), options.overrides.begin(), options.overrides.end());
  if (!options.seeds.empty()) plan.seeds = parse_seeds(options.seeds);
  if (options.duration_s > 0) plan.duration_s = options.duration_s;
  if (options.level > 0) plan.level = options.level;
  check(plan);
  return plan;
}

// Run of a sweep that is ready to start.
struct Job {
  SweepRun run;
  std::string folder;
  double duration_s = 0, memory_bytes = 0;  // memory: its terrain, which takes most of it
};

// Prepares all runs. Every configuration is checked before anything runs.
std::vector<Job> jobs_of(const SweepPlan& plan, const std::string& out) {
  std::vector<Job> jobs;
  for (std::size_t i = 0; i < plan.runs(); ++i) {
    Job job{run_of(plan, i), {}};
    const ScenarioConfig config = load_scenario(plan.scenario.place(), job.run.overrides);
    // The places of its files tell runs apart; their contents tell whether a run is to be done again.
    job.folder = run_folder(out, run_identity(effective_toml(config) + portable_toml(config)));
    job.duration_s = config.scenario.duration.seconds();
    job.memory_bytes = estimated_memory_bytes(config);
    jobs.push_back(std::move(job));
  }
  return jobs;
}

std::vector<std::string> command_of(const SweepPlan& plan, const Job& job) {
  std::vector<std::string> command{fs::read_symlink("/proc/self/exe").string(), "run", plan.scenario.place()};
  for (const std::string& text : job.run.overrides) {
    command.emplace_back("--set");
    command.push_back(text);
  }
  for (const std::string& word : {std::string("--log"), job.folder + "/run.lcm", std::string("--no-csv"),
                                  std::string("--no-report"), std::string("--quiet"), std::string("--force")})
    command.push_back(word);
  return command;
}

std::string last_line(const std::string& path) {
  const std::string text = text_of(path);
  const auto end = text.find_last_not_of('\n');
  if (end == std::string::npos) return "no output";
  const auto start = text.rfind('\n', end);
  return text.substr(start == std::string::npos ? 0 : start + 1,
                     end - (start == std::string::npos ? 0 : start + 1) + 1);
}

// Runs one process and stores its results. Returns an error message; empty when done.
std::string do_job(const SweepPlan& plan, const Job& job, bool keep_log) {
  std::error_code error;
  fs::create_directories(job.folder, error);
  if (error) return "cannot make the folder " + job.folder + ": " + error.message();
  const std::string output = job.folder + "/output.txt", log = job.folder + "/run.lcm";
  const ProgramEnd end = run_program({command_of(plan, job), output}, bus::stop_requested);
  if (end.stopped || bus::stop_requested()) return "stopped";
  if (end.exit_code != 0) return "exit code " + std::to_string(end.exit_code) + ": " + last_line(output);
  LogReader reader(log);
  const RunMetrics metrics = metrics_of(reader);
  if (metrics.simulated_s < job.duration_s - 1e-6)
    return "it ended after " + std::to_string(metrics.simulated_s) + " s of " +
           std::to_string(job.duration_s) + " s";
  write_result(job.folder, metrics);
  if (!keep_log) fs::remove(log, error);
  return "";
}

// Runs what is not done yet; returns the number of failed runs.
std::size_t do_jobs(const SweepPlan& plan, const std::vector<Job>& jobs, const SweepOptions& options) {
  std::vector<const Job*> waiting;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const bool ours = options.of == 0 || i % options.of == options.task;
    if (ours && !result_in(jobs[i].folder)) waiting.push_back(&jobs[i]);
  }
  if (!options.quiet) std::fprintf(stderr, "%zu runs, %zu to do here\n", jobs.size(), waiting.size());
  std::mutex mutex;
  std::size_t done = 0, failed = 0;
  const auto work = [&](std::size_t i) {
    if (bus::stop_requested()) return;
    std::string problem;
    try {
      problem = do_job(plan, *waiting[i], options.keep_logs);
    } catch (const std::exception& error) {
      problem = error.what();
    }
    const std::lock_guard lock(mutex);
    ++(problem.empty() ? done : failed);
    if (!problem.empty())
      std::fprintf(stderr, "halocline: run %zu (%s): %s\n", waiting[i]->run.index, waiting[i]->folder.c_str(),
                   problem.c_str());
    if (!options.quiet) std::fprintf(stderr, "%zu of %zu done, %zu failed\n", done, waiting.size(), failed);
  };
  const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
  const std::size_t jobs_at_a_time = std::min(options.jobs > 0 ? options.jobs : cores, waiting.size());
  double largest_bytes = 0;
  for (const Job* job : waiting) largest_bytes = std::max(largest_bytes, job->memory_bytes);
  require_memory(static_cast<double>(jobs_at_a_time) * largest_bytes,
                 std::to_string(jobs_at_a_time) + " runs at a time", "--jobs takes fewer");
  if (jobs_at_a_time > 0) bus::ThreadPool(static_cast<int>(jobs_at_a_time)).for_each(waiting.size(), work);
  return waiting.size() - done;
}

int gather(const SweepPlan& plan, const std::vector<Job>& jobs, const SweepOptions& options) {
  std::vector<std::optional<RunMetrics>> runs;
  std::vector<std::string> folders;
  for (const Job& job : jobs) {
    runs.push_back(result_in(job.folder));
    folders.push_back(job.folder);
  }
  const auto missing = std::count(runs.begin(), runs.end(), std::nullopt);
  const SweepResults results = summed_up(plan, std::move(runs), std::move(folders));
  write_csvs(results, options.out);
  write_netcdf(results, options.out + "/sweep.nc");
  if (!options.quiet) print(std::cout, results);
  std::cout << "results     " << options.out << "/points.csv, pairs.csv, runs.csv, sweep.nc\n";
  if (missing > 0)
    std::cout << "missing     " << missing << " of " << jobs.size() << " runs have no result\n";
  return missing > 0 ? kFailed : kDone;
}

int write_slurm(const std::vector<Job>& jobs, const SweepOptions& options) {
  const std::size_t tasks = std::min(jobs.size(), options.slurm_tasks);
  replace_file(options.slurm, slurm_script(fs::read_symlink("/proc/self/exe").string(), options.out, tasks));
  std::cout << "job array   " << options.slurm << ": " << jobs.size() << " runs in " << tasks
            << " tasks; sbatch " << options.slurm << "\n";
  return kDone;
}

int sweep(SweepOptions options) {
  options.out = fs::weakly_canonical(fs::absolute(options.out)).string();
  require(options.of == 0 || options.task < options.of, "--task must be below --of");
  require_free({{options.slurm}, options.force}, {options.plan});
  const SweepPlan plan = plan_of(options);
  const std::vector<Job> jobs = jobs_of(plan, options.out);
  if (options.list) {
    for (const Job& job : jobs) {
      std::cout << job.run.index << " " << job.folder << (result_in(job.folder) ? " done" : "");
      for (const std::string& text : job.run.overrides) std::cout << " " << text;
      std::cout << "\n";
    }
    return kDone;
  }
  // Tasks of one sweep share the plan.
  if (options.of == 0 && !options.gather) write_plan(options.out, plan);
  if (!options.slurm.empty()) return write_slurm(jobs, options);
  if (options.gather) return gather(plan, jobs, options);
  bus::catch_stop_signals();
  const std::size_t undone = do_jobs(plan, jobs, options);
  const int gathered = options.of > 0 ? (undone > 0 ? kFailed : kDone) : gather(plan, jobs, options);
  return bus::interrupt_requested() ? kInterrupted : gathered;
}

void add_plan_options(CLI::App& command, SweepOptions& options) {
  command.add_option("plan", options.plan,
                     "a plan, or a scenario that options make one of; default: the plan in --out");
  command.add_option("--out", options.out, "folder of the sweep; what is done in it is not done again")
      ->required();
  command
      .add_option("--axis", options.axes, "a key and its values: section.key=value,value,... (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  command.add_option("--seeds", options.seeds, "whole numbers and ranges: 1..20 or 1,5,9..12");
  command
      .add_option("--set", options.overrides, "change a key at every point: section.key=value (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  command
      .add_option("--duration", options.duration_s, "simulated seconds of each run; default: the scenario's")
      ->check(CLI::PositiveNumber);
  command.add_option("--level", options.level, "of the confidence intervals; default: 0.95")
      ->check(CLI::Range(0.5, 0.9999));
}

}  // namespace

void add_sweep_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<SweepOptions>();
  CLI::App* command = app.add_subcommand(
      "sweep", "Run a scenario over a grid of overrides and seeds, with confidence intervals");
  add_plan_options(*command, *options);
  command->add_option("--jobs", options->jobs, "runs at a time, each a process; default: one a core")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--keep-logs", options->keep_logs, "keep the LCM log of each run");
  command->add_flag("--list", options->list, "list the runs, and which are done");
  command->add_flag("--gather", options->gather, "only make the tables of what is done");
  CLI::Option* of = command->add_option("--of", options->of, "share the runs among this many tasks")
                        ->check(CLI::PositiveNumber);
  CLI::Option* task =
      command->add_option("--task", options->task, "do this task's runs only: 0 and up")->needs(of);
  of->needs(task);
  command->add_option("--slurm", options->slurm,
                      "write a job array for SLURM's sbatch here, and run nothing");
  command
      ->add_option("--slurm-tasks", options->slurm_tasks,
                   "tasks of the job array at most; SLURM's own limit is 1001")
      ->check(CLI::PositiveNumber);
  add_force_option(*command, options->force);
  command->add_flag("--quiet", options->quiet, "errors and where the results are only");
  command->footer(footer(
      "  halocline sweep scenarios/harbour.toml --axis environment.wind_mps=2,6,12 --seeds 1..20 --out wind\n"
      "  halocline sweep --out wind --gather\n"
      "  halocline sweep scenarios/harbour.toml --axis environment.wind_mps=2,6,12 --seeds 1..500 --out wind "
      "--slurm wind.sh"));
  command->callback([options, &exit_code] { exit_code = sweep(*options); });
}

}  // namespace halocline::clients
