// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/sources/bus_source.h"

#include <algorithm>
#include <optional>

#include "bus/messages/channels.h"
#include "bus/runtime/node_process.h"
#include "bus/transport/transport.h"
#include "runs/timeline/vehicle_record.h"
#include "viewer/sources/modems.h"

namespace halocline::monitor {
namespace {

constexpr double kSilent_s = 3;
// Age of its last STATUS beyond which a node is not alive; nodes publish it each second.
constexpr double kAlive_s = 3.5;

}  // namespace

BusSource::BusSource(const std::string& lcm_url, const std::string& accept, SimDuration history)
    : url_(bus::effective_url(lcm_url)),
      history_(history),
      receiver_(url_, bus::accepted_hosts(accept, url_), "monitor"),
      last_message_(bus::steady_now()) {
  timeline_.limit_history(history_);
}

void BusSource::begin_run() {
  timeline_ = clients::RunTimeline();
  timeline_.limit_history(history_);
  configuration_.clear();
  ++run_;
}

void BusSource::take_scenario_modems() {
  const std::string& configuration = timeline_.scenario().toml;
  if (configuration.empty() || configuration == configuration_) return;
  configuration_ = configuration;
  std::vector<std::string> vehicles;
  for (const clients::VehicleRecord& vehicle : timeline_.vehicles()) {
    if (vehicle.described && !vehicle.modem) vehicles.push_back(vehicle.name);
  }
  for (const BusMessage& modem : modems_in(configuration_, vehicles, timeline_.end()))
    timeline_.add(modem.stamp_us, modem.channel, modem.bytes);
}

void BusSource::update() {
  for (const BusMessage& message : receiver_.take()) {
    if (message.channel.empty()) {
      begin_run();
      continue;
    }
    last_message_ = bus::steady_now();
    ++received_;
    if (is_reply_ && is_reply_(message.channel)) replies_.push_back(message);
    timeline_.add(message.stamp_us, message.channel, message.bytes);
    if (message.channel == bus::channels::kScenario) take_scenario_modems();
  }
}

SourceState BusSource::state() const {
  const double silent_s = (bus::steady_now() - last_message_).seconds();
  const bool is_silent = silent_s > kSilent_s;
  return {.bus = !receiver_.is_open() ? BusCondition::kReconnecting
                 : is_silent          ? BusCondition::kSilent
                                      : BusCondition::kLive,
          .silent_s = is_silent ? silent_s : 0,
          .bathymetry = is_alive("bathymetry"),
          .channel_server = is_alive("channel"),
          .real_time_factor = is_silent ? std::nullopt : timeline_.health().real_time_factor(),
          .messages_dropped = receiver_.dropped()};
}

// Returns the time of the conductor's clock, if there is one, because a vehicle's clock may be ahead of it;
// at most a second after the last message.
SimTime BusSource::now() const {
  constexpr SimDuration kAhead = SimDuration::from_milliseconds(1000);
  const SimTime last = timeline_.end();
  const auto conductor = receiver_.conductor_time();
  return conductor && last != SimTime::at_once()
             ? std::max(std::min(*conductor, last + kAhead), timeline_.begin())
             : last;
}

double BusSource::age_s(const clients::NodeRecord& node, SimTime) const {
  return std::max(0.0, (bus::wall_now() - SimTime::from_utime(node.last_stamp_us)).seconds());
}

bool BusSource::is_alive(std::string_view prefix) const {
  const auto& nodes = timeline_.health().nodes();
  return std::any_of(nodes.begin(), nodes.end(), [&](const auto& node) {
    return node.first.starts_with(prefix) && age_s(node.second, SimTime()) < kAlive_s;
  });
}

}  // namespace halocline::monitor
