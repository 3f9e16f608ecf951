#include "conductor/lockstep_options.h"

#include <charconv>
#include <sstream>

#include "conductor/lockstep_run.h"
#include "core/check.h"

namespace halocline::conductor {
namespace {

double number_of(const std::string& option, const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  require(whole && value >= 0 && value <= 1e6,
          option + " is '" + text + "'; allowed is a number from 0 to 1e6");
  return value;
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
      {"--lockstep", "lead a lockstep: nobody passes an instant before all have finished it", nullptr,
       &lockstep_},
      {"--expect", "who must have joined before time goes on: names, by commas (lockstep)", &expect_},
      {"--log", "LCM log of the run, stamped with simulation time (lockstep)", &log_},
      {"--journal", "file from which a conductor that was killed goes on (lockstep)", &journal_},
      {"--rate", "simulated seconds per wall second; 0: as fast as all follow (lockstep)", &rate_},
      {"--drop-after",
       "seconds of silence after which a participant is dropped; 0: it is waited for (lockstep)",
       &drop_after_},
      {"--no-lookahead", "exchange every step: nobody goes on alone (lockstep)", nullptr, &one_by_one_},
      {"--bridge-bus", "hear what others say on the ordinary bus, at the next instant (lockstep)", nullptr,
       &outside_},
  };
}

bool LockstepOptions::run_if_asked(const bus::NodeProgram::Context& context) const {
  if (!lockstep_) return false;
  LockstepRun run;
  run.expected = names_of(expect_);
  run.log_path = log_;
  run.journal_path = journal_;
  run.rate = number_of("--rate", rate_);
  run.drop_after = SimDuration::from_seconds(number_of("--drop-after", drop_after_));
  run.windows = !one_by_one_;
  run.hear_outside = outside_;
  run.sync_url = context.sync_url;
  run_lockstep(context.lcm, context.identity, context.scenario, run, bus::stop_requested);
  return true;
}

}  // namespace halocline::conductor
