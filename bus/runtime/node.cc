#include "bus/runtime/node.h"

#include <algorithm>

#include "bus/version.h"

namespace halocline::bus {
namespace {
constexpr SimDuration kStatusPeriod = SimDuration::from_milliseconds(1000);
}

Due Node::due() const {
  Due due = on_due();
  due.steady = std::min({due.steady, next_status_, bus_.next_repair()});
  return due;
}

SimTime Node::lockstep_due() const {
  const Due both = due();
  return std::min(both.sim, both.steady);
}

void Node::step(const Now& now) {
  bus_.log().set_time(now.sim);
  bus_.rethrow_if_failed();
  const Due due = on_due();
  if (now.sim_known || due.sim == SimTime::at_once() || due.steady <= now.steady) on_step(now);
  if (now.steady >= next_status_) {
    publish_status(now, status_text());
    next_status_ = next_on_grid(now.steady, kStatusPeriod);
  }
  bus_.repair(now.sim, now.steady);
}

void Node::restart(const Now& now) {
  bus_.log().set_time(now.sim);
  bus_.log().info("restarted", "reason=\"simulation time jumped back\"");
  bus_.forget_flows();
  on_restart(now);
}

void Node::stop(const Now& now) {
  bus_.log().set_time(now.sim);
  bus_.rethrow_if_failed();
  on_stop(now);
  publish_status(now, "stopped; " + status_text());
}

void Node::publish_status(const Now& now, const std::string& text) {
  node_status_t status;
  const BusCounters& counters = bus_.counters();
  status.utime = now.sim.to_utime();
  status.session = bus_.identity().session;
  status.sequence = status_sequence_++;
  status.node_name = name();
  status.node_version = kVersion;
  status.messages_received = counters.received;
  status.messages_sent = counters.sent;
  status.messages_refused = counters.refused;
  status.gaps = counters.gaps;
  status.repaired = counters.repaired;
  status.lost = counters.lost;
  status.duplicates = counters.duplicates;
  status.late = counters.late;
  status.status_text = text;
  bus_.publish(channels::kStatus.of(name()), status);
}

}  // namespace halocline::bus
