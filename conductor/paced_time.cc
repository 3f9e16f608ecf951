#include "conductor/paced_time.h"

#include <algorithm>
#include <string_view>

#include "bus/node_identity.h"
#include "core/check.h"

namespace halocline::conductor {
namespace {
SimDuration scaled(SimTime steady, double rate) { return SimDuration::from_seconds(steady.seconds() * rate); }
}  // namespace

PacedTime::PacedTime(lcm::LCM& lcm, double rate) : rate_(rate) {
  require_in_range(rate, 1e-3, 1e4, "rate");
  bus_.emplace(lcm, bus::NodeIdentity{"paced-time", 0});
  bus_->subscribe<vehicle_state_t>(bus::channels::kState,
                                   [this](std::string_view, const vehicle_state_t& s) { on_utime(s.utime); });
  bus_->subscribe<node_status_t>(bus::channels::kStatus,
                                 [this](std::string_view, const node_status_t& s) { on_utime(s.utime); });
}

void PacedTime::on_utime(std::int64_t utime) {
  if (running_ || utime <= 0) return;
  const SimTime zero = SimTime::from_utime(utime) - scaled(steady_, rate_);
  zero_ = has_received_ ? std::max(zero_, zero) : zero;
  has_received_ = true;
}

std::optional<SimTime> PacedTime::now(SimTime steady) {
  if (!started_listening_) started_listening_ = steady;
  if (!running_) {
    if (steady < *started_listening_ + kListening) return std::nullopt;
    if (!has_received_) zero_ = SimTime() - scaled(steady, rate_);
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
