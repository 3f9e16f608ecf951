// SPDX-License-Identifier: BSD-3-Clause
#include "conductor/lockstep_options.h"

#include <cstddef>
#include <filesystem>
#include <set>
#include <sstream>

#include "bus/config/config.h"
#include "conductor/lockstep_run.h"
#include "core/check.h"
#include "core/csv_table.h"
#include "core/sim_time.h"

namespace halocline::conductor {
namespace {

double number_of(const std::string& option, const std::string& text) {
  const auto value = parse_number(text, 0.0, 1e6);
  require(value.has_value(), option + " is '" + text + "'; allowed is a number from 0 to 1e6");
  return *value;
}

std::filesystem::path real_path(const std::string& file) {
  return std::filesystem::weakly_canonical(std::filesystem::absolute(file));
}

std::set<std::string> names_of(const std::string& list) {
  std::set<std::string> names;
  std::istringstream in(list);
  for (std::string name; std::getline(in, name, ',');) {
    require(is_valid_name(name), "--expect names '" + name + "'; allowed is " + std::string(kNameRule));
    names.insert(name);
  }
  return names;
}

}  // namespace

std::vector<bus::ProgramOption> LockstepOptions::options() {
  return {
      {"--lockstep",
       "coordinate a lockstep run: time advances only when all participants have finished the step", nullptr,
       &lockstep_},
      {"--expect",
       "participants that must have joined before time advances: names, separated by commas (lockstep)",
       &expect_},
      {"--log", "LCM log of the run, stamped with simulation time (lockstep)", &log_},
      {"--journal", "file from which a killed conductor continues the run when started again (lockstep)",
       &journal_},
      {"--rate", "simulated seconds per wall second; 0: as fast as the participants step (lockstep)", &rate_},
      {"--drop-after", "seconds of silence after which a participant is dropped; 0: never (lockstep)",
       &drop_after_},
      {"--no-lookahead", "one exchange per step: no participant runs ahead on its own (lockstep)", nullptr,
       &no_lookahead_},
      {"--bridge-bus",
       "deliver messages of other publishers on the ordinary bus at the next instant (lockstep)", nullptr,
       &bridge_bus_},
  };
}

void LockstepOptions::require_none() const {
  LockstepOptions given = *this, none;
  const auto options = given.options(), defaults = none.options();
  for (std::size_t i = 0; i < options.size(); ++i) {
    const bool is_given =
        options[i].flag != nullptr ? *options[i].flag : *options[i].value != *defaults[i].value;
    require(!is_given,
            options[i].name + " needs --lockstep" +
                (options[i].value == &given.rate_ ? "; in real time it is --set time.rate=" + rate_ : ""));
  }
}

bool LockstepOptions::run_if_requested(const bus::NodeProgram::Context& context) const {
  if (!lockstep_) {
    require_none();
    return false;
  }
  require(log_.empty() || journal_.empty() || real_path(log_) != real_path(journal_),
          "--log and --journal are both " + log_ + "; allowed are two files");
  if (context.file != nullptr)
    for (const std::string& file : {log_, journal_}) context.file->require_no_input(file);
  LockstepRun run;
  run.expected = names_of(expect_);
  run.log_path = log_;
  run.journal_path = journal_;
  run.rate = number_of("--rate", rate_);
  run.drop_after = SimDuration::from_seconds(number_of("--drop-after", drop_after_));
  run.lookahead = !no_lookahead_;
  run.bridge_bus = bridge_bus_;
  run.sync_url = context.sync_url;
  run.bus_url = context.lcm_url;
  run_lockstep(context.lcm, context.identity, context.scenario, run, bus::stop_requested);
  return true;
}

}  // namespace halocline::conductor
