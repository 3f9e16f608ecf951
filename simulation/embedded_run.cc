// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/embedded_run.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <span>
#include <string_view>
#include <thread>

#include "bus/logs/log_recorder.h"
#include "bus/runtime/lockstep_runner.h"
#include "bus/runtime/node_process.h"
#include "bus/runtime/thread_pool.h"
#include "bus/transport/transport.h"
#include "simulation/progress_line.h"

namespace halocline::clients {
namespace {

void sleep_for(SimDuration duration) {
  std::this_thread::sleep_for(std::chrono::nanoseconds(duration.nanoseconds()));
}

// Waits until wall time has caught up with `sim` at `rate`; returns false when the run is stopped meanwhile.
bool keep_pace(SimTime sim, SimTime started, double rate, const std::function<bool()>& should_stop) {
  constexpr SimDuration kLongestSleep = SimDuration::from_milliseconds(100);
  const SimTime due = started + SimDuration::from_seconds(sim.seconds() / rate);
  for (SimTime now = bus::steady_now(); now < due; now = bus::steady_now()) {
    if (should_stop()) return false;
    sleep_for(std::min(due - now, kLongestSleep));
  }
  return true;
}

}  // namespace

RunOutcome run_embedded(const std::vector<bus::Node*>& nodes, const EmbeddedRun& run) {
  bus::ThreadPool pool(run.threads);
  bus::LockstepRunner runner(nodes, pool.sharing_out());
  bus::LogRecorder recorder(run.log_path, run.rotation);
  const auto mirror =
      run.mirror_url.empty() ? nullptr : bus::open_transport(bus::effective_url(run.mirror_url));
  runner.set_listener([&](SimTime at, std::string_view channel, std::span<const std::uint8_t> message) {
    recorder.record(at, channel, message);
    if (mirror) mirror->publish(std::string(channel), message.data(), static_cast<unsigned>(message.size()));
  });
  ProgressLine progress(stderr, run.end, run.quiet);
  const SimTime started = bus::steady_now();
  RunOutcome outcome;
  runner.set_before_instant([&](SimTime instant) {
    outcome.interrupted =
        run.should_stop() || (run.rate > 0 && !keep_pace(instant, started, run.rate, run.should_stop));
    progress.show(runner.now(), bus::steady_now());
    if (!outcome.interrupted) outcome.reached = instant;
    return !outcome.interrupted;
  });
  runner.run_until(run.end);
  runner.stop();
  recorder.close();
  if (!outcome.interrupted) outcome.reached = run.end;
  outcome.wall_s = (bus::steady_now() - started).seconds();
  progress.finish(outcome.reached, bus::steady_now());
  return outcome;
}

}  // namespace halocline::clients
