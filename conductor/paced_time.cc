// SPDX-License-Identifier: BSD-3-Clause
#include "conductor/paced_time.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "bus/transport/node_identity.h"
#include "bus/transport/transport.h"
#include "core/check.h"

namespace halocline::conductor {
namespace {
constexpr SimDuration kStillRuns = SimDuration::from_milliseconds(1000);

SimDuration scaled(SimTime steady, double rate) { return SimDuration::from_seconds(steady.seconds() * rate); }
}  // namespace

PacedTime::PacedTime(lcm::LCM& lcm, double rate) : rate_(rate) {
  require_in_range(rate, 1e-3, 1e4, "rate");
  bus_.emplace(lcm, bus::NodeIdentity{"paced-time", 0});
  bus_->subscribe<vehicle_state_t>(bus::channels::kState,
                                   [this](std::string_view, const vehicle_state_t& s) { on_utime(s.utime); });
  bus_->subscribe<node_status_t>(bus::channels::kStatus,
                                 [this](std::string_view, const node_status_t& s) { on_utime(s.utime); });
  bus_->subscribe<sim_clock_t>(bus::channels::kClock, [this](const sim_clock_t& clock) { on_clock(clock); });
}

void PacedTime::on_clock(const sim_clock_t& clock) {
  const bool is_same = other_.count > 0 && clock.session == other_.session;
  if (is_same && clock.utime <= other_.utime && clock.sequence <= other_.sequence)
    return;  // a repeated old CLOCK
  other_ = {clock.session, is_same ? other_.count + 1 : 1, steady_, clock.utime, clock.sequence};
  on_utime(clock.utime);
}

void PacedTime::on_utime(std::int64_t utime) {
  constexpr std::size_t kMaxHeard = 100'000;
  if (running_ || utime <= 0 || zeros_.size() >= kMaxHeard) return;
  zeros_.push_back(SimTime::from_utime(utime) - scaled(steady_, rate_));
}

// A single utime may be wrong; if no two agree, the earliest is the safest.
SimTime PacedTime::latest_confirmed() {
  std::sort(zeros_.begin(), zeros_.end(), std::greater<>());
  const auto confirms = [this](SimTime later, SimTime earlier) {
    return (later - earlier).seconds() <= bus::ConductorTime::kLeap.seconds() * std::max(1.0, rate_);
  };
  const auto latest = std::adjacent_find(zeros_.begin(), zeros_.end(), confirms);
  return latest != zeros_.end() ? *latest : zeros_.back();
}

std::optional<SimTime> PacedTime::now(SimTime steady) {
  if (!started_listening_) started_listening_ = steady;
  if (!running_) {
    if (steady < *started_listening_ + kListening) return std::nullopt;
    if (other_.count >= 2 && steady - other_.received < kStillRuns) {
      throw bus::NetworkError("another conductor, session " + std::to_string(other_.session) +
                              ", publishes CLOCK on this bus; it stays, and this one ends");
    }
    zero_ = zeros_.empty() ? SimTime() - scaled(steady, rate_) : latest_confirmed();
    zeros_ = {};
    running_ = true;
    bus_.reset();
  }
  return zero_ + scaled(steady, rate_);
}

SimTime PacedTime::steady_at(SimTime sim) const {
  if (!running_) return started_listening_ ? *started_listening_ + kListening : SimTime::at_once();
  if (sim == SimTime::never() || sim == SimTime::at_once()) return sim;
  return SimTime::from_seconds((sim - zero_).seconds() / rate_);
}

}  // namespace halocline::conductor
