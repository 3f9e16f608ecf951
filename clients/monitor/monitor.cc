#include "clients/monitor/monitor.h"

#include <chrono>
#include <ostream>
#include <string_view>

#include "clients/monitor/web_server.h"

namespace halocline::monitor {

void run_monitor(const MonitorOptions& options, std::ostream& out, const std::function<bool()>& should_stop) {
  constexpr std::chrono::milliseconds kTick{50};
  const auto server =
      open_web_server(options.web, {.opened = [](ConnectionId, WebProtocol) {},
                                    .received = [](ConnectionId, std::string_view, bool) { return true; },
                                    .closed = [](ConnectionId) {}});
  out << server->url() << std::endl;  // at once: a script waits for it
  while (!should_stop()) {
    server->run_for(kTick);
    server->resume();
  }
}

}  // namespace halocline::monitor
