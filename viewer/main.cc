// SPDX-License-Identifier: BSD-3-Clause
#include <exception>
#include <iostream>
#include <stdexcept>

#include "bus/runtime/node_process.h"
#include "bus/runtime/output_check.h"
#include "viewer/monitor.h"
#include "viewer/monitor_options.h"

int main(int argc, char** argv) {
  try {
    const auto options = halocline::monitor::parse_monitor_command_line(argc, argv);
    if (options) {
      halocline::bus::catch_stop_signals();
      halocline::monitor::run_monitor(*options, std::cout, halocline::bus::stop_requested);
    }
    if (halocline::bus::output_is_whole()) return 0;
    halocline::bus::print_failure("halocline-monitor", "standard output could not be written");
    return 1;
  } catch (const std::exception& error) {
    halocline::bus::print_failure("halocline-monitor", error.what());
    return dynamic_cast<const std::invalid_argument*>(&error) != nullptr ? 2 : 1;
  }
}
