// The monitor's process: a source of messages, the pages that are open, and the loop between them.
#pragma once

#include <functional>
#include <iosfwd>

#include "clients/monitor/monitor_options.h"

namespace halocline::monitor {

// Prints the URL to `out` and serves until `should_stop`, which is called at least every 0.1 s. Throws InvalidArgument for
// options that cannot be met.
void run_monitor(const MonitorOptions& options, std::ostream& out, const std::function<bool()>& should_stop);

}  // namespace halocline::monitor
