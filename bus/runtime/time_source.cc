// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/time_source.h"

#include <cmath>

#include "core/check.h"

namespace halocline::bus {
namespace {

constexpr SimDuration kSampleMemory = SimDuration::from_milliseconds(1000);
// Messages of one moment arrive in any order, but within far less than this; a restarted log jumps by more.
constexpr SimDuration kJumpBack = SimDuration::from_milliseconds(10'000);

// Saturates, so that distant instants (never, a slow rate) do not overflow.
SimTime to_steady(double seconds) {
  constexpr double kLimit = 9e9;
  return std::abs(seconds) < kLimit ? SimTime::from_seconds(seconds)
                                    : (seconds > 0 ? SimTime::never() : SimTime::at_once());
}

}  // namespace

SilenceWarning::SilenceWarning(std::string process_name, std::string awaited)
    : log_(std::move(process_name)), awaited_(std::move(awaited)) {}

void SilenceWarning::on_unknown_time(SimTime steady) {
  if (!since_) since_ = steady;
  if (logged_ || steady < *since_ + kSilence) return;
  logged_ = true;
  log_.warning("no-time", "no " + awaited_ +
                              " for 3 s: the run is on another bus, or none is running. LCM_DEFAULT_URL and "
                              "--lcm-url choose the bus; ./scripts/join PROGRAM runs a program on that of "
                              "./scripts/run --distributed");
}

ConductorTime::ConductorTime(lcm::LCM& lcm, const std::string& process_name)
    : bus_(lcm, {process_name, 0}), silence_(process_name, "CLOCK") {
  bus_.subscribe<sim_clock_t>(channels::kClock,
                              [this](const sim_clock_t& clock) { on_clock(clock, received()); });
}

SimTime ConductorTime::received() const {
  if (!wall_) return steady_;
  return steady_ - std::clamp(*wall_ - bus_.received_at(), SimDuration(), longest_wait_);
}

// Without sequence numbers only the time orders CLOCKs; a conductor without a session may restart in it.
bool ConductorTime::goes_on(const Heard& before, const sim_clock_t& clock) {
  const bool is_numbered = clock.sequence != 0 || before.clock.sequence != 0;
  return is_numbered ? clock.sequence > before.clock.sequence : clock.utime >= before.clock.utime;
}

bool ConductorTime::is_old(const sim_clock_t& clock) const {
  return last_ && clock.session != 0 && last_->clock.session == clock.session &&
         clock.utime <= last_->clock.utime && !goes_on(*last_, clock);
}

bool ConductorTime::agree(const Heard& before, const sim_clock_t& clock, SimTime received) {
  const double rate = before.clock.clock_rate;
  const double utime_s =
      (SimTime::from_utime(clock.utime) - SimTime::from_utime(before.clock.utime)).seconds();
  const double leap_s = utime_s - (received - before.received).seconds() * rate;
  const SimDuration ahead = rate > 0 ? kLeapAhead : kLeap;  // in lockstep time advances only with CLOCKs
  return leap_s >= -kLeap.seconds() * std::max(1.0, rate) && leap_s <= ahead.seconds() * std::max(1.0, rate);
}

// True if an earlier CLOCK of the session agrees with this one; otherwise this one is stored until one does.
bool ConductorTime::is_witnessed(const sim_clock_t& clock, SimTime received) {
  constexpr std::size_t kMaxWitnesses = 8;  // bounded, as anybody can invent sessions
  const auto earlier = std::find_if(witnesses_.begin(), witnesses_.end(),
                                    [&](const Heard& one) { return one.clock.session == clock.session; });
  if (earlier != witnesses_.end()) {
    const bool is_another = clock.clock_rate > 0 ? earlier->clock.utime != clock.utime
                                                 : earlier->clock.sequence != clock.sequence;
    if (is_another && agree(*earlier, clock, received)) return true;
    witnesses_.erase(earlier);
  }
  witnesses_.push_back({clock, received});
  if (witnesses_.size() > kMaxWitnesses) witnesses_.pop_front();
  return false;
}

// The accepted session was heard as expected: it stays accepted, and contradicting CLOCKs are refused.
void ConductorTime::refuse_unexpected() {
  std::erase_if(witnesses_, [&](const Heard& one) { return one.clock.session == last_->clock.session; });
  const auto refuse = [this](std::int64_t count, std::string_view reason) {
    bus_.counters().duplicate_publishers += count;
    if (count > 0) bus_.refuse(channels::kClock, reason);
  };
  refuse(std::exchange(num_leaps_, 0), "utime, rate or sequence is not what is expected of its session");
  refuse(std::exchange(num_others_, 0),
         "session is of a second conductor; the first is accepted until it is silent for 3 s");
}

void ConductorTime::on_clock(const sim_clock_t& clock, SimTime received) {
  if (is_old(clock)) return;
  const bool is_tracked = last_ && clock.session == last_->clock.session;
  if (is_tracked && clock.clock_rate == rate_ && goes_on(*last_, clock) && agree(*last_, clock, received)) {
    refuse_unexpected();
  } else if (last_ && received - last_->received < kSilence) {
    ++(is_tracked ? num_leaps_ : num_others_);
    return;
  } else if (!is_witnessed(clock, received)) {
    return;
  }
  take(clock, received);
}

void ConductorTime::take(const sim_clock_t& clock, SimTime received) {
  const SimTime sim = SimTime::from_utime(clock.utime);
  const bool goes_on = last_ && clock.session == last_->clock.session && agree(*last_, clock, received);
  if (!goes_on) {
    witnesses_.clear();
    num_others_ = num_leaps_ = 0;
  }
  if (!goes_on || clock.clock_rate != rate_) samples_.clear();
  if (!goes_on && latest_ > sim + kJumpBack) {
    restarted_ = latest_ != SimTime::at_once();
    latest_ = SimTime::at_once();
  }
  last_ = {clock, received};
  rate_ = clock.clock_rate;
  paused_at_ = rate_ > 0 ? std::nullopt : std::optional(sim);
  if (rate_ <= 0) return;
  samples_.push_back({received, received.seconds() - sim.seconds() / rate_});
  while (samples_.front().received + kSampleMemory < received) samples_.pop_front();
}

std::optional<SimTime> ConductorTime::now(SimTime steady) {
  if (paused_at_) {
    latest_ = std::max(latest_, *paused_at_);
  } else if (!samples_.empty()) {
    const double offset_s =
        std::min_element(samples_.begin(), samples_.end(), [](const Sample& a, const Sample& b) {
          return a.offset_s < b.offset_s;
        })->offset_s;
    latest_ = std::max(latest_, SimTime::from_seconds((steady.seconds() - offset_s) * rate_));
  } else {
    silence_.on_unknown_time(steady);
    return std::nullopt;
  }
  return latest_;
}

SimTime ConductorTime::steady_at(SimTime sim) const {
  if (samples_.empty() || paused_at_ || sim == SimTime::never()) return SimTime::never();
  if (sim == SimTime::at_once()) return sim;
  double offset_s = samples_.front().offset_s;
  for (const Sample& sample : samples_) offset_s = std::min(offset_s, sample.offset_s);
  return to_steady(sim.seconds() / rate_ + offset_s);
}

MessageTime::MessageTime(lcm::LCM& lcm, const std::string& process_name)
    : bus_(lcm, {process_name, 0}), silence_(process_name, "STATE or SEND") {
  bus_.subscribe<vehicle_state_t>(channels::kState,
                                  [this](std::string_view, const vehicle_state_t& s) { on_utime(s.utime); });
  bus_.subscribe<modem_send_t>(channels::kSend,
                               [this](std::string_view, const modem_send_t& s) { on_utime(s.utime); });
}

void MessageTime::on_utime(std::int64_t utime) {
  const SimTime time = SimTime::from_utime(utime);
  if (latest_ && time + kJumpBack < *latest_) {
    restarted_ = true;
    latest_ = time;
  }
  latest_ = latest_ ? std::max(*latest_, time) : time;
}

std::optional<SimTime> MessageTime::now(SimTime steady) {
  if (!latest_) silence_.on_unknown_time(steady);
  return latest_;
}

SimTime MessageTime::steady_at(SimTime sim) const {
  return latest_ && sim <= *latest_ ? SimTime::at_once() : SimTime::never();
}

TimeSourceKind time_source_from_name(std::string_view name) {
  if (name == "conductor") return TimeSourceKind::kConductor;
  if (name == "messages") return TimeSourceKind::kMessages;
  if (name == "wall") return TimeSourceKind::kWall;
  if (name == "lockstep") return TimeSourceKind::kLockstep;
  throw InvalidArgument("time source is '" + std::string(name) +
                        "'; allowed are conductor, messages, wall, lockstep");
}

std::unique_ptr<TimeSource> make_time_source(TimeSourceKind kind, lcm::LCM& lcm, const std::string& name,
                                             SimTime wall_at_start) {
  switch (kind) {
    case TimeSourceKind::kConductor:
      return std::make_unique<ConductorTime>(lcm, name);
    case TimeSourceKind::kMessages:
      return std::make_unique<MessageTime>(lcm, name);
    case TimeSourceKind::kWall:
    case TimeSourceKind::kLockstep:
      break;
  }
  return std::make_unique<WallTime>(wall_at_start.to_utime());
}

}  // namespace halocline::bus
