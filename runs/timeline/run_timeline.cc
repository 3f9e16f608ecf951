// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/run_timeline.h"

#include <algorithm>
#include <limits>
#include <type_traits>

#include "bus/logs/channel_types.h"
#include "bus/logs/foreign_message.h"
#include "bus/messages/channels.h"
#include "core/check.h"

namespace halocline::clients {
namespace {

// Returns the name that follows the family in a channel: "auv-1" for STATE.auv-1, "" for OUTCOME.
std::string name_in(std::string_view channel) {
  const auto dot = channel.find('.');
  return dot == std::string_view::npos ? std::string() : std::string(channel.substr(dot + 1));
}

template <class Message>
concept HasUtime = requires(const Message& message) {
  message.utime;
};

// True for messages whose utime shows how far the run has come. Messages that are stamped with the instant
// from which they hold may be ahead of it.
template <class Message>
inline constexpr bool kAdvancesTime =
    std::is_same_v<Message, vehicle_state_t> || std::is_same_v<Message, packet_outcome_t> ||
    std::is_same_v<Message, vehicle_sensors_t> || std::is_same_v<Message, link_table_t> ||
    std::is_same_v<Message, sim_clock_t> || std::is_same_v<Message, position_estimate_t>;

// Returns the origin that a scenario states. A SCENARIO message holds 0 N 0 E when its scenario states none;
// an origin at 0 N 0 E is recognised by the keys in the configuration, which end where the files begin that
// it carries.
std::optional<RunOrigin> origin_of(const scenario_info_t& part, std::string_view toml) {
  const std::string_view keys = toml.substr(0, toml.find("\n[[file]]"));
  const auto states = [&](std::string_view key) { return keys.find(key) != std::string_view::npos; };
  const bool is_stated = part.origin_latitude_deg != 0 || part.origin_longitude_deg != 0 ||
                         states("origin_latitude_deg") || states("origin_longitude_deg");
  return is_stated ? std::optional(RunOrigin{part.origin_latitude_deg, part.origin_longitude_deg})
                   : std::nullopt;
}

}  // namespace

RunTimeline::RunTimeline(RunTimeBase time, TimelineLimits limits) : time_(time), limits_(limits) {}

void RunTimeline::add(std::int64_t stamp_us, std::string_view channel, std::span<const std::uint8_t> bytes) {
  ++counts_.messages;
  constexpr std::string_view kRepair = bus::channels::kRepair.prefix;
  while (channel.starts_with(kRepair)) channel.remove_prefix(kRepair.size());
  const bool is_ours =
      with_type_of(channel, [&]<class Message>() { decode_and_take<Message>(stamp_us, channel, bytes); });
  if (!is_ours) ++counts_.unknown;
  drop_old();
}

template <class Message>
void RunTimeline::decode_and_take(std::int64_t stamp_us, std::string_view channel,
                                  std::span<const std::uint8_t> bytes) {
  Message message{};
  if (!decode_foreign(bytes, message).is_sound()) {
    ++counts_.undecodable;
    return;
  }
  Received received{stamp_us, name_in(channel), std::max(end_, SimTime())};
  if constexpr (HasUtime<Message>) {
    if (time_.is_sound(message.utime)) {
      message.utime -= time_.zero_us;
      received.at = SimTime::from_utime(message.utime);
    } else {
      ++counts_.without_time;
      message.utime = received.at.to_utime();
    }
  }
  if constexpr (kAdvancesTime<Message>) {
    begin_ = std::min(begin_, received.at);
    end_ = std::max(end_, received.at);
  }
  if constexpr (requires { take(received, message); }) take(received, message);
}

void RunTimeline::take(const Received& received, const vehicle_state_t& state) {
  keep(vehicle(received.name, state.vehicle_id).track, received.at, track_point_of(state));
}

void RunTimeline::take(const Received& received, const vehicle_sensors_t& sensors) {
  keep(vehicle(received.name, 0).sensors, received.at, sensors);
}

void RunTimeline::take(const Received& received, const vehicle_command_t& command) {
  keep(vehicle(received.name, 0).commands, received.at, command);
}

void RunTimeline::take(const Received& received, const vehicle_fault_t& fault) {
  auto& faults = vehicle(received.name, 0).faults;
  const bool is_there = std::any_of(faults.begin(), faults.end(), [&](const auto& other) {
    return other.at == received.at && other.value.fault_kind == fault.fault_kind &&
           other.value.dead_sensor == fault.dead_sensor && other.value.fault_fixed == fault.fault_fixed;
  });
  if (!is_there) faults.push_back({received.at, fault});
}

void RunTimeline::take(const Received& received, const vehicle_gps_t& fix) {
  keep(vehicle(received.name, 0).gps, received.at, fix);
}

void RunTimeline::take(const Received& received, const position_estimate_t& estimate) {
  keep(vehicle(received.name, estimate.vehicle_id).estimates, received.at, estimate);
}

void RunTimeline::take(const Received& received, const modem_config_t& modem) {
  vehicle(received.name, 0).modem = modem;
}

void RunTimeline::take(const Received& received, modem_send_t send) {
  packets_.add(send, vehicle(received.name, send.source_id).id);
}

void RunTimeline::take(const Received& received, modem_receipt_t receipt) {
  if (receipt.start_utime != 0) receipt.start_utime -= time_.zero_us;
  packets_.add(receipt, vehicle(received.name, 0).id);
}

void RunTimeline::take(const Received&, packet_outcome_t outcome) {
  outcome.departure_utime -= time_.zero_us;
  if (SimTime::from_utime(outcome.departure_utime) < dropped_before_) return;
  vehicle(outcome.source_id);
  if (outcome.receiver_id != 0) vehicle(outcome.receiver_id);
  if (packets_.add(outcome))
    ledger_.add(outcome);
  else
    ++repeated_outcomes_;
  if (packets_.outcome_count() > limits_.outcomes)
    packets_.keep_outcomes(limits_.outcomes - limits_.outcomes / 8);
}

void RunTimeline::take(const Received& received, const link_table_t& table) {
  vehicle(received.name, table.vehicle_id);
  links_.add(received.at, table);
  while (links_.row_count() > limits_.link_rows) {
    const std::size_t before = links_.row_count();
    links_.thin();
    if (links_.row_count() == before) break;
  }
}

void RunTimeline::take(const Received& received, const environment_t& water) {
  water_.add(received.at, water);
}

// Assembles the scenario from its parts, which come in order. When a part is missing the others are ignored
// until the scenario is published again from its first part.
void RunTimeline::take(const Received&, const scenario_info_t& part) {
  if (part.part_number == 0) {
    scenario_parts_ = {part.scenario_name,   part.description,   "", part.scenario_seed, {},
                       part.sea_surface_z_m, part.run_duration_s};
    next_part_ = 0;
  }
  if (part.part_number != next_part_) return;
  ++next_part_;
  for (const std::string& line : part.configuration_line) scenario_parts_.toml += line + "\n";
  for (const scenario_vehicle_t& described : part.vehicles)
    vehicle(described.vehicle_name, described.vehicle_id).described = described;
  if (next_part_ != part.part_count) return;
  scenario_parts_.origin = origin_of(part, scenario_parts_.toml);
  scenario_ = scenario_parts_;
}

void RunTimeline::take(const Received& received, const terrain_tile_t& tile) {
  // A tile without a name is the map of the whole terrain; a name is that of a client whose query it answers.
  const bool is_whole = received.name.empty();
  const auto posts = static_cast<std::size_t>(tile.tile_rows) * static_cast<std::size_t>(tile.tile_columns);
  if (is_whole && tile.tile_status == terrain_tile_t::OK && tile.post_spacing_m > 0 &&
      posts == tile.seabed_z_m.size() && posts > 0)
    terrain_ = TerrainOverview::from(tile);
}

void RunTimeline::take(const Received& received, const vehicle_plan_t& plan) {
  auto& plans = vehicle(received.name, 0).plans;
  const auto* last = plans.at_or_before(received.at);
  const bool is_repetition = last != nullptr && last->value.behaviour_index == plan.behaviour_index &&
                             last->value.waypoint_index == plan.waypoint_index &&
                             last->value.plan_ended == plan.plan_ended &&
                             last->value.num_waypoints == plan.num_waypoints;
  if (!is_repetition) plans.add(received.at, plan);
}

void RunTimeline::take(const Received& received, const autopilot_status_t& status) {
  keep(vehicle(received.name, 0).activity, received.at, status);
}

void RunTimeline::take(const Received& received, const node_status_t& status) {
  health_.add_status(received.stamp_us, received.name, status);
}

void RunTimeline::take(const Received& received, const flow_heartbeat_t&) {
  health_.add_heartbeat(received.stamp_us, received.name);
}

void RunTimeline::take(const Received& received, const sim_clock_t& clock) {
  health_.add_clock(received.stamp_us, clock);
}

VehicleRecord& RunTimeline::vehicle(const std::string& name, std::int32_t id) {
  auto found = by_name_.find(name);
  if (found == by_name_.end()) {
    const auto nameless = by_id_.find(id);
    const bool is_nameless =
        nameless != by_id_.end() && vehicles_[nameless->second].name == std::to_string(id);
    const std::size_t index = is_nameless ? nameless->second : vehicles_.size();
    if (!is_nameless) vehicles_.emplace_back().index = index;
    by_name_.erase(vehicles_[index].name);
    vehicles_[index].name = name;
    found = by_name_.emplace(name, index).first;
  }
  give_id(vehicles_[found->second], id);
  return vehicles_[found->second];
}

VehicleRecord& RunTimeline::vehicle(std::int32_t id) {
  const auto found = by_id_.find(id);
  return found != by_id_.end() ? vehicles_[found->second] : vehicle(std::to_string(id), id);
}

void RunTimeline::give_id(VehicleRecord& vehicle, std::int32_t id) {
  if (id == 0 || vehicle.id != 0) return;
  vehicle.id = id;
  const auto [known, is_new] = by_id_.emplace(id, vehicle.index);
  if (is_new || vehicles_[known->second].name != std::to_string(id)) return;
  vehicles_[known->second].id = 0;  // the vehicle that was known by this id alone is this vehicle
  known->second = vehicle.index;
}

const VehicleRecord* RunTimeline::find(std::string_view name) const {
  const auto found = by_name_.find(name);
  return found != by_name_.end() ? &vehicles_[found->second] : nullptr;
}

const VehicleRecord* RunTimeline::find(std::int32_t id) const {
  const auto found = by_id_.find(id);
  return found != by_id_.end() ? &vehicles_[found->second] : nullptr;
}

std::string RunTimeline::name(std::int32_t id) const {
  const VehicleRecord* known = find(id);
  return known != nullptr ? known->name : std::to_string(id);
}

double RunTimeline::seabed_m(double north_m, double east_m) const {
  return terrain_ ? terrain_->depth_at_m(north_m, east_m) : std::numeric_limits<double>::quiet_NaN();
}

template <class Value>
void RunTimeline::keep(TimedSeries<Value>& series, SimTime at, const Value& value) {
  if (series.add(at, value)) ++samples_;
  if (samples_ > limits_.samples) keep_limits();
}

void RunTimeline::keep_limits() {
  std::size_t dropped = 0;
  for (VehicleRecord& v : vehicles_)
    dropped += v.track.thin() + v.commands.thin() + v.sensors.thin() + v.estimates.thin() + v.gps.thin() +
               v.activity.thin();
  samples_ -= dropped;
  if (dropped == 0) limits_.samples *= 2;  // every series has fewer than four entries: thinning cannot help
}

void RunTimeline::limit_history(SimDuration history) {
  require(history > SimDuration(), "a history must be longer than 0");
  history_ = history;
}

void RunTimeline::drop_old() {
  if (history_ == SimDuration() || begin_ > end_) return;
  const SimTime first = end_ - history_;
  // Old data are dropped in batches, not at every message: up to a tenth more than asked for is kept.
  if (dropped_before_ != SimTime::at_once() && (first - dropped_before_) * 10 < history_) return;
  dropped_before_ = first;
  begin_ = std::max(begin_, first);
  for (VehicleRecord& v : vehicles_) {
    samples_ -= v.track.drop_before(first) + v.commands.drop_before(first) + v.sensors.drop_before(first) +
                v.estimates.drop_before(first) + v.gps.drop_before(first) + v.activity.drop_before(first);
    v.plans.drop_before(first);
  }
  packets_.drop_before(first);
  links_.drop_before(first);
  water_.drop_before(first);
}

}  // namespace halocline::clients
