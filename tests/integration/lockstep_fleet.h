// SPDX-License-Identifier: BSD-3-Clause
// A lockstep run as separate processes, on the test's own loopback bus: started, killed, restarted.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace halocline::testing {

// Faults of the network, as shares of the datagrams that each process sends.
struct NetworkFaults {
  double loss = 0, duplication = 0, reordering = 0;
};
inline std::ostream& operator<<(std::ostream& out, const NetworkFaults& faults) {
  return out << faults.loss << " lost, " << faults.duplication << " duplicated, " << faults.reordering
             << " reordered";
}

class LockstepFleet {
 public:
  // Runs the scenario of tests/data with these settings ("section.key=value"), with so many channel servers
  // and vehicle simulators.
  LockstepFleet(std::string scenario, std::vector<std::string> settings, NetworkFaults faults = {},
                int shards = 1, int blocks = 1);
  ~LockstepFleet();

  const std::vector<std::string>& participants() const { return participants_; }
  // The conductor with more options than those that name journal and log; and each participant.
  void start_conductor(const std::vector<std::string>& options = {});
  void start(const std::string& participant);
  void start_all(const std::vector<std::string>& conductor_options = {});

  Process& at(const std::string& name) { return *processes_.at(name); }
  // SIGKILL, and started again.
  void kill_and_restart(const std::string& name);
  // Restarts whatever has ended with an error, until the conductor has ended with 0. False when it hangs.
  bool run_to_the_end();

  // False after a generous time: until the log has so many bytes, and until the conductor's output holds a
  // text.
  bool wait_for_log(std::size_t bytes) const;
  bool wait_for_output(const std::string& text);
  // Leaves the log as a conductor killed while writing it would.
  void cut_log_in_half() const;

  // Of all incarnations of the conductor so far.
  std::string conductor_output();
  std::string log_bytes() const;
  std::map<std::string, int> events_by_channel() const;
  // The simulation output alone (`halocline log output`) of this run, and of the same in one process.
  std::string output_bytes() const;
  std::string output_of_one_process(const std::vector<std::string>& more_settings = {});
  // The log of the same scenario in one process (`halocline run`).
  std::string log_of_one_process(const std::vector<std::string>& more_settings = {});

 private:
  std::vector<std::string> command(const std::string& program, bool with_faults) const;
  std::vector<std::string> settings_as_options() const;
  void add_parts(const std::string& program, int count);

  std::string output_of(const std::filesystem::path& log) const;

  int shards_, blocks_;
  std::vector<std::string> participants_;
  std::string scenario_;
  std::vector<std::string> settings_;
  NetworkFaults faults_;
  std::filesystem::path folder_;
  std::map<std::string, std::unique_ptr<Process>> processes_;
  std::vector<std::string> conductor_options_;
  std::string earlier_output_;
};

}  // namespace halocline::testing
