// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/sources/log_source.h"

#include <algorithm>
#include <iostream>

#include "bus/config/config.h"
#include "bus/messages/channels.h"
#include "core/check.h"
#include "runs/analysis/run_files.h"
#include "runs/timeline/vehicle_record.h"
#include "viewer/sources/water_changes.h"

namespace halocline::monitor {
namespace {

clients::LoggedTimeline log_of(const std::vector<std::string>& logs) {
  clients::LoggedTimeline log = clients::read_timeline(logs);
  clients::print_remarks(std::cerr, log);
  return log;
}

}  // namespace

LogSource::LogSource(const std::vector<std::string>& logs, const std::string& scenario)
    : LogSource(logs, log_of(logs), scenario) {}

LogSource::LogSource(const std::vector<std::string>& logs, clients::LoggedTimeline log,
                     const std::string& scenario)
    : name_(logs.front()), timeline_(std::move(log.timeline)) {
  if (!log.is_whole) limits_ = std::move(log.remarks);
  require(timeline_.begin() <= timeline_.end(), name_ + " holds no states and no packets");
  if (!scenario.empty())
    nodes_ = std::make_unique<LogNodes>([scenario] { return bus::ConfigFile::load(scenario); });
  else if (!timeline_.scenario().toml.empty())
    nodes_ = std::make_unique<LogNodes>([logs] { return clients::recorded_configuration(logs); });
}

void LogSource::update() {
  if (!nodes_) return;
  for (BusMessage& message : nodes_->take()) {
    const bool is_missing =
        (message.channel == bus::channels::kTerrain && !timeline_.terrain()) ||
        (message.channel == bus::channels::kScenario && timeline_.scenario().name.empty()) ||
        lacks_modem(message.channel);
    if (is_missing) timeline_.add(0, message.channel, message.bytes);
    if (is_reply_ && is_reply_(message.channel)) replies_.push_back(std::move(message));
  }
}

// Returns true for the MODEM of a vehicle that published none; the one of the scenario is then used.
bool LogSource::lacks_modem(std::string_view channel) const {
  constexpr std::string_view kPrefix = bus::channels::kModem.prefix;
  if (!channel.starts_with(kPrefix)) return false;
  const clients::VehicleRecord* vehicle = timeline_.find(channel.substr(kPrefix.size()));
  return vehicle != nullptr && !vehicle->modem;
}

std::vector<std::string> LogSource::limits() const {
  std::vector<std::string> all = limits_;
  const std::string problem = nodes_ ? nodes_->problem()
                                     : "this log has no configuration. Put the scenario file beside it, or "
                                       "name it by --scenario";
  if (!problem.empty()) all.push_back("Rays and budgets are not computed: " + problem + ".");
  return all;
}

SourceState LogSource::state() const {
  const bool answers = nodes_ && nodes_->is_ready();
  return {.bathymetry = answers, .channel_server = answers};
}

void LogSource::post(const std::string& channel, bus::Bytes bytes) {
  if (!nodes_) return;
  if (channel == bus::channels::kLinkQuery) {
    if (const auto query = bus::decoded<link_query_t>(bytes)) set_water(SimTime::from_utime(query->utime));
  }
  nodes_->post(channel, std::move(bytes));
}

void LogSource::set_water(SimTime at) {
  const auto* water = timeline_.water().at_or_before(std::max(at, SimTime()));
  if (water == nullptr) return;
  // The water at the beginning of the log is that of its configuration.
  if (!nodes_water_) nodes_water_ = timeline_.water().all().front().value;
  auto change = change_between(*nodes_water_, water->value);
  if (!change) return;
  change->session = 1;
  change->sequence = water_changes_++;
  nodes_->post(std::string(bus::channels::kSetEnvironment), bus::encoded(*change));
  nodes_water_ = water->value;
}

double LogSource::age_s(const clients::NodeRecord& node, SimTime at) const {
  return std::max(0.0, (at - SimTime::from_utime(node.status.utime)).seconds());
}

}  // namespace halocline::monitor
