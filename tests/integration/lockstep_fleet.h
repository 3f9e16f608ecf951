// A run in lockstep as separate processes, on the test's own loopback bus: started, harmed, started again.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace halocline::testing {

// The network that all processes see: shares of the datagrams that each sends.
struct Weather {
  double loss = 0, doubling = 0, reordering = 0;
};
inline std::ostream& operator<<(std::ostream& out, const Weather& weather) {
  return out << weather.loss << " lost, " << weather.doubling << " doubled, " << weather.reordering
             << " overtaken";
}

class LockstepFleet {
 public:
  // Runs the scenario of tests/data with these settings ("section.key=value"), with so many channel servers.
  LockstepFleet(std::string scenario, std::vector<std::string> settings, Weather weather = {},
                int shards = 1);
  ~LockstepFleet();

  const std::vector<std::string>& participants() const { return participants_; }
  // The conductor with more options than those that name journal and log; and each participant.
  void start_conductor(const std::vector<std::string>& options = {});
  void start(const std::string& participant);
  void start_all(const std::vector<std::string>& conductor_options = {});

  Process& at(const std::string& name) { return *processes_.at(name); }
  // Kills it where it stands, and starts it again.
  void kill_and_restart(const std::string& name);
  // Starts again whatever has ended with an error; until the conductor has ended with 0. False after `limit`.
  bool run_to_the_end(std::chrono::seconds limit);

  // What the conductor's lives have written so far.
  std::string conductor_output();
  std::string log_bytes() const;
  std::map<std::string, int> events_by_channel() const;
  // The simulation output alone (`halocline log output`) of this run, and of the same in one process.
  std::string output_bytes() const;
  std::string output_of_one_process(const std::vector<std::string>& more_settings = {});
  // The log of the same scenario in one process (`halocline run`).
  std::string log_of_one_process(const std::vector<std::string>& more_settings = {});

 private:
  std::vector<std::string> command(const std::string& program, bool through_weather) const;
  std::vector<std::string> settings_as_options() const;

  std::string output_of(const std::filesystem::path& log) const;

  int shards_;
  std::vector<std::string> participants_;
  std::string scenario_;
  std::vector<std::string> settings_;
  Weather weather_;
  std::filesystem::path folder_;
  std::map<std::string, std::unique_ptr<Process>> processes_;
  std::vector<std::string> conductor_options_;
  std::string earlier_output_;
};

}  // namespace halocline::testing
